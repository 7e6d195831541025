//! Statements, elements and indices that aren't used, and the warnings about them.

use super::corner::List;
use super::error::{Problem, Warning};
use super::tally::{Tally, add_by_keyword, lines_or_points};
use crate::counts::{counted, counted_as};
use std::collections::BTreeMap;

/// Statements, elements and indices that aren't used.
#[derive(Default)]
pub(super) struct Skipped {
    /// Statements that hitscope doesn't read, by keyword.
    pub statements: BTreeMap<String, Tally>,
    /// Faces with an invalid vertex index or fewer than three corners.
    pub faces: Tally,
    /// The same for lines and points.
    pub others: Tally,
    /// Indices into the lists of texture coordinates and normals that are out of range.
    pub indices: [Tally; 3],
    /// The error about the first index that is out of range. It counts only if the file has such a list: some exporters
    /// write indices of a list that they don't write.
    pub first_index: [Option<Problem>; 3],
}

impl Skipped {
    /// Adds those of the next chunk.
    pub(super) fn append(&mut self, later: Self) {
        let mut statements: Vec<(String, Tally)> = later.statements.into_iter().collect();
        statements.sort_by_key(|(_, tally)| tally.first_line);
        for (keyword, tally) in statements {
            add_by_keyword(&mut self.statements, &keyword, tally);
        }
        self.faces.append(later.faces);
        self.others.append(later.others);
        for (list, first) in later.first_index.into_iter().enumerate() {
            self.indices[list].append(later.indices[list]);
            let earlier = self.first_index[list].take();
            self.first_index[list] = earlier.or(first);
        }
    }

    /// Forgets the indices into a list that the file doesn't have, and returns the first line with one.
    pub(super) fn forget_indices(&mut self, list: List) -> Option<usize> {
        let tally = std::mem::take(&mut self.indices[list as usize]);
        self.first_index[list as usize] = None;
        (tally.count > 0).then_some(tally.first_line)
    }

    pub(super) fn warnings(&self) -> impl Iterator<Item = Warning> {
        let statements = self.statements.iter().filter_map(|(keyword, tally)| {
            tally.warning(|count| {
                let statements = counted(count, &format!("“{keyword}” statement"));
                format!("{statements} ignored")
            })
        });
        let why = "dropped: an index is out of range, or there are too few corners";
        let faces = self
            .faces
            .warning(|count| format!("{} {why}", counted(count, "face")));
        let others = self
            .others
            .warning(|count| format!("{} {why}", lines_or_points(count)));
        let mut indices = self.indices[List::Texture as usize];
        indices.append(self.indices[List::Normal as usize]);
        let indices = indices.warning(|count| {
            let (one, many) = ("texture or normal index", "texture or normal indices");
            let indices = counted_as(count, one, many);
            format!("{indices} ignored: out of range")
        });
        statements.chain(faces).chain(others).chain(indices)
    }
}

//! Reads one chunk of an OBJ file, statement by statement.
//!
//! A chunk is parsed without knowing what precedes it. Negative indices are therefore stored relative to the chunk's
//! first entry, and names with the index of the first face in the chunk that they apply to; [`Contents`] resolves
//! both. If an index is invalid or refers to an entry before the file's first, the chunk is parsed again with the number
//! of entries before it, which the error message needs.
//!
//! [`Contents`]: super::contents::Contents

use super::FaultPolicy;
use super::chunk_contents::{ChunkContents, StateChange};
use super::chunks::Chunk;
use super::corner::{Corner, Corners, List};
use super::elements::ElementKind;
use super::error::Problem;
use super::keyword::Keyword;
use super::plain;
use super::statement::{Statement, Statements};
use super::tally::{count_by_keyword, shortened};
use super::words::{Words, is_long_number, name, number, text, without_comment};
use crate::counts::{counted, grouped};
use crate::mesh::NO_INDEX;
use crate::progress::Progress;
use glam::{DVec3, Vec2};

/// Numbers or corners between two checks for cancellation: about a millisecond.
pub(super) const WORDS_PER_CHECK: usize = 1 << 16;

/// An index resolved within a chunk.
enum Index {
    At(u32),
    /// From the chunk's first entry.
    Relative(i32),
    OutOfRange,
}

/// Options for reading a chunk.
#[derive(Clone, Copy)]
pub(super) struct ChunkOptions<'p> {
    pub faults: FaultPolicy,
    /// Number of entries in each list before the chunk, if they are known.
    pub counts: Option<[usize; 3]>,
    pub progress: &'p Progress,
}

/// Reads a chunk.
pub(super) fn read(chunk: &Chunk, options: ChunkOptions<'_>) -> ChunkContents {
    let mut reader = ChunkReader {
        part: ChunkContents::default(),
        options,
    };
    let mut statements = Statements::of(chunk);
    // Most statements are plain. All others, and all errors, go through `take`.
    loop {
        let plain = plain::read(&mut reader.part, statements.rest(), statements.next_line());
        if let Some(length) = plain {
            statements.skip_line(length);
            continue;
        }
        let Some(statement) = statements.next() else {
            break;
        };
        if let Err(problem) = reader.take(statement) {
            reader.part.problem = Some(problem);
            break;
        }
        if reader.part.needs_counts {
            break;
        }
    }
    reader.part
}

struct ChunkReader<'p> {
    part: ChunkContents,
    options: ChunkOptions<'p>,
}

impl ChunkReader<'_> {
    /// Reads a statement.
    fn take(&mut self, statement: Statement<'_>) -> Result<(), Problem> {
        let Some((word, after)) = statement.keyword() else {
            return Ok(());
        };
        let rest = &statement.bytes[after..];
        match Keyword::of(word) {
            Some(Keyword::Numbers(list)) => self.numbers(list, statement, after)?,
            Some(Keyword::Element(kind)) => self.element(kind, statement, after)?,
            Some(Keyword::Material) => self.change_state(StateChange::Material(name(rest))),
            Some(Keyword::Group) => self.change_state(StateChange::Group(name(rest))),
            Some(Keyword::Smoothing) => {
                let group = smoothing_group(&name(without_comment(rest)));
                self.change_state(StateChange::Smoothing(group));
            }
            Some(Keyword::Library) => self.part.libraries.push((statement.line, name(rest))),
            None if word[0] == b'#' => {}
            None => {
                let keyword = shortened(&text(word));
                count_by_keyword(&mut self.part.skipped.statements, &keyword, statement.line);
            }
        }
        Ok(())
    }

    /// Changes the state for the faces that follow.
    fn change_state(&mut self, change: StateChange) {
        let face = self.part.elements.face_count() as u32;
        self.part.state_changes.push((face, change));
    }

    /// Reads a vertex (three numbers, optionally a weight or a colour), texture coordinates (one to three numbers,
    /// of which two are used) or a normal (three).
    fn numbers(
        &mut self,
        list: List,
        statement: Statement<'_>,
        after: usize,
    ) -> Result<(), Problem> {
        let used = if list == List::Texture { 2 } else { 3 };
        let (least, keyword) = match list {
            List::Vertex => (3, "v"),
            List::Texture => (1, "vt"),
            List::Normal => (3, "vn"),
        };
        let statement = statement.without_comment();
        let words = Words::of(statement.bytes, after);
        let count = words.clone().count();
        if count < least {
            return Err(statement.problem(format!(
                "“{keyword}” needs {}, found {}",
                counted(least, "number"),
                grouped(count)
            )));
        }
        let mut values = [0.0; 3];
        for (k, word) in words.clone().enumerate() {
            if (k + 1) % WORDS_PER_CHECK == 0 {
                self.options.progress.check()?;
            }
            let value = number::<f64>(&statement, word)?;
            if k < used {
                values[k] = value;
                self.part.has_long_numbers |= list == List::Vertex && is_long_number(word.1);
            }
        }
        // `x y z w` has a weight, which polygons don't use; `x y z r g b (a)` a colour.
        if list == List::Vertex && count >= 6 {
            let mut colour = [0.0; 3];
            for (channel, word) in colour.iter_mut().zip(words.skip(3)) {
                *channel = number(&statement, word)?;
            }
            let vertex = self.part.positions.len() as u32;
            self.part.colours.push((vertex, colour));
        }
        let [x, y, z] = values;
        let part = &mut self.part;
        match list {
            List::Vertex => part.positions.push(DVec3::new(x, y, z)),
            List::Texture => part.textures.push(Vec2::new(x as f32, y as f32)),
            List::Normal => part.normals.push(DVec3::new(x, y, z).as_vec3()),
        }
        Ok(())
    }

    /// Reads a face, a line or points.
    fn element(
        &mut self,
        kind: ElementKind,
        statement: Statement<'_>,
        after: usize,
    ) -> Result<(), Problem> {
        let first = self.part.elements.corners[0].len();
        let is_read = self.corners(kind, statement, after)?;
        let elements = &mut self.part.elements;
        if is_read {
            elements.end(kind, first, statement.line);
            return Ok(());
        }
        elements.truncate(first);
        match kind {
            ElementKind::Face => self.part.skipped.faces.add(statement.line),
            ElementKind::Line | ElementKind::Points => self.part.skipped.others.add(statement.line),
        }
        Ok(())
    }

    /// Reads an element's corners; returns `false` if the element must be dropped.
    fn corners(
        &mut self,
        kind: ElementKind,
        statement: Statement<'_>,
        after: usize,
    ) -> Result<bool, Problem> {
        let statement = statement.without_comment();
        let mut count = 0;
        for corner in Corners::of(statement.bytes, after) {
            let corner = corner.map_err(|bad| statement.problem_at(bad.offset, bad.message))?;
            if !self.corner(corner, &statement)? {
                return Ok(false);
            }
            count += 1;
            if count % WORDS_PER_CHECK == 0 {
                self.options.progress.check()?;
            }
        }
        let (least, what) = kind.least_corners();
        if count >= least {
            return Ok(true);
        }
        match self.options.faults {
            FaultPolicy::Lenient => Ok(false),
            FaultPolicy::Strict => Err(statement.problem(format!("{what}; this one has {count}"))),
        }
    }

    /// Adds a corner; returns `false` if its vertex can't exist.
    fn corner(&mut self, corner: Corner, statement: &Statement<'_>) -> Result<bool, Problem> {
        for list in List::ALL {
            let at = list as usize;
            let Some(written) = corner.indices[at] else {
                self.part.elements.push(list, NO_INDEX);
                continue;
            };
            match self.index(list, written) {
                Index::At(index) => self.part.elements.push(list, index),
                Index::Relative(index) => self.part.elements.push_relative(list, index),
                Index::OutOfRange => {
                    let Some(before) = self.options.counts else {
                        self.part.needs_counts = true;
                        return Ok(false);
                    };
                    let count = before[at] + self.count(list);
                    let problem = || {
                        let message = list.out_of_range(written, count);
                        statement.problem_at(corner.offset, message)
                    };
                    let is_strict = self.options.faults == FaultPolicy::Strict;
                    if list == List::Vertex {
                        return if is_strict { Err(problem()) } else { Ok(false) };
                    }
                    self.part.skipped.first_index[at].get_or_insert_with(problem);
                    self.part.skipped.indices[at].add(statement.line);
                    self.part.elements.push(list, NO_INDEX);
                }
            }
        }
        Ok(true)
    }

    /// Number of entries in the chunk so far.
    fn count(&self, list: List) -> usize {
        match list {
            List::Vertex => self.part.positions.len(),
            List::Texture => self.part.textures.len(),
            List::Normal => self.part.normals.len(),
        }
    }

    /// Converts an index to start at 0. An index that is too high may become valid later in the file.
    fn index(&self, list: List, written: i64) -> Index {
        // The largest u32 marks a missing index; no file can have that many entries.
        let at = |from_one: i64| match u32::try_from(from_one) {
            Ok(0 | NO_INDEX) | Err(_) => Index::OutOfRange,
            Ok(from_one) => Index::At(from_one - 1),
        };
        if written >= 0 {
            return at(written);
        }
        let in_chunk = (self.count(list) as i64).saturating_add(written);
        match self.options.counts {
            Some(before) => at((before[list as usize] as i64).saturating_add(in_chunk) + 1),
            None => i32::try_from(in_chunk).map_or(Index::OutOfRange, Index::Relative),
        }
    }
}

/// The number of a smoothing group: 1 for `on`; 0 (no group) for `off` and anything else that isn't a number.
fn smoothing_group(word: &str) -> u32 {
    match word {
        "on" => 1,
        _ => word.parse().unwrap_or(0),
    }
}

//! The contents of a file: those of its chunks, appended in file order, and everything that depends on the whole file.

use super::chunk_contents::{ChunkContents, StateChange};
use super::chunks::Chunk;
use super::colours::Colours;
use super::corner::List;
use super::elements::{ElementKind, Elements};
use super::error::{Problem, Warning};
use super::names::{LibraryNames, NamedRuns};
use super::parts::ListParts;
use super::reader::{self, ChunkOptions};
use super::skipped::Skipped;
use super::tally::LineRuns;
use super::{FaultPolicy, memory};
use crate::mesh::{MAX_TRIANGLES, NO_INDEX};
use glam::{DVec3, Vec2, Vec3};

/// The largest u32 is the index of a missing entry.
const MAX_ENTRIES: usize = NO_INDEX as usize - 1;

/// The contents of a file.
#[derive(Default)]
pub(super) struct Contents {
    /// Empty until [`finish`](Self::finish), as are the next two lists.
    pub positions: Vec<DVec3>,
    pub textures: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    position_parts: ListParts<DVec3>,
    texture_parts: ListParts<Vec2>,
    normal_parts: ListParts<Vec3>,
    pub colours: Colours,
    /// The elements of each chunk.
    pub elements: Vec<Elements>,
    /// Whether any element has an index in a list.
    pub has_indices: [bool; 3],
    /// Number of faces, lines and points.
    pub element_count: usize,
    pub materials: NamedRuns,
    pub groups: NamedRuns,
    /// Runs of faces with their smoothing group; 0 is no group. Empty if the file has no `s` statement.
    pub smoothing: Vec<(usize, u32)>,
    pub libraries: LibraryNames,
    pub face_lines: LineRuns,
    pub skipped: Skipped,
    /// Whether a vertex coordinate may have more than 15 digits.
    pub has_long_numbers: bool,
    /// Number of corners, and of triangles if every face becomes a fan.
    pub corner_count: usize,
    pub triangle_count: usize,
    /// Whether some elements don't have three corners.
    pub has_polygons: bool,
    /// Largest number of corners of an element.
    pub largest_element: usize,
    /// Bytes of names and of lists that are small in most files.
    pub other_bytes: usize,
    state_changes: Vec<Vec<(u32, StateChange)>>,
    /// The first line with an index of a list that the file doesn't have.
    missing_list_line: [Option<usize>; 3],
    has_garbage: bool,
}

impl Contents {
    /// Number of entries in each list.
    pub(super) fn counts(&self) -> [usize; 3] {
        [
            self.positions.len() + self.position_parts.count(),
            self.textures.len() + self.texture_parts.count(),
            self.normals.len() + self.normal_parts.count(),
        ]
    }

    /// Appends the contents of the next chunk.
    ///
    /// # Errors
    /// The first error in the chunk.
    pub(super) fn append(
        &mut self,
        chunk: &Chunk,
        part: ChunkContents,
        options: ChunkOptions,
    ) -> Result<(), Problem> {
        let before = self.counts();
        let reaches_too_far = |list: List| {
            let at = list as usize;
            (before[at] as i64) + i64::from(part.elements.lowest[at]) < 0
        };
        let mut part = if part.needs_counts || List::ALL.into_iter().any(reaches_too_far) {
            let counts = Some(before);
            reader::read(chunk, ChunkOptions { counts, ..options })
        } else {
            part
        };
        part.elements.resolve_relative(before);
        let first_vertex = before[0];
        for (vertex, colour) in part.colours {
            self.colours.add(first_vertex + vertex as usize, colour);
        }
        self.position_parts.push(part.positions);
        self.texture_parts.push(part.textures);
        self.normal_parts.push(part.normals);
        self.has_long_numbers |= part.has_long_numbers;
        for (line, name) in part.libraries {
            self.other_bytes += 2 * name.len() + 128;
            self.libraries.add(line, name);
        }
        self.skipped.append(part.skipped);
        let elements = part.elements;
        for (has_indices, corners) in self.has_indices.iter_mut().zip(&elements.corners) {
            *has_indices |= !corners.is_empty();
        }
        self.corner_count += elements.corners[0].len();
        self.triangle_count += elements.fan_triangles();
        self.has_polygons |= !elements.arities.is_empty();
        self.largest_element = self.largest_element.max(elements.largest);
        self.other_bytes +=
            elements.other_bytes() + part.state_changes.iter().map(bytes_of).sum::<usize>();
        self.elements.push(elements);
        self.state_changes.push(part.state_changes);
        match part.problem {
            Some(Problem::Cancelled) => Err(Problem::Cancelled),
            Some(problem) => self.first_problem(Some(problem)).map_or(Ok(()), Err),
            None => Ok(()),
        }
    }

    /// The first of this error and those about indices of texture coordinates and normals.
    fn first_problem(&mut self, problem: Option<Problem>) -> Option<Problem> {
        let counts = self.counts();
        let lists = [List::Texture, List::Normal].map(|list| list as usize);
        let of_lists = lists
            .into_iter()
            .filter(|&list| counts[list] > 0)
            .filter_map(|list| self.skipped.first_index[list].take());
        let line = |problem: &Problem| match problem {
            Problem::Line { line, .. } => *line,
            _ => usize::MAX,
        };
        of_lists.chain(problem).min_by_key(line)
    }

    /// Refuses a file that is too large; `pending` bytes of memory are needed besides.
    ///
    /// # Errors
    /// The file needs more memory than allowed, or 32-bit indices can't count its vertices or triangles.
    pub(super) fn check_size(&self, max_memory: u64, pending: u64) -> Result<(), Problem> {
        let is_too_large = |&count: &usize| count > MAX_ENTRIES;
        if self.triangle_count > MAX_TRIANGLES || self.counts().iter().any(is_too_large) {
            let message = "more vertices or triangles than 32-bit indices allow".to_owned();
            return Err(Problem::Content(message));
        }
        if memory::bytes(self) + pending > max_memory {
            return Err(Problem::Content(format!(
                "loading needs more than the {} MB of memory allowed (--max-memory)",
                max_memory >> 20
            )));
        }
        Ok(())
    }

    /// Resolves everything that depends on the whole file. `has_garbage` says whether anything follows its gzip data.
    ///
    /// # Errors
    /// An index is out of range, and `faults` is strict.
    pub(super) fn finish(&mut self, faults: FaultPolicy, has_garbage: bool) -> Result<(), Problem> {
        self.has_garbage = has_garbage;
        self.positions = self.position_parts.join();
        self.textures = self.texture_parts.join();
        self.normals = self.normal_parts.join();
        let counts = self.counts();
        for list in [List::Texture, List::Normal] {
            if counts[list as usize] == 0 {
                self.forget_indices(list);
            }
        }
        match faults {
            FaultPolicy::Strict => self.require_entries(counts)?,
            FaultPolicy::Lenient => self.drop_missing(counts),
        }
        let mut face = 0;
        let state_changes = std::mem::take(&mut self.state_changes);
        for (elements, state_changes) in self.elements.iter_mut().zip(state_changes) {
            elements.first_face = face;
            for (first, change) in state_changes {
                let first = face + first as usize;
                match change {
                    StateChange::Material(name) => self.materials.begin(first, name),
                    StateChange::Group(name) => self.groups.begin(first, name),
                    StateChange::Smoothing(group) => {
                        let last = self.smoothing.last();
                        if last.is_none_or(|&(_, last)| last != group) {
                            self.smoothing.push((first, group));
                        }
                    }
                }
            }
            self.face_lines.append(&elements.face_lines);
            face += elements.face_count();
        }
        self.element_count = self.elements.iter().map(|elements| elements.count).sum();
        self.materials.end(face);
        self.groups.end(face);
        Ok(())
    }

    /// Removes all indices of a list that the file doesn't have: some exporters write them nevertheless.
    fn forget_indices(&mut self, list: List) {
        let at = list as usize;
        let line = self.elements.iter().find_map(|elements| {
            let corners = &elements.corners[at];
            let first = corners.iter().position(|&index| index != NO_INDEX)?;
            Some(elements.line_of_corner(first))
        });
        let skipped = self.skipped.forget_indices(list);
        self.missing_list_line[at] = line.into_iter().chain(skipped).min();
        for elements in &mut self.elements {
            elements.corners[at] = Vec::new();
            elements.highest[at] = 0;
        }
        self.has_indices[at] = false;
    }

    /// Refuses indices of entries that don't exist.
    fn require_entries(&mut self, counts: [usize; 3]) -> Result<(), Problem> {
        let too_high = self
            .elements
            .iter()
            .find_map(|elements| elements.first_missing(counts));
        let missing = too_high.map(|(line, list, index)| {
            let from_one = i64::from(index) + 1;
            Problem::line(line, list.out_of_range(from_one, counts[list as usize]))
        });
        self.first_problem(missing).map_or(Ok(()), Err)
    }

    /// Drops elements with vertices that don't exist, and other indices of entries that don't exist.
    fn drop_missing(&mut self, counts: [usize; 3]) {
        for (elements, state_changes) in self.elements.iter_mut().zip(&mut self.state_changes) {
            if (0..3).all(|list| elements.highest[list] <= counts[list]) {
                continue;
            }
            let (mut kept, mut kept_faces) = (Elements::default(), Vec::new());
            for element in elements.iter() {
                let line = elements.line(&element);
                let (kind, corners) = (element.kind, element.corners);
                let [vertices, ..] = &elements.corners;
                let exists = |&vertex: &u32| (vertex as usize) < counts[0];
                let is_kept = vertices[corners.clone()].iter().all(exists);
                if kind == ElementKind::Face {
                    kept_faces.push(is_kept);
                }
                if !is_kept {
                    match kind {
                        ElementKind::Face => self.skipped.faces.add(line),
                        ElementKind::Line | ElementKind::Points => self.skipped.others.add(line),
                    }
                    continue;
                }
                let first = kept.corners[0].len();
                for corner in corners {
                    for list in List::ALL {
                        let at = list as usize;
                        let mut index = elements.corners[at]
                            .get(corner)
                            .copied()
                            .unwrap_or(NO_INDEX);
                        if index != NO_INDEX && index as usize >= counts[at] {
                            self.skipped.indices[at].add(line);
                            index = NO_INDEX;
                        }
                        kept.push(list, index);
                    }
                }
                kept.end(kind, first, line);
            }
            let mut kept_before = vec![0];
            for is_kept in kept_faces {
                kept_before.push(kept_before[kept_before.len() - 1] + u32::from(is_kept));
            }
            for (face, _) in state_changes {
                *face = kept_before[*face as usize];
            }
            *elements = kept;
        }
    }

    /// Warnings about everything ignored or dropped, in the order of their first lines.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut warnings: Vec<Warning> = self.skipped.warnings().collect();
        for (list, entries) in [
            (List::Texture, "texture coordinates"),
            (List::Normal, "normals"),
        ] {
            let what = list.name();
            warnings.extend(self.missing_list_line[list as usize].map(|line| {
                let message = format!("faces have {what} indices, but the file has no {entries}");
                Warning::at(line, message)
            }));
        }
        warnings.extend(self.colours.warning(self.positions.len()));
        if self.has_garbage {
            let message = "bytes after the end of the gzip data ignored".to_owned();
            warnings.push(Warning::of_file(message));
        }
        warnings.sort_by_key(|warning| warning.line.unwrap_or(usize::MAX));
        warnings
    }
}

fn bytes_of((_, change): &(u32, StateChange)) -> usize {
    let text = match change {
        StateChange::Material(name) | StateChange::Group(name) => 3 * name.len(),
        StateChange::Smoothing(_) => 0,
    };
    // A name is stored three times, with an entry in a half-full hash map.
    size_of::<(u32, StateChange)>() + 160 + text
}

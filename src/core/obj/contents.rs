//! Reads an OBJ file: chunks are parsed in parallel and merged in file order.
//!
//! The loading thread cuts the file into chunks and merges the parts that rayon's threads have parsed. The result
//! doesn't depend on the number of threads: chunks have the same bounds on every machine.

use super::chunks::{CHUNK, Chunk, Chunks};
use super::colours::Colours;
use super::corner::List;
use super::elements::{Element, Elements};
use super::error::{Problem, Warning};
use super::fence::fenced;
use super::memory;
use super::names::{Libraries, NamedRuns};
use super::part::{Mark, Part};
use super::reader::{self, PartOptions};
use super::tally::{LineRuns, Tally, add_by_keyword, lines_or_points};
use super::{FaultPolicy, LoadOptions};
use crate::counts::{counted, counted_as};
use crate::mesh::NO_INDEX;
use crate::progress::Progress;
use glam::{DVec3, Vec2, Vec3};
use std::collections::{BTreeMap, VecDeque};
use std::io::Read;
use std::sync::mpsc::{Receiver, channel};

/// Corners of triangles are numbered by u32, and the largest vertex number marks a missing one.
const MOST_TRIANGLES: usize = u32::MAX as usize / 3;
const MOST_ENTRIES: usize = u32::MAX as usize - 1;
/// Chunks per thread that are in memory at a time.
const CHUNKS_PER_THREAD: usize = 3;

/// A chunk takes its own bytes, and its part less than four times as many: `f 1 1 1` has 8 bytes and gives three indices
/// of 4 bytes, which may be listed a second time as relative ones.
const BYTES_PER_PENDING_BYTE: u64 = 5;

/// The contents of a file.
#[derive(Default)]
pub(super) struct Contents {
    pub positions: Vec<DVec3>,
    pub textures: Vec<Vec2>,
    pub normals: Vec<Vec3>,
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
    pub libraries: Libraries,
    pub face_lines: LineRuns,
    /// Dropped faces; `dropped_others` counts lines and points.
    pub dropped_faces: Tally,
    pub dropped_others: Tally,
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
    marks: Vec<Vec<(u32, Mark)>>,
    ignored: BTreeMap<String, Tally>,
    bad_indices: [Tally; 3],
    bad_index: [Option<Problem>; 3],
    /// The first line with an index of a list that the file doesn't have.
    missing_list_line: [Option<usize>; 3],
    has_garbage: bool,
}

/// Reads a file.
///
/// # Errors
/// The first error in the file.
pub(super) fn read(
    bytes: impl Read,
    options: &LoadOptions,
    progress: &Progress,
) -> Result<Contents, Problem> {
    let mut chunks = Chunks::new(bytes, progress)?;
    chunks.limit_statements(options.max_memory);
    chunks.require_obj()?;
    let mut contents = Contents::default();
    let part_options = PartOptions {
        faults: options.faults,
        counts: None,
        progress,
    };
    let most = CHUNKS_PER_THREAD * rayon::current_num_threads();
    // A small part of the allowed memory.
    let most_bytes = (options.max_memory / 100).min((most * CHUNK) as u64) as usize;
    rayon::in_place_scope(|scope| {
        let (mut pending, mut pending_bytes) = (VecDeque::new(), 0);
        let mut end = None;
        loop {
            while end.is_none() && pending.len() < most && pending_bytes <= most_bytes {
                match chunks.next() {
                    Ok(Some(chunk)) => {
                        let (sender, receiver) = channel();
                        pending_bytes += chunk.bytes.len();
                        pending.push_back((receiver, chunk.bytes.len()));
                        scope.spawn(move |_| {
                            let part = fenced("reading", || reader::read(&chunk, part_options));
                            // The receiver is gone after an error in an earlier chunk.
                            _ = sender.send((chunk, part));
                        });
                    }
                    Ok(None) => end = Some(Ok(())),
                    // An earlier chunk may have an error, which comes first.
                    Err(problem) => end = Some(Err(problem)),
                }
            }
            contents.check_size(options.max_memory, pending_bytes)?;
            let Some((first, bytes)) = pending.pop_front() else {
                return end.unwrap_or(Ok(()));
            };
            let (chunk, part) = wait(&first);
            contents.append(&chunk, part?, part_options)?;
            chunks.recycle(chunk);
            pending_bytes -= bytes;
        }
    })?;
    contents.has_garbage = chunks.has_garbage();
    contents.finish(options.faults)?;
    Ok(contents)
}

/// Waits for a task's result. On one of rayon's threads it runs other tasks meanwhile: that thread may be the only one.
fn wait<T>(result: &Receiver<T>) -> T {
    while rayon::current_thread_index().is_some() {
        match result.try_recv() {
            Ok(result) => return result,
            Err(_) => _ = rayon::yield_now(),
        }
    }
    result.recv().expect("each task sends")
}

impl Contents {
    /// Number of entries in each list.
    pub(super) fn counts(&self) -> [usize; 3] {
        [
            self.positions.len(),
            self.textures.len(),
            self.normals.len(),
        ]
    }

    /// Appends the contents of the next chunk.
    fn append(&mut self, chunk: &Chunk, part: Part, options: PartOptions) -> Result<(), Problem> {
        let before = self.counts();
        let reaches_too_far = |list: List| {
            let at = list as usize;
            (before[at] as i64) + i64::from(part.elements.lowest[at]) < 0
        };
        let mut part = if part.needs_counts || List::ALL.into_iter().any(reaches_too_far) {
            let counts = Some(before);
            reader::read(chunk, PartOptions { counts, ..options })
        } else {
            part
        };
        part.elements.resolve_relative(before);
        let first_vertex = before[0];
        for (vertex, colour) in part.colours {
            self.colours.add(first_vertex + vertex as usize, colour);
        }
        self.positions.append(&mut part.positions);
        self.textures.append(&mut part.textures);
        self.normals.append(&mut part.normals);
        self.has_long_numbers |= part.has_long_numbers;
        for (line, name) in part.libraries {
            self.other_bytes += 2 * name.len() + 128;
            self.libraries.add(line, name);
        }
        let mut ignored: Vec<(String, Tally)> = part.ignored.into_iter().collect();
        ignored.sort_by_key(|(_, tally)| tally.first_line);
        for (keyword, tally) in ignored {
            add_by_keyword(&mut self.ignored, &keyword, tally);
        }
        self.dropped_faces.append(part.dropped_faces);
        self.dropped_others.append(part.dropped_others);
        for list in 0..3 {
            self.bad_indices[list].append(part.bad_indices[list]);
            let first = self.bad_index[list].take();
            self.bad_index[list] = first.or(part.bad_index[list].take());
        }
        let elements = part.elements;
        for (has_indices, corners) in self.has_indices.iter_mut().zip(&elements.corners) {
            *has_indices |= !corners.is_empty();
        }
        self.corner_count += elements.corners[0].len();
        self.triangle_count += elements.most_triangles();
        self.has_polygons |= !elements.arities.is_empty();
        self.largest_element = self.largest_element.max(elements.largest);
        self.other_bytes += elements.other_bytes() + part.marks.iter().map(bytes_of).sum::<usize>();
        self.elements.push(elements);
        self.marks.push(part.marks);
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
            .filter_map(|list| self.bad_index[list].take());
        let line = |problem: &Problem| match problem {
            Problem::Line { line, .. } => *line,
            _ => usize::MAX,
        };
        of_lists.chain(problem).min_by_key(line)
    }

    /// Refuses a file that is too large. `pending_bytes` are the bytes of chunks that are being read.
    fn check_size(&self, max_memory: u64, pending_bytes: usize) -> Result<(), Problem> {
        let is_too_large = |&count: &usize| count > MOST_ENTRIES;
        if self.triangle_count > MOST_TRIANGLES || self.counts().iter().any(is_too_large) {
            let message = "more vertices or triangles than 32-bit indices allow".to_owned();
            return Err(Problem::Content(message));
        }
        let pending = BYTES_PER_PENDING_BYTE * pending_bytes as u64;
        if memory::bytes(self) + pending > max_memory {
            return Err(Problem::Content(format!(
                "loading needs more than the {} MB of memory allowed (--max-memory)",
                max_memory >> 20
            )));
        }
        Ok(())
    }

    /// Resolves everything that depends on the whole file.
    fn finish(&mut self, faults: FaultPolicy) -> Result<(), Problem> {
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
        let marks = std::mem::take(&mut self.marks);
        for (elements, marks) in self.elements.iter_mut().zip(marks) {
            elements.first_face = face;
            for (first, mark) in marks {
                let first = face + first as usize;
                match mark {
                    Mark::Material(name) => self.materials.begin(first, name),
                    Mark::Group(name) => self.groups.begin(first, name),
                    Mark::Smoothing(group) => {
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
        let bad = std::mem::take(&mut self.bad_indices[at]);
        self.bad_index[at] = None;
        let bad_line = (bad.count > 0).then_some(bad.first_line);
        self.missing_list_line[at] = line.into_iter().chain(bad_line).min();
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
        for (elements, marks) in self.elements.iter_mut().zip(&mut self.marks) {
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
                if kind == Element::Face {
                    kept_faces.push(is_kept);
                }
                if !is_kept {
                    match kind {
                        Element::Face => self.dropped_faces.add(line),
                        Element::Line | Element::Points => self.dropped_others.add(line),
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
                            self.bad_indices[at].add(line);
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
            for (face, _) in marks {
                *face = kept_before[*face as usize];
            }
            *elements = kept;
        }
    }

    /// Warnings about everything ignored or dropped, in the order of their first lines.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut warnings: Vec<Warning> = Vec::new();
        warnings.extend(self.ignored.iter().filter_map(|(keyword, tally)| {
            tally.warning(|count| {
                let statements = counted(count, &format!("“{keyword}” statement"));
                format!("{statements} ignored")
            })
        }));
        let why = "dropped: an index is out of range, or there are too few corners";
        let faces = |count| format!("{} {why}", counted(count, "face"));
        warnings.extend(self.dropped_faces.warning(faces));
        let others = |count| format!("{} {why}", lines_or_points(count));
        warnings.extend(self.dropped_others.warning(others));
        let mut bad = self.bad_indices[List::Texture as usize];
        bad.append(self.bad_indices[List::Normal as usize]);
        warnings.extend(bad.warning(|count| {
            let indices = counted_as(
                count,
                "texture or normal index",
                "texture or normal indices",
            );
            format!("{indices} ignored: out of range")
        }));
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

fn bytes_of((_, mark): &(u32, Mark)) -> usize {
    let text = match mark {
        Mark::Material(name) | Mark::Group(name) => 3 * name.len(),
        Mark::Smoothing(_) => 0,
    };
    // A name is stored three times, with an entry in a half-full hash map.
    size_of::<(u32, Mark)>() + 160 + text
}

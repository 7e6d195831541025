//! What the reader learns about a file besides the numbers that it passes on.

use super::copies::Copies;
use super::corner::List;
use super::error::{Warning, printable};
use super::names::{Libraries, NamedRuns};
use crate::counts::{counted, counted_as};
use glam::Vec3;
use std::collections::BTreeMap;

/// Kinds of statements with corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    Face,
    /// A polyline through its corners.
    Line,
    /// One point per corner.
    Points,
}

impl Element {
    /// The minimum number of corners, and a sentence for the error message.
    pub(super) fn least_corners(self) -> (usize, &'static str) {
        match self {
            Self::Face => (3, "a face needs three corners"),
            Self::Line => (2, "a line needs two corners"),
            Self::Points => (1, "a list of points needs one point"),
        }
    }
}

/// Number of occurrences, and the line of the first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub count: usize,
    pub first_line: usize,
}

impl Tally {
    pub(super) fn add(&mut self, line: usize) {
        if self.count == 0 {
            self.first_line = line;
        }
        self.count += 1;
    }

    /// A warning if the count isn't zero.
    pub(super) fn warning(self, message: impl FnOnce(usize) -> String) -> Option<Warning> {
        (self.count > 0).then(|| Warning::at(self.first_line, message(self.count)))
    }
}

/// What the reader learned about a file. Arrays of three are indexed by [`List`].
#[derive(Debug, Default)]
pub(super) struct Facts {
    /// Number of entries in each list.
    pub counts: [usize; 3],
    /// For each corner of each element, its index from 0 in each list, or
    /// [`NO_INDEX`](crate::mesh::NO_INDEX). The second and third are empty as long as no corner has such an
    /// index.
    pub corners: [Vec<u32>; 3],
    /// Number of faces, lines and points.
    pub element_count: usize,
    /// Indices of the elements that aren't faces, in ascending order.
    pub non_faces: Vec<(usize, Element)>,
    pub face_count: usize,
    pub face_lines: LineRuns,
    pub materials: NamedRuns,
    pub groups: NamedRuns,
    /// Runs of faces with their smoothing group; 0 is no group. Empty if the file has no `s` statement.
    pub smoothing: Vec<(usize, u32)>,
    pub libraries: Libraries,
    /// Vertex colours, up to the last vertex that has one.
    pub colours: Vec<[f32; 3]>,
    coloured: usize,
    has_byte_colours: bool,
    /// Number of normals that are zero or not finite.
    pub useless_normals: usize,
    /// The highest index in each list, from 1, and the line of its element.
    pub highest: [(usize, usize); 3],
    /// Ignored statements by keyword.
    ignored: BTreeMap<String, Tally>,
    /// Faces dropped for an invalid index or too few corners; `dropped_others` counts lines and points.
    pub dropped_faces: Tally,
    pub dropped_others: Tally,
    /// Corners whose texture coordinates or normal don't exist.
    pub bare: Tally,
    /// Line of the element with the highest texture index, in a file without texture coordinates.
    idle_textures_line: Option<usize>,
    /// Whether a vertex coordinate may have more than 15 digits.
    pub has_long_numbers: bool,
    /// Whether bytes other than zeros follow the gzip data.
    pub has_garbage: bool,
    /// Upper bound on the vertices that tobj copied.
    pub copies: Copies,
    /// Largest number of corners of a face.
    pub largest_face: usize,
}

impl Facts {
    /// The line (from 1) of an `f` statement (from 0).
    pub(super) fn face_line(&self, face: usize) -> usize {
        self.face_lines.line(face)
    }

    /// Counts an ignored statement.
    pub(super) fn ignore(&mut self, keyword: &str, line: usize) {
        count_by_keyword(&mut self.ignored, keyword, line);
    }

    pub(super) fn begin_smoothing(&mut self, group: u32) {
        let last = self.smoothing.last();
        if last.is_none_or(|&(_, last)| last != group) {
            self.smoothing.push((self.face_count, group));
        }
    }

    /// Records the colour of the last vertex. Vertices without a colour get a value that is white on either
    /// scale.
    pub(super) fn add_colour(&mut self, colour: [f32; 3]) {
        self.colours.resize(self.counts[0] - 1, [f32::INFINITY; 3]);
        self.colours.push(colour);
        self.coloured += 1;
    }

    /// Returns a colour for each vertex, sRGB from 0 to 1, or an empty list. Some programs write 0 to 255.
    pub(super) fn take_colours(&mut self) -> Vec<Vec3> {
        let mut colours = std::mem::take(&mut self.colours);
        if !colours.is_empty() {
            colours.resize(self.counts[0], [f32::INFINITY; 3]);
        }
        let channels = colours.as_flattened().iter().copied();
        let mut given = channels.filter(|x| x.is_finite());
        let largest = given.clone().fold(0.0, f32::max);
        let are_whole = given.all(|x| x.fract() == 0.0);
        self.has_byte_colours = are_whole && largest > 1.0 && largest <= 255.0;
        let white = if self.has_byte_colours { 255.0 } else { 1.0 };
        // NaN becomes black.
        let channel = |x: f32| {
            if x.is_nan() {
                0.0
            } else {
                (x / white).clamp(0.0, 1.0)
            }
        };
        let colour = |channels: [f32; 3]| Vec3::from_array(channels.map(channel));
        colours.into_iter().map(colour).collect()
    }

    /// Records an element whose corners are in the lists.
    pub(super) fn add_element(&mut self, element: Element, line: usize) {
        if element == Element::Face {
            self.materials.add_face(self.face_count);
            self.groups.add_face(self.face_count);
            self.face_count += 1;
            self.face_lines.push(line);
        } else {
            self.non_faces.push((self.element_count, element));
        }
        self.element_count += 1;
    }

    /// Drops an element, and removes its corners from the lists.
    pub(super) fn drop_element(&mut self, element: Element, before: [usize; 3], line: usize) {
        for (list, length) in self.corners.iter_mut().zip(before) {
            list.truncate(length);
        }
        match element {
            Element::Face => self.dropped_faces.add(line),
            Element::Line | Element::Points => self.dropped_others.add(line),
        }
    }

    /// Number of elements since the end of tobj's last list.
    pub(super) fn elements_since_cut(&self) -> usize {
        self.element_count - self.copies.elements
    }

    /// Records the end of one of tobj's lists.
    pub(super) fn cut(&mut self) {
        self.copies.cut(&self.corners, self.element_count);
    }

    /// Whether every index so far refers to an entry that was read. Idle lists are not checked.
    pub(super) fn is_complete(&self) -> bool {
        List::ALL.into_iter().all(|list| {
            self.is_idle(list) || self.highest[list as usize].0 <= self.counts[list as usize]
        })
    }

    /// Whether a list has no entries and needs none: some exporters write indices of texture coordinates that
    /// don't exist.
    pub(super) fn is_idle(&self, list: List) -> bool {
        list == List::Texture && self.counts[list as usize] == 0
    }

    /// Removes texture indices if the file has no texture coordinates.
    pub(super) fn forget_idle_textures(&mut self) {
        let (highest, line) = self.highest[List::Texture as usize];
        if self.is_idle(List::Texture) && highest > 0 {
            self.highest[List::Texture as usize] = (0, 0);
            self.corners[List::Texture as usize] = Vec::new();
            self.idle_textures_line = Some(line);
        }
    }

    /// Warnings about everything ignored or dropped, in the order of their first lines.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let ignored = self.ignored.iter().filter_map(|(keyword, tally)| {
            tally.warning(|count| {
                let statements = counted(count, &format!("“{keyword}” statement"));
                format!("{statements} ignored")
            })
        });
        let colourless = self.counts[0] - self.coloured;
        let uncoloured = (self.coloured > 0 && colourless > 0).then(|| {
            let vertices = counted_as(
                colourless,
                "vertex without a colour is",
                "vertices without a colour are",
            );
            Warning::of_file(format!("{vertices} white"))
        });
        let why = "dropped: an index is out of range, or there are too few corners";
        let mut warnings: Vec<Warning> = ignored
            .chain(
                self.dropped_faces
                    .warning(|count| format!("{} {why}", counted(count, "face"))),
            )
            .chain(
                self.dropped_others
                    .warning(|count| format!("{} {why}", lines_or_points(count))),
            )
            .chain(self.bare.warning(|count| {
                let indices = counted_as(
                    count,
                    "texture or normal index",
                    "texture or normal indices",
                );
                format!("{indices} ignored: out of range")
            }))
            .chain(self.idle_textures_line.map(|line| {
                Warning::at(
                    line,
                    "faces have texture indices, but the file has no texture coordinates"
                        .to_owned(),
                )
            }))
            .chain(uncoloured)
            .chain(self.has_garbage.then(|| {
                Warning::of_file("bytes after the end of the gzip data ignored".to_owned())
            }))
            .chain(self.has_byte_colours.then(|| {
                Warning::of_file("vertex colours above 1: interpreted as bytes".to_owned())
            }))
            .chain((self.useless_normals > 0).then(|| {
                let normals = counted(self.useless_normals, "normal");
                let why = "zero or not finite in the file";
                Warning::of_file(format!("{normals} computed: {why}"))
            }))
            .collect();
        warnings.sort_by_key(|warning| warning.line.unwrap_or(usize::MAX));
        warnings
    }

    /// Number of triangles if every face becomes a fan.
    pub(super) fn triangle_count(&self) -> usize {
        self.corners[0].len().saturating_sub(2 * self.face_count)
    }
}

/// The number of elements that aren't faces, with their noun.
pub(super) fn lines_or_points(count: usize) -> String {
    counted_as(count, "line or point", "lines or points")
}

/// Counts a statement by its keyword. Files of random bytes have many keywords: all after the first 40 share
/// a count.
pub(super) fn count_by_keyword(tallies: &mut BTreeMap<String, Tally>, keyword: &str, line: usize) {
    const MOST_KEYWORDS: usize = 40;
    let is_known = tallies.contains_key(keyword);
    let name = if is_known || tallies.len() < MOST_KEYWORDS {
        keyword
    } else {
        "…"
    };
    tallies.entry(name.to_owned()).or_default().add(line);
}

/// Line numbers of statements, stored as runs of statements on consecutive lines.
#[derive(Clone, Debug, Default)]
pub struct LineRuns {
    runs: Vec<(usize, usize)>,
    count: usize,
    next_line: usize,
}

impl LineRuns {
    pub(super) fn push(&mut self, line: usize) {
        if line != self.next_line || self.runs.is_empty() {
            self.runs.push((self.count, line));
        }
        self.count += 1;
        self.next_line = line + 1;
    }

    /// The line (from 1) of a statement (from 0); 0 if there are no statements.
    pub fn line(&self, statement: usize) -> usize {
        let run = self.runs.partition_point(|(first, _)| *first <= statement);
        match run.checked_sub(1).map(|run| self.runs[run]) {
            Some((first, line)) => line + statement - first,
            None => 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.runs.clear();
        (self.count, self.next_line) = (0, 0);
    }

    pub(super) fn bytes(&self) -> usize {
        16 * self.runs.capacity()
    }
}

/// A word for messages: shortened, and without control characters.
pub(super) fn shortened(word: &str) -> String {
    const LENGTH: usize = 60;
    let rest = word.chars().nth(LENGTH).map(|_| '…');
    printable(word).chars().take(LENGTH).chain(rest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_keep_their_lines_across_gaps() {
        let mut runs = LineRuns::default();
        let lines = [3, 4, 5, 9, 10, 20];
        lines.into_iter().for_each(|line| runs.push(line));
        let found: Vec<usize> = (0..lines.len())
            .map(|statement| runs.line(statement))
            .collect();
        assert_eq!(found, lines);
        assert_eq!(runs.runs.len(), 3);
    }
}

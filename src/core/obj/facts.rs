//! What does the reader learn of a file besides the numbers that it passes on?

use super::copies::Copies;
use super::corner::List;
use super::error::{Warning, printable};
use super::names::{Libraries, NamedRuns};
use glam::Vec3;
use std::collections::BTreeMap;

/// What has corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    Face,
    /// A line through its corners.
    Line,
    /// Its corners are points.
    Points,
}

impl Element {
    /// How many it needs, and that in words.
    pub(super) fn least_corners(self) -> (usize, &'static str) {
        match self {
            Self::Face => (3, "a face needs three corners"),
            Self::Line => (2, "a line needs two corners"),
            Self::Points => (1, "a list of points needs one"),
        }
    }
}

/// How often something happened, and on which line first.
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

    /// What it says of itself, if it happened at all.
    pub(super) fn warning(self, message: impl FnOnce(usize) -> String) -> Option<Warning> {
        (self.count > 0).then(|| Warning::at(self.first_line, message(self.count)))
    }
}

/// What the reader learnt on the way. Lists by three go by [`List`].
#[derive(Debug, Default)]
pub(super) struct Facts {
    /// How many there are in each list.
    pub counts: [usize; 3],
    /// For each corner of each element its index, from 0, in each list, or [`NO_INDEX`](crate::mesh::NO_INDEX). The second and the third
    /// are empty while no corner names one.
    pub corners: [Vec<u32>; 3],
    /// Faces, lines and points together.
    pub element_count: usize,
    /// Elements that are no faces, in their order.
    pub no_faces: Vec<(usize, Element)>,
    pub face_count: usize,
    pub face_lines: LineRuns,
    pub materials: NamedRuns,
    pub groups: NamedRuns,
    /// Runs of faces, and their smoothing group; 0 is none. Empty if the file has no `s`.
    pub smoothing: Vec<(usize, u32)>,
    pub libraries: Libraries,
    /// Of each vertex, as far as there are any.
    pub colours: Vec<[f32; 3]>,
    coloured: usize,
    has_byte_colours: bool,
    /// Normals that are zero or not finite.
    pub useless_normals: usize,
    /// The highest index of each list, from 1, and the line of the element that has it.
    pub highest: [(usize, usize); 3],
    /// Statements that were left out.
    ignored: BTreeMap<String, Tally>,
    /// Faces left out, as they have an impossible index or too few corners; lines and points alike.
    pub dropped_faces: Tally,
    pub dropped_others: Tally,
    /// Corners without the texture coordinates or the normal that they name, as there is none.
    pub bare: Tally,
    /// Where texture coordinates are named, if there are none at all.
    idle_textures_line: Option<usize>,
    /// What tobj holds of the elements that it has lists of.
    copies: Copies,
}

impl Facts {
    /// The line, counted from 1, of an `f` statement, counted from 0.
    pub(super) fn face_line(&self, face: usize) -> usize {
        self.face_lines.line(face)
    }

    /// Counts a statement that is left out.
    pub(super) fn ignore(&mut self, keyword: &str, line: usize) {
        count_by_keyword(&mut self.ignored, keyword, line);
    }

    pub(super) fn begin_smoothing(&mut self, group: u32) {
        let last = self.smoothing.last();
        if last.is_none_or(|&(_, last)| last != group) {
            self.smoothing.push((self.face_count, group));
        }
    }

    /// The colour of the last vertex. Those that have none get what is white on any scale.
    pub(super) fn add_colour(&mut self, colour: [f32; 3]) {
        self.colours.resize(self.counts[0] - 1, [f32::INFINITY; 3]);
        self.colours.push(colour);
        self.coloured += 1;
    }

    /// A colour for each vertex, sRGB from 0 to 1, or none at all. Some programs write them from 0 to 255.
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
        // NaN is black.
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

    /// Notes an element whose corners are in the lists.
    pub(super) fn add_element(&mut self, element: Element, line: usize) {
        if element == Element::Face {
            self.materials.add_face(self.face_count);
            self.groups.add_face(self.face_count);
            self.face_count += 1;
            self.face_lines.push(line);
        } else {
            self.no_faces.push((self.element_count, element));
        }
        self.element_count += 1;
    }

    /// Leaves out an element of which corners were added to the lists.
    pub(super) fn drop_element(&mut self, element: Element, before: [usize; 3], line: usize) {
        for (list, length) in self.corners.iter_mut().zip(before) {
            list.truncate(length);
        }
        match element {
            Element::Face => self.dropped_faces.add(line),
            Element::Line | Element::Points => self.dropped_others.add(line),
        }
    }

    /// Elements since tobj's last list was ended.
    pub(super) fn elements_since_cut(&self) -> usize {
        self.element_count - self.copies.elements
    }

    /// tobj's list of faces was ended.
    pub(super) fn cut(&mut self) {
        self.copies.cut(&self.corners, self.element_count);
    }

    /// Whether each index so far names something that was read, as far as anything asks.
    pub(super) fn is_complete(&self) -> bool {
        List::ALL.into_iter().all(|list| {
            self.is_idle(list) || self.highest[list as usize].0 <= self.counts[list as usize]
        })
    }

    /// Some exporters number texture coordinates that they don't write. No list is no reason to refuse a file.
    pub(super) fn is_idle(&self, list: List) -> bool {
        list == List::Texture && self.counts[list as usize] == 0
    }

    /// At the end of the file: indices into a list that never came.
    pub(super) fn forget_idle_textures(&mut self) {
        let (highest, line) = self.highest[List::Texture as usize];
        if self.is_idle(List::Texture) && highest > 0 {
            self.highest[List::Texture as usize] = (0, 0);
            self.corners[List::Texture as usize] = Vec::new();
            self.idle_textures_line = Some(line);
        }
    }

    /// What was left out, in the order in which it began.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let ignored = self.ignored.iter().filter_map(|(keyword, tally)| {
            tally.warning(|count| format!("{count} “{keyword}” statement(s) ignored"))
        });
        let colourless = self.counts[0] - self.coloured;
        let uncoloured = (self.coloured > 0 && colourless > 0)
            .then(|| Warning::of_file(format!("{colourless} vertices without a colour are white")));
        let why = "dropped: an index is out of range, or there are too few corners";
        let mut warnings: Vec<Warning> = ignored
            .chain(
                self.dropped_faces
                    .warning(|count| format!("{count} face(s) {why}")),
            )
            .chain(
                self.dropped_others
                    .warning(|count| format!("{count} line(s) or point(s) {why}")),
            )
            .chain(self.bare.warning(|count| {
                format!("{count} texture or normal indices ignored: there are no such")
            }))
            .chain(self.idle_textures_line.map(|line| {
                Warning::at(
                    line,
                    "texture coordinates are named, but there are none".to_owned(),
                )
            }))
            .chain(uncoloured)
            .chain(self.has_byte_colours.then(|| {
                Warning::of_file("colours of vertices go beyond 1: taken as bytes".to_owned())
            }))
            .chain((self.useless_normals > 0).then(|| {
                let count = self.useless_normals;
                let message = format!("{count} normal(s) are zero or not finite: computed instead");
                Warning::of_file(message)
            }))
            .collect();
        warnings.sort_by_key(|warning| warning.line.unwrap_or(usize::MAX));
        warnings
    }

    /// Triangles, if every face becomes a fan.
    pub(super) fn triangle_count(&self) -> usize {
        self.corners[0].len().saturating_sub(2 * self.face_count)
    }

    /// What loading takes in memory at most, with what was read so far. Lists that grow count twice.
    pub(super) fn bytes(&mut self) -> usize {
        /// tobj's list in f64, ours, and what remains in f32 with a colour.
        const OF_ENTRY: usize = 2 * 24 + 24 + 24;
        /// tobj's copy for a list of faces.
        const OF_COPY: usize = 2 * 24;
        /// In our list and in tobj's.
        const OF_CORNER: usize = 2 * 4 + 2 * 4;
        /// Indices, face and outline, and each corner's normal and texture coordinates.
        const OF_TRIANGLE: usize = 2 * (12 + 4 + 1 + 12 + 12);
        /// tobj's `Face`, and a corner of it if there are more than four.
        const OF_PENDING_FACE: usize = 2 * 104;
        const OF_PENDING_CORNER: usize = 2 * 24;
        self.copies.look_at(&self.corners);
        let entries: usize = self.counts.iter().sum();
        let copies = self.copies.count(&self.corners);
        let corners: usize = self.corners.iter().map(Vec::len).sum();
        let pending_corners = self.corners[0].len().saturating_sub(self.copies.corners[0]);
        entries * OF_ENTRY
            + copies * OF_COPY
            + corners * OF_CORNER
            + self.triangle_count() * OF_TRIANGLE
            + self.elements_since_cut() * OF_PENDING_FACE
            + pending_corners * OF_PENDING_CORNER
            + self.names_bytes()
    }

    fn names_bytes(&self) -> usize {
        let runs = 16 * (self.smoothing.capacity() + self.no_faces.capacity());
        let colours = 2 * size_of_val(&self.colours[..]);
        let names = self.materials.bytes() + self.groups.bytes() + self.libraries.bytes();
        names + runs + colours + self.face_lines.bytes()
    }
}

/// Counts a statement by its keyword; in a file of any bytes there are too many to be told apart.
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

/// Line numbers of statements, kept as runs of statements on consecutive lines.
#[derive(Debug, Default)]
pub(super) struct LineRuns {
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

    pub(super) fn line(&self, statement: usize) -> usize {
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

    fn bytes(&self) -> usize {
        16 * self.runs.capacity()
    }
}

/// A word fit for a message: not long, and without what would move a terminal's cursor.
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

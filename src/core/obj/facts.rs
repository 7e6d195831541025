//! What the reader learns of a file besides the numbers that it passes on.

use super::error::Warning;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Marks a corner without an index in one of the lists of [`Facts::corners`].
pub(super) const NO_INDEX: u32 = u32::MAX;

/// What an element is, if it is no face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    /// A line through its corners.
    Line,
    /// Its corners are points.
    Points,
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

/// What the reader learnt on the way. Vertices, texture coordinates and normals are lists 0, 1 and 2.
#[derive(Debug, Default)]
pub(super) struct Facts {
    /// How many there are in each list.
    pub counts: [usize; 3],
    /// For each corner of each element its index, from 0, in each list. The second and the third are empty
    /// while no corner names one.
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
    /// Names of material libraries, each once, with the line.
    pub libraries: Vec<(usize, String)>,
    library_names: HashSet<String>,
    /// Of each vertex, as far as there are any.
    pub colours: Vec<[f32; 3]>,
    pub coloured: usize,
    /// The highest index of each list, from 1, and the line of the element that has it.
    pub highest: [(usize, usize); 3],
    /// Statements that were left out.
    pub ignored: BTreeMap<String, Tally>,
    /// Elements left out, as they have an impossible index or too few corners.
    pub dropped: Tally,
    /// Corners without the texture coordinates or the normal that they name, as there is none.
    pub bare: Tally,
}

impl Facts {
    /// The line, counted from 1, of an `f` statement, counted from 0.
    pub(super) fn face_line(&self, face: usize) -> usize {
        self.face_lines.line(face)
    }

    /// Notes a library, unless it was named before.
    pub(super) fn add_library(&mut self, line: usize, name: String) {
        if self.library_names.insert(name.clone()) {
            self.libraries.push((line, name));
        }
    }

    /// Counts a statement that is left out.
    pub(super) fn ignore(&mut self, keyword: &str, line: usize) {
        count_by_keyword(&mut self.ignored, keyword, line);
    }

    /// Whether each index so far names something that was read.
    pub(super) fn is_complete(&self) -> bool {
        let lists = self.highest.iter().zip(self.counts);
        lists
            .into_iter()
            .all(|((highest, _), count)| *highest <= count)
    }

    /// Some exporters number texture coordinates that they don't write. No list is no reason to refuse a file.
    pub(super) fn forget_idle_textures(&mut self) {
        let (highest, line) = self.highest[1];
        if self.counts[1] == 0 && highest > 0 {
            self.highest[1] = (0, 0);
            self.corners[1] = Vec::new();
            self.bare.add(line);
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
        let mut warnings: Vec<Warning> = ignored
            .chain(self.dropped.warning(|count| {
                format!("{count} face(s) dropped: an index is out of range, or there are fewer than three corners")
            }))
            .chain(self.bare.warning(|count| {
                format!("{count} or more texture or normal indices ignored: there are no such")
            }))
            .chain(uncoloured)
            .collect();
        warnings.sort_by_key(|warning| warning.line.unwrap_or(usize::MAX));
        warnings
    }

    /// What loading takes in memory, with what was read so far: an upper bound that is good for files that
    /// are large.
    pub(super) fn bytes(&self) -> usize {
        /// tobj's list in f64, doubled as it grows, its copy for faces, ours, and what remains in f32.
        const OF_VERTEX: usize = 48 + 48 + 24 + 12;
        /// Ours doubled as it grows, tobj's, and what remains.
        const OF_CORNER: usize = 8 + 8 + 4;
        let entries: usize = self.counts.iter().sum();
        let corners: usize = self.corners.iter().map(Vec::len).sum();
        let names = self.materials.bytes() + self.groups.bytes();
        let libraries: usize = self
            .libraries
            .iter()
            .map(|(_, name)| 128 + 2 * name.len())
            .sum();
        let runs = 16 * (self.smoothing.capacity() + self.no_faces.capacity());
        entries * OF_VERTEX
            + corners * OF_CORNER
            + size_of_val(&self.colours[..]) * 2
            + names
            + libraries
            + runs
            + self.face_lines.bytes()
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

/// Runs of faces that go by a name: the faces of a group, or of a material.
#[derive(Debug)]
pub(super) struct NamedRuns {
    /// Distinct names; the first one, empty, is for faces before any run.
    pub names: Vec<String>,
    by_name: HashMap<String, u32>,
    /// The first face, and the index of the name that it and those after it have.
    pub runs: Vec<(usize, u32)>,
    text_bytes: usize,
}

impl Default for NamedRuns {
    fn default() -> Self {
        Self {
            names: vec![String::new()],
            by_name: HashMap::from([(String::new(), 0)]),
            runs: Vec::new(),
            text_bytes: 0,
        }
    }
}

impl NamedRuns {
    /// From this face on.
    pub(super) fn begin(&mut self, face: usize, name: String) {
        let next = self.names.len() as u32;
        let index = *self.by_name.entry(name).or_insert_with_key(|name| {
            self.names.push(name.clone());
            self.text_bytes += 2 * name.len();
            next
        });
        // A run without a face is none.
        match self.runs.last_mut() {
            Some((first, last)) if *first == face => *last = index,
            _ => self.runs.push((face, index)),
        }
    }

    fn bytes(&self) -> usize {
        /// Two strings and an entry of a hash map that is half full.
        const OF_NAME: usize = 24 + 2 * 32 + 32;
        self.names.len() * OF_NAME + self.text_bytes + 16 * self.runs.capacity()
    }
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

/// A word fit for a message.
pub(super) fn shortened(word: &str) -> String {
    const LENGTH: usize = 40;
    if word.chars().count() <= LENGTH {
        word.to_owned()
    } else {
        word.chars().take(LENGTH).chain(['…']).collect()
    }
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

    #[test]
    fn a_name_that_comes_back_is_one_name() {
        let mut runs = NamedRuns::default();
        for (face, name) in [(0, "a"), (2, "b"), (2, "c"), (4, "a")] {
            runs.begin(face, name.to_owned());
        }
        assert_eq!(runs.names, ["", "a", "b", "c"]);
        assert_eq!(runs.runs, [(0, 1), (2, 3), (4, 1)]);
    }
}

//! The materials, groups and libraries that a file names.

use std::collections::{HashMap, HashSet};

/// Runs of faces that go by a name: the faces of a group, or of a material.
#[derive(Debug)]
pub(super) struct NamedRuns {
    /// Distinct names; the first one, empty, is for faces before any run.
    pub names: Vec<String>,
    by_name: HashMap<String, u32>,
    /// The name that the next face gets.
    next: Option<String>,
    /// The first face, and the index of the name that it and those after it have.
    pub runs: Vec<(usize, u32)>,
    text_bytes: usize,
}

impl Default for NamedRuns {
    fn default() -> Self {
        Self {
            names: vec![String::new()],
            by_name: HashMap::from([(String::new(), 0)]),
            next: None,
            runs: Vec::new(),
            text_bytes: 0,
        }
    }
}

impl NamedRuns {
    /// Gives the next face and those after it a name.
    pub(super) fn begin(&mut self, name: String) {
        self.next = Some(name);
    }

    /// Notes a face. A name that no face gets isn't kept.
    pub(super) fn add_face(&mut self, face: usize) {
        let Some(name) = self.next.take() else {
            return;
        };
        let next = self.names.len() as u32;
        let index = *self.by_name.entry(name).or_insert_with_key(|name| {
            self.names.push(name.clone());
            self.text_bytes += 2 * name.len();
            next
        });
        self.runs.push((face, index));
    }

    pub(super) fn bytes(&self) -> usize {
        /// Two strings and an entry of a hash map that is half full.
        const OF_NAME: usize = 24 + 2 * 32 + 32;
        self.names.len() * OF_NAME + self.text_bytes + 16 * self.runs.capacity()
    }
}

/// The material libraries that a file names, each once, with the line.
#[derive(Debug, Default)]
pub(super) struct Libraries {
    pub names: Vec<(usize, String)>,
    seen: HashSet<String>,
    text_bytes: usize,
}

impl Libraries {
    pub(super) fn add(&mut self, line: usize, name: String) {
        if self.seen.insert(name.clone()) {
            self.text_bytes += 2 * name.len();
            self.names.push((line, name));
        }
    }

    pub(super) fn bytes(&self) -> usize {
        /// A number and a string, twice for growth, and an entry of a hash set that is half full.
        const OF_NAME: usize = 2 * 32 + 2 * 32;
        self.names.len() * OF_NAME + self.text_bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_comes_back_is_one_name() {
        let mut runs = NamedRuns::default();
        for (face, name) in [(0, "a"), (2, "unused"), (2, "c"), (4, "a")] {
            runs.begin(name.to_owned());
            if name != "unused" {
                runs.add_face(face);
            }
        }
        assert_eq!(runs.names, ["", "a", "c"]);
        assert_eq!(runs.runs, [(0, 1), (2, 2), (4, 1)]);
    }
}

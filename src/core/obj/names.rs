//! Materials, groups and libraries named in a file.

use std::collections::{HashMap, HashSet};

/// Named runs of faces: groups or materials.
#[derive(Debug)]
pub(super) struct NamedRuns {
    /// Distinct names; the first, empty one is for faces before any run.
    pub names: Vec<String>,
    by_name: HashMap<String, u32>,
    /// The name of the next face, if it changes.
    next: Option<String>,
    /// The first face of each run, and the index of its name.
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
    /// Sets the name of the next face and those after it.
    pub(super) fn begin(&mut self, name: String) {
        self.next = Some(name);
    }

    /// Adds a face. Names without faces aren't kept.
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
        /// Two strings and an entry of a half-full hash map.
        const OF_NAME: usize = 24 + 2 * 32 + 32;
        self.names.len() * OF_NAME + self.text_bytes + 16 * self.runs.capacity()
    }
}

/// Distinct names of material libraries in a file, with their lines.
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
        /// A number and a string, twice for growth, and an entry of a half-full hash set.
        const OF_NAME: usize = 2 * 32 + 2 * 32;
        self.names.len() * OF_NAME + self.text_bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repeated_name_is_stored_once() {
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

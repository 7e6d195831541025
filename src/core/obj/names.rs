//! The names of materials, groups and material libraries in a file.

use std::collections::{HashMap, HashSet};

/// Named runs of consecutive faces: groups or materials.
#[derive(Debug)]
pub(super) struct NamedRuns {
    /// The distinct names. The first is empty, for faces before the first run.
    pub names: Vec<String>,
    by_name: HashMap<String, u32>,
    /// The current run: its first face and its name.
    current: Option<(usize, String)>,
    /// The first face and the name index of each run.
    pub runs: Vec<(usize, u32)>,
}

impl Default for NamedRuns {
    fn default() -> Self {
        Self {
            names: vec![String::new()],
            by_name: HashMap::from([(String::new(), 0)]),
            current: None,
            runs: Vec::new(),
        }
    }
}

impl NamedRuns {
    /// Begins a run at `face`.
    pub(super) fn begin(&mut self, face: usize, name: String) {
        self.end(face);
        self.current = Some((face, name));
    }

    /// Ends the current run before `face`. Discards the run if it has no faces.
    pub(super) fn end(&mut self, face: usize) {
        let Some((first, name)) = self.current.take().filter(|(first, _)| *first < face) else {
            return;
        };
        let next = self.names.len() as u32;
        let index = *self.by_name.entry(name).or_insert_with_key(|name| {
            self.names.push(name.clone());
            next
        });
        self.runs.push((first, index));
    }
}

/// The distinct arguments of a file's `mtllib` statements.
#[derive(Debug, Default)]
pub(super) struct LibraryNames {
    /// The line and the argument of each statement.
    pub names: Vec<(usize, String)>,
    seen: HashSet<String>,
}

impl LibraryNames {
    pub(super) fn add(&mut self, line: usize, name: String) {
        if self.seen.insert(name.clone()) {
            self.names.push((line, name));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_names_are_stored_once_and_unused_names_are_discarded() {
        let mut runs = NamedRuns::default();
        for (face, name) in [(0, "a"), (2, "unused"), (2, "c"), (4, "a"), (6, "unused")] {
            runs.begin(face, name.to_owned());
        }
        runs.end(6);
        assert_eq!(runs.names, ["", "a", "c"]);
        assert_eq!(runs.runs, [(0, 1), (2, 2), (4, 1)]);
    }
}

//! Materials, groups and libraries named in a file.

use std::collections::{HashMap, HashSet};

/// Named runs of faces: groups or materials.
#[derive(Debug)]
pub(super) struct NamedRuns {
    /// Distinct names; the first, empty one is for faces before any run.
    pub names: Vec<String>,
    by_name: HashMap<String, u32>,
    /// The newest name, and the first face that it applies to.
    newest: Option<(usize, String)>,
    /// The first face of each run, and the index of its name.
    pub runs: Vec<(usize, u32)>,
}

impl Default for NamedRuns {
    fn default() -> Self {
        Self {
            names: vec![String::new()],
            by_name: HashMap::from([(String::new(), 0)]),
            newest: None,
            runs: Vec::new(),
        }
    }
}

impl NamedRuns {
    /// Sets the name of the faces from `face` on.
    pub(super) fn begin(&mut self, face: usize, name: String) {
        self.end(face);
        self.newest = Some((face, name));
    }

    /// Ends the newest run before `face`. Names without faces aren't kept.
    pub(super) fn end(&mut self, face: usize) {
        let Some((first, name)) = self.newest.take().filter(|(first, _)| *first < face) else {
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

/// Distinct names of material libraries in a file, with their lines.
#[derive(Debug, Default)]
pub(super) struct Libraries {
    pub names: Vec<(usize, String)>,
    seen: HashSet<String>,
}

impl Libraries {
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
    fn a_repeated_name_is_stored_once_and_an_unused_one_not_at_all() {
        let mut runs = NamedRuns::default();
        for (face, name) in [(0, "a"), (2, "unused"), (2, "c"), (4, "a"), (6, "unused")] {
            runs.begin(face, name.to_owned());
        }
        runs.end(6);
        assert_eq!(runs.names, ["", "a", "c"]);
        assert_eq!(runs.runs, [(0, 1), (2, 2), (4, 1)]);
    }
}

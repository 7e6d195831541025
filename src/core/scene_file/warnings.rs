//! The warnings about a scene: equal ones are counted.

use super::description::Place;
use crate::counts::{counted, grouped};
use crate::obj::{Warning, shown};
use std::collections::HashMap;
use std::path::PathBuf;

/// The number of different warnings that are listed.
const MAX_LISTED: usize = 100;

#[derive(Default)]
pub(super) struct Warnings {
    listed: Vec<Repeated>,
    /// Indices of the messages in the list.
    by_message: HashMap<String, usize>,
    unlisted_count: usize,
}

/// A warning, where it occurs first, and how often it occurs.
struct Repeated {
    place: Place,
    message: String,
    count: usize,
}

impl Warnings {
    pub(super) fn add(&mut self, place: Place, message: String) {
        if let Some(&known) = self.by_message.get(&message) {
            self.listed[known].count += 1;
        } else if self.listed.len() < MAX_LISTED {
            self.by_message.insert(message.clone(), self.listed.len());
            self.listed.push(Repeated {
                place,
                message,
                count: 1,
            });
        } else {
            self.unlisted_count += 1;
        }
    }

    /// The warnings in the order of their first lines. Those about included files name the file.
    pub(super) fn finish(self, files: &[PathBuf]) -> Vec<Warning> {
        let listed = self.listed.into_iter().map(|repeated| {
            let Repeated {
                place,
                mut message,
                count,
            } = repeated;
            if count > 1 {
                message += &format!(" ({} times)", grouped(count));
            }
            match files.get(place.file as usize) {
                Some(path) if place.file > 0 => {
                    let path = shown(path);
                    Warning::of_file(format!("{path}:{}: {message}", place.line))
                }
                _ => Warning::at(place.line as usize, message),
            }
        });
        let more = (self.unlisted_count > 0)
            .then(|| Warning::of_file(counted(self.unlisted_count, "more warning")));
        listed.chain(more).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_warnings_are_counted_and_included_files_named() {
        let mut warnings = Warnings::default();
        let at = |file, line| Place { file, line };
        for (place, message) in [(at(0, 2), "a"), (at(1, 1), "b"), (at(0, 5), "a")] {
            warnings.add(place, message.to_owned());
        }
        for k in 0..MAX_LISTED {
            warnings.add(at(0, 9), format!("c{k}"));
        }
        let texts = warnings.finish(&["x.xml".into(), "sub/y.xml".into()]);
        let texts: Vec<String> = texts.iter().map(ToString::to_string).collect();
        assert_eq!(texts[..2], ["line 2: a (2 times)", "sub/y.xml:1: b"]);
        assert_eq!(texts.len(), MAX_LISTED + 1);
        assert_eq!(texts[MAX_LISTED], "2 more warnings");
    }
}

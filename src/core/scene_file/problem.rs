//! Reasons why a scene can't be read, and names in messages.

use super::description::Place;
use crate::names::{alternatives, nearest};
use crate::obj::{LoadError, shown};
use crate::progress::Cancelled;
use std::path::{Path, PathBuf};

/// A [`LoadError`] whose file is an index into the list of files.
#[derive(Debug)]
pub(super) enum Problem {
    Line {
        place: Place,
        column: Option<usize>,
        message: String,
    },
    Content {
        file: u32,
        message: String,
    },
    Cancelled,
}

impl Problem {
    pub(super) fn at(place: Place, message: impl Into<String>) -> Self {
        Self::Line {
            place,
            column: None,
            message: message.into(),
        }
    }

    pub(super) fn of_file(file: u32, message: impl Into<String>) -> Self {
        Self::Content {
            file,
            message: message.into(),
        }
    }

    pub(super) fn with_path(self, files: &[PathBuf]) -> LoadError {
        let path_of = |file: u32| files.get(file as usize).cloned().unwrap_or_default();
        match self {
            Self::Line {
                place,
                column,
                message,
            } => LoadError::Line {
                path: path_of(place.file),
                line: place.line as usize,
                column,
                message,
            },
            Self::Content { file, message } => LoadError::Content {
                path: path_of(file),
                message,
            },
            Self::Cancelled => LoadError::Cancelled { path: path_of(0) },
        }
    }
}

impl From<Cancelled> for Problem {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A text from the file for messages: quoted, shortened, without control characters.
pub(crate) fn quoted(text: &str) -> String {
    /// As many as fit on a line with the rest of a message.
    const LENGTH: usize = 60;
    let rest = text.chars().nth(LENGTH).map_or("", |_| "…");
    let start: String = text.chars().take(LENGTH).collect();
    format!("“{}{rest}”", shown(Path::new(&start)))
}

/// The message about a name that isn't known, with the nearest known one, or else all if they are few. `what` names its
/// kind.
pub(super) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    /// As many as a message can list: the kinds of shapes.
    const MOST_LISTED: usize = 12;
    let hint = match nearest(name, known.iter().copied()) {
        Some(nearest) => format!("; the nearest known one is {}", quoted(nearest)),
        None if (1..=MOST_LISTED).contains(&known.len()) => {
            let known: Vec<String> = known.iter().map(|name| quoted(name)).collect();
            format!("; expected {}", alternatives(&known))
        }
        None => String::new(),
    };
    format!("unknown {what} {}{hint}", quoted(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_name_is_reported_with_the_nearest_one_or_all() {
        let known = ["sphere", "cylinder", "disk"];
        assert_eq!(
            unknown("shape", "Spere", &known),
            "unknown shape “Spere”; the nearest known one is “sphere”"
        );
        assert_eq!(
            unknown("shape", "ball", &known),
            "unknown shape “ball”; expected “sphere”, “cylinder” or “disk”"
        );
        assert_eq!(unknown("shape", "ball", &["x"; 13]), "unknown shape “ball”");
        assert_eq!(unknown("shape", "a", &[]), "unknown shape “a”");
    }

    #[test]
    fn long_names_and_control_characters_are_replaced() {
        assert_eq!(quoted("a\nb"), "“a\u{FFFD}b”");
        let long = "x".repeat(61);
        assert_eq!(quoted(&long), format!("“{}…”", &long[..60]));
        assert_eq!(quoted(&long[..60]), format!("“{}”", &long[..60]));
    }
}

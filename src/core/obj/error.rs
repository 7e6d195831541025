//! Errors and warnings from loading OBJ files.

use crate::progress::Cancelled;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// An error that prevents a file from loading. Every message names the file and, if known, the line.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file can't be opened or read.
    #[error("{}: {}", shown(path), reason(source))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The path is a directory.
    #[error("{}: this is a directory, not an OBJ file", shown(path))]
    Directory {
        /// The directory.
        path: PathBuf,
    },
    /// A line is malformed.
    #[error("{}:{line}{}: {message}", shown(path), column.map(|c| format!(":{c}")).unwrap_or_default())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The character at which the malformed word starts, counted from 1.
        column: Option<usize>,
        /// The problem.
        message: String,
    },
    /// The file isn't an OBJ, has nothing to show, or exceeds a limit.
    #[error("{}: {message}", shown(path))]
    Content {
        /// The file.
        path: PathBuf,
        /// The problem.
        message: String,
    },
    /// The load was cancelled.
    #[error("{}: loading was cancelled", shown(path))]
    Cancelled {
        /// The file.
        path: PathBuf,
    },
}

/// A path for messages. Replaces control characters, which could move a terminal's cursor.
pub fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy())
}

/// Why a file can't be read or written, as text for the user.
pub fn reason(error: &io::Error) -> String {
    let text = match error.kind() {
        io::ErrorKind::NotFound => return "not found".to_owned(),
        io::ErrorKind::PermissionDenied => return "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => return "a folder of the path is a file".to_owned(),
        _ => error.to_string(),
    };
    // The number of the error is for programs.
    let words = text.rsplit_once(" (os error ");
    words.map_or(text.as_str(), |(words, _)| words).to_owned()
}

/// Replaces control characters and bidirectional formatting characters in a text.
pub(crate) fn printable(text: &str) -> String {
    let is_bidi_control = |c: char| matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    let replaced = |c: char| {
        if c.is_control() || is_bidi_control(c) {
            '\u{FFFD}'
        } else {
            c
        }
    };
    text.chars().map(replaced).collect()
}

/// A [`LoadError`] without the file's path.
#[derive(Debug)]
pub(super) enum Problem {
    Line {
        line: usize,
        column: Option<usize>,
        message: String,
    },
    Content(String),
    Read(io::Error),
    Cancelled,
}

impl Problem {
    pub(super) fn line(line: usize, message: String) -> Self {
        Self::Line {
            line,
            column: None,
            message,
        }
    }

    pub(super) fn in_file(self, path: &Path) -> LoadError {
        let path = path.to_owned();
        match self {
            Self::Line {
                line,
                column,
                message,
            } => LoadError::Line {
                path,
                line,
                column,
                message,
            },
            Self::Content(message) => LoadError::Content { path, message },
            Self::Read(source) => LoadError::Unreadable { path, source },
            Self::Cancelled => LoadError::Cancelled { path },
        }
    }
}

impl From<Cancelled> for Problem {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A warning about a file whose mesh was loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The first line with the problem, counted from 1; `None` if the warning is about the file as a whole.
    pub line: Option<usize>,
    /// The problem, and how often it occurs.
    pub message: String,
}

impl Warning {
    pub(crate) fn at(line: usize, message: String) -> Self {
        Self {
            line: Some(line),
            message,
        }
    }

    pub(crate) fn of_file(message: String) -> Self {
        Self {
            line: None,
            message,
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_line_without_control_characters() {
        let path = Path::new("a\n\u{1b}[31m\u{202e}é.obj");
        let error = Problem::Content("too bad".to_owned()).in_file(path);
        let expected = "a\u{FFFD}\u{FFFD}[31m\u{FFFD}é.obj: too bad";
        assert_eq!(error.to_string(), expected);
    }
}

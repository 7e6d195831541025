//! Messages to the user on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

/// Prints a line. If stderr is closed or full, the line is lost without an error.
pub fn print_line(line: impl Display) {
    _ = writeln!(io::stderr(), "{line}");
}

/// A progress line, printed on terminals only.
#[derive(Clone, Copy)]
pub(super) struct ProgressLine {
    is_terminal: bool,
}

impl ProgressLine {
    pub(super) fn new() -> Self {
        Self {
            is_terminal: io::stderr().is_terminal(),
        }
    }

    /// Prints a permanent line.
    pub(super) fn print(self, line: impl Display) {
        if self.is_terminal {
            print_line(line);
        }
    }

    /// Overwrites the progress line.
    pub(super) fn update(self, line: impl Display) {
        if self.is_terminal {
            // Spaces overwrite the end of a longer line.
            _ = write!(io::stderr(), "\r{line}     ");
        }
    }

    /// Ends the progress line.
    pub(super) fn end(self) {
        self.print("");
    }
}

//! Messages to the user on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

/// Prints a line. Where stderr is closed or full, the line is lost, and nothing else happens.
pub fn print_line(line: impl Display) {
    _ = writeln!(io::stderr(), "{line}");
}

/// Progress of a command, printed on terminals only.
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

    /// Prints a line that stays.
    pub(super) fn print(self, line: impl Display) {
        if self.is_terminal {
            print_line(line);
        }
    }

    /// Prints over the line before.
    pub(super) fn update(self, line: impl Display) {
        if self.is_terminal {
            // Spaces cover the rest of a longer line.
            _ = write!(io::stderr(), "\r{line}     ");
        }
    }

    /// Ends the line that was updated.
    pub(super) fn end(self) {
        self.print("");
    }
}

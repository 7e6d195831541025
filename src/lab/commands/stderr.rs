//! Messages to the user on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

/// Prints a line. If stderr is closed or full, the line is lost without an error.
pub fn print_line(line: impl Display) {
    _ = writeln!(io::stderr(), "{line}");
}

/// Prints a line if stderr is a terminal.
pub(super) fn print_on_terminal(line: impl Display) {
    if io::stderr().is_terminal() {
        print_line(line);
    }
}

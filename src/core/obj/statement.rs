//! Splits a chunk into statements.
//!
//! Lines end in LF, CR or CRLF; a backslash at the end of a line joins the next one.

use super::chunks::Chunk;
use super::error::Problem;
use super::keyword::Keyword;
use super::words::{Words, without_comment};
use memchr::{memchr_iter, memchr2};

/// A statement as written in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Statement<'c> {
    /// The line on which it starts, counted from 1.
    pub line: usize,
    pub bytes: &'c [u8],
    /// Whether it was joined from several lines.
    pub is_joined: bool,
}

impl<'c> Statement<'c> {
    /// The first word, and the offset after it; `None` if the line is empty.
    pub(super) fn keyword(&self) -> Option<(&'c [u8], usize)> {
        let (start, word) = Words::of(self.bytes, 0).next()?;
        Some((word, start + word.len()))
    }

    pub(super) fn without_comment(self) -> Self {
        Self {
            bytes: without_comment(self.bytes),
            ..self
        }
    }

    pub(super) fn problem(&self, message: String) -> Problem {
        Problem::line(self.line, message)
    }

    /// An error about the word that starts at an offset.
    pub(super) fn problem_at(&self, offset: usize, message: String) -> Problem {
        let is_start = |b: &&u8| **b & 0xC0 != 0x80;
        let characters = self.bytes[..offset].iter().filter(is_start).count();
        Problem::Line {
            line: self.line,
            // Columns in joined lines are unknown.
            column: (!self.is_joined).then_some(characters + 1),
            message,
        }
    }
}

/// Splits a chunk into statements.
pub(super) struct Statements<'c> {
    rest: &'c [u8],
    next_line: usize,
    /// Buffer for a statement of several lines.
    joined: Vec<u8>,
}

impl<'c> Statements<'c> {
    pub(super) fn of(chunk: &'c Chunk) -> Self {
        Self {
            rest: &chunk.bytes,
            next_line: chunk.first_line,
            joined: Vec::new(),
        }
    }

    /// The text from the next statement on.
    pub(super) fn rest(&self) -> &'c [u8] {
        self.rest
    }

    /// The line on which the next statement starts.
    pub(super) fn next_line(&self) -> usize {
        self.next_line
    }

    /// Passes a statement of one line, whose length includes the end of the line.
    pub(super) fn skip_line(&mut self, length: usize) {
        self.rest = &self.rest[length..];
        self.next_line += 1;
    }

    /// The next statement, or `None` at the end. Empty lines are statements, too.
    pub(super) fn next(&mut self) -> Option<Statement<'_>> {
        let line = self.next_line;
        let bytes = self.take_line()?;
        let Some(continued) = before_backslash(bytes) else {
            return Some(Statement {
                line,
                bytes,
                is_joined: false,
            });
        };
        self.joined.clear();
        self.joined.extend(continued);
        while let Some(more) = self.take_line() {
            self.joined.push(b' ');
            let continued = before_backslash(more);
            self.joined.extend(continued.unwrap_or(more));
            if continued.is_none() {
                break;
            }
        }
        Some(Statement {
            line,
            bytes: &self.joined,
            is_joined: true,
        })
    }

    /// The next line, without its end.
    fn take_line(&mut self) -> Option<&'c [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.next_line += 1;
        let Some(end) = memchr2(b'\n', b'\r', self.rest) else {
            return Some(std::mem::take(&mut self.rest));
        };
        let (line, rest) = self.rest.split_at(end);
        let step = if rest.starts_with(b"\r\n") { 2 } else { 1 };
        self.rest = &rest[step..];
        Some(line)
    }
}

/// The line without its final backslash, if it continues on the next line. Comments don't continue.
pub(super) fn before_backslash(line: &[u8]) -> Option<&[u8]> {
    let continued = line.trim_ascii_end().strip_suffix(b"\\")?;
    let (_, word) = Words::of(line, 0).next()?;
    let keyword = Keyword::of(word);
    let has_numbers = matches!(keyword, Some(Keyword::Numbers(_) | Keyword::Element(_)));
    // A name may contain a #.
    let begins_word = |at: usize| at == 0 || line[at - 1].is_ascii_whitespace();
    let has_comment = if has_numbers {
        without_comment(line).len() < line.len()
    } else {
        memchr_iter(b'#', line).any(begins_word)
    };
    (!has_comment).then_some(continued)
}

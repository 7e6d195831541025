//! Splits an OBJ or MTL file into statements.
//!
//! Lines end in LF, CR or CRLF; a backslash at the end of a line joins the next one. A byte order mark is
//! removed, UTF-16 converted to UTF-8, gzip decompressed.

use super::error::Problem;
use super::gzip::{GzipMembers, MAGIC};
use super::kind::not_an_obj;
use crate::progress::{Phase, Progress};
use encoding_rs_io::DecodeReaderBytesBuilder;
use memchr::{memchr_iter, memchr2};
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Read};
use std::rc::Rc;

/// Bytes read between two cancellation checks.
const PIECE: usize = 1 << 18;
/// Longest line that is read; a polygon of ten million corners would fit.
const LONGEST_LINE: usize = 128 << 20;

/// Number of bytes by which other file formats are recognised.
const ENOUGH_TO_TELL: usize = 1 << 10;

/// Splits a text into statements.
pub(super) struct Lines<'p> {
    source: Box<dyn Read + 'p>,
    progress: &'p Progress,
    /// Bytes read but not yet split into lines, from `start` on.
    buffer: Vec<u8>,
    start: usize,
    is_at_end: bool,
    line: usize,
    longest_line: usize,
    /// Buffer for a statement of several lines.
    joined: Vec<u8>,
    has_garbage: Rc<Cell<bool>>,
}

/// A statement as written in the file, and the line (from 1) on which it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Statement<'l> {
    pub line: usize,
    pub bytes: &'l [u8],
    /// Whether the statement was joined from several lines.
    pub is_joined: bool,
}

impl Statement<'_> {
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

impl<'p> Lines<'p> {
    /// # Errors
    /// The source can't be read.
    pub(super) fn new(bytes: impl Read + 'p, progress: &'p Progress) -> Result<Self, Problem> {
        let counted = CountingReader { bytes, progress };
        let mut source = BufReader::with_capacity(PIECE, counted);
        progress.check()?;
        let is_gzip = source
            .fill_buf()
            .map_err(Problem::Read)?
            .starts_with(&MAGIC);
        let has_garbage = Rc::default();
        let source: Box<dyn Read> = if is_gzip {
            Box::new(GzipMembers::new(source, Rc::clone(&has_garbage)))
        } else {
            Box::new(source)
        };
        let decoded = DecodeReaderBytesBuilder::new()
            .bom_sniffing(true)
            .utf8_passthru(true)
            .strip_bom(true)
            .build(source);
        Ok(Self {
            source: Box::new(decoded),
            progress,
            buffer: Vec::new(),
            start: 0,
            is_at_end: false,
            line: 0,
            longest_line: LONGEST_LINE,
            joined: Vec::new(),
            has_garbage,
        })
    }

    /// Limits lines to a quarter of the allowed memory, as the buffer doubles when it grows.
    pub(super) fn limit_lines(&mut self, max_memory: u64) {
        let most = usize::try_from(max_memory / 4).unwrap_or(LONGEST_LINE);
        self.longest_line = most.clamp(PIECE, LONGEST_LINE);
    }

    /// Checks the first bytes, before the first statement is read.
    ///
    /// # Errors
    /// The file is recognised as another format.
    pub(super) fn require_obj(&mut self) -> Result<(), Problem> {
        // A source may return a few bytes at a time.
        while self.buffer.len() < ENOUGH_TO_TELL && !self.is_at_end {
            self.fill()?;
        }
        not_an_obj(&self.buffer).map_or(Ok(()), |what| Err(Problem::Content(what)))
    }

    /// The next statement, or `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Statement<'_>>, Problem> {
        let Some((from, to)) = self.next_line()? else {
            return Ok(None);
        };
        let line = self.line;
        let Some(continued) = before_backslash(&self.buffer[from..to]) else {
            return Ok(Some(Statement {
                line,
                bytes: &self.buffer[from..to],
                is_joined: false,
            }));
        };
        self.joined.clear();
        self.joined.extend(continued);
        while let Some((from, to)) = self.next_line()? {
            let more = &self.buffer[from..to];
            self.joined.push(b' ');
            let Some(continued) = before_backslash(more) else {
                self.joined.extend(more);
                break;
            };
            self.joined.extend(continued);
            if self.joined.len() > self.longest_line {
                return Err(too_long(line, self.longest_line));
            }
        }
        Ok(Some(Statement {
            line,
            bytes: &self.joined,
            is_joined: true,
        }))
    }

    /// Whether the whole text has been read.
    pub(super) fn is_at_end(&self) -> bool {
        self.is_at_end
    }

    /// Whether bytes other than zeros follow the gzip data.
    pub(super) fn has_garbage(&self) -> bool {
        self.has_garbage.get()
    }

    /// The range of the next line in the buffer, without its line end.
    fn next_line(&mut self) -> Result<Option<(usize, usize)>, Problem> {
        let mut searched = 0;
        let (length, step) = loop {
            let rest = &self.buffer[self.start..];
            match memchr2(b'\n', b'\r', &rest[searched..]).map(|at| at + searched) {
                // A CR at the end of the buffer may be half of a CRLF, so more bytes are needed.
                Some(at) if rest[at] == b'\n' || at + 1 < rest.len() || self.is_at_end => {
                    let is_pair = rest[at] == b'\r' && rest.get(at + 1) == Some(&b'\n');
                    break (at, at + 1 + usize::from(is_pair));
                }
                _ if self.is_at_end && rest.is_empty() => return Ok(None),
                _ if self.is_at_end => break (rest.len(), rest.len()),
                found => searched = found.unwrap_or(rest.len()),
            }
            self.fill()?;
        };
        let from = self.start;
        self.line += 1;
        self.start += step;
        Ok(Some((from, from + length)))
    }

    fn fill(&mut self) -> Result<(), Problem> {
        self.progress.check()?;
        self.buffer.drain(..self.start);
        self.start = 0;
        let before = self.buffer.len();
        if before > self.longest_line {
            return Err(too_long(self.line + 1, self.longest_line));
        }
        self.buffer.resize(before + PIECE, 0);
        let count = loop {
            match self.source.read(&mut self.buffer[before..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.progress.check()?;
                    return Err(Problem::Read(error));
                }
                Ok(count) => break count,
            }
        };
        self.buffer.truncate(before + count);
        self.is_at_end = count == 0;
        if self.is_at_end {
            self.progress.enter(Phase::Checking);
        }
        Ok(())
    }
}

/// The line without its final backslash, if it continues on the next line. Comments don't continue.
fn before_backslash(line: &[u8]) -> Option<&[u8]> {
    let continued = line.trim_ascii_end().strip_suffix(b"\\")?;
    // A name may contain a #.
    let begins_word = |at: usize| at == 0 || line[at - 1].is_ascii_whitespace();
    let has_comment = memchr_iter(b'#', line).any(begins_word);
    (!has_comment).then_some(continued)
}

fn too_long(line: usize, longest: usize) -> Problem {
    Problem::line(
        line,
        format!("the line is longer than {} MB", longest >> 20),
    )
}

/// Counts the bytes read, and returns an error once the load is cancelled.
struct CountingReader<'p, R> {
    bytes: R,
    progress: &'p Progress,
}

impl<R: Read> Read for CountingReader<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        // Compressed bytes may decompress to nothing for a long time.
        self.progress.check().map_err(io::Error::other)?;
        let count = self.bytes.read(out)?;
        self.progress.add_read(count as u64);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn lines_of(bytes: &[u8]) -> Vec<(usize, String)> {
        let progress = Progress::default();
        let mut lines = Lines::new(bytes, &progress).expect("bytes");
        let mut found = Vec::new();
        while let Some(Statement { line, bytes, .. }) = lines.next().expect("good") {
            found.push((line, String::from_utf8_lossy(bytes).into_owned()));
        }
        found
    }

    fn gzipped(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).expect("memory");
        encoder.finish().expect("memory")
    }

    #[test]
    fn lines_have_any_line_end_and_continue_after_a_backslash() {
        let expected = [(1, "v 1"), (2, ""), (3, "f 1  2 3"), (5, "g a")];
        let expected: Vec<(usize, String)> = expected.map(|(n, text)| (n, text.to_owned())).into();
        for end in ["\n", "\r", "\r\n"] {
            let text = ["v 1", "", "f 1 \\", "2 3", "g a"].join(end);
            assert_eq!(lines_of(text.as_bytes()), expected);
            let marked = [b"\xEF\xBB\xBF", text.as_bytes()].concat();
            assert_eq!(lines_of(&marked), expected);
            assert_eq!(lines_of(&gzipped(&marked)), expected);
            let wide = text.encode_utf16().flat_map(u16::to_le_bytes);
            let wide: Vec<u8> = [0xFF, 0xFE].into_iter().chain(wide).collect();
            assert_eq!(lines_of(&wide), expected);
        }
        assert_eq!(lines_of(b"f 1 \\"), [(1, "f 1 ".to_owned())]);
        assert_eq!(lines_of(b"f 1 \\ \t\n2"), [(1, "f 1  2".to_owned())]);
    }

    #[test]
    fn a_comment_does_not_continue_after_a_backslash() {
        let comment = r" # C:\models\".to_owned();
        let text = format!("{comment}\nv 1");
        assert_eq!(
            lines_of(text.as_bytes()),
            [(1, comment), (2, "v 1".to_owned())]
        );
    }

    #[test]
    fn other_formats_are_recognised_after_empty_lines() {
        for bytes in [
            &b"\r\n\n <html>"[..],
            b"\n<!DOCTYPE html>",
            b"\n\n\0\x01",
            b"# a\n\0",
        ] {
            let progress = Progress::default();
            let mut lines = Lines::new(bytes, &progress).expect("bytes");
            let is_recognised = matches!(lines.require_obj(), Err(Problem::Content(_)));
            assert!(is_recognised, "{}", bytes.escape_ascii());
        }
    }

    #[test]
    fn a_truncated_gzip_file_is_an_error() {
        let whole = gzipped(&b"v 0 0 0\n".repeat(1000));
        let progress = Progress::default();
        let mut lines = Lines::new(&whole[..whole.len() / 2], &progress).expect("bytes");
        let error = loop {
            match lines.next() {
                Ok(Some(_)) => {}
                Ok(None) => panic!("read to an end that isn't there"),
                Err(error) => break error,
            }
        };
        assert!(matches!(error, Problem::Read(e) if e.kind() == io::ErrorKind::UnexpectedEof));
    }
}

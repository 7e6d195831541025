//! Cuts a file into chunks of whole statements, which can be read independently.

use super::error::Problem;
use super::kind::not_an_obj;
use super::source::Source;
use super::statement::{Statement, Statements, before_backslash};
use memchr::{memchr, memchr_iter, memrchr2};
use std::io::Read;
use std::ops::ControlFlow;

use crate::progress::Progress;

/// Bytes read at a time. A chunk ends with the last whole statement in them, and so has up to twice as many.
pub(super) const CHUNK_SIZE: usize = 1 << 18;
/// Longest statement that is read; a polygon of ten million corners would fit.
const LONGEST_STATEMENT: usize = 128 << 20;
/// Bytes needed to recognise other file formats.
const ENOUGH_TO_TELL: usize = 1 << 10;

/// Whole statements of a file.
pub(super) struct Chunk {
    pub bytes: Vec<u8>,
    /// The number of its first line, counted from 1.
    pub first_line: usize,
}

/// Cuts a file into chunks.
pub(super) struct Chunks<'p> {
    source: Source<'p>,
    buffer: Vec<u8>,
    /// No statement ends before this offset in the buffer.
    searched: usize,
    is_at_end: bool,
    next_line: usize,
    chunk_size: usize,
    longest: usize,
    /// Buffers of finished chunks, for reuse.
    spare: Vec<Vec<u8>>,
}

impl<'p> Chunks<'p> {
    /// # Errors
    /// The file can't be read.
    pub(super) fn new(
        bytes: impl Read + 'p,
        chunk_size: usize,
        progress: &'p Progress,
    ) -> Result<Self, Problem> {
        Ok(Self {
            source: Source::new(bytes, progress)?,
            buffer: Vec::new(),
            searched: 0,
            is_at_end: false,
            next_line: 1,
            chunk_size,
            longest: LONGEST_STATEMENT,
            spare: Vec::new(),
        })
    }

    /// Limits statements to a quarter of the allowed memory, as the buffer doubles when it grows.
    pub(super) fn limit_statements(&mut self, max_memory: u64) {
        let most = usize::try_from(max_memory / 4).unwrap_or(LONGEST_STATEMENT);
        self.longest = most.clamp(CHUNK_SIZE, LONGEST_STATEMENT);
    }

    /// Checks the first bytes, before the first chunk is taken.
    ///
    /// # Errors
    /// The file is recognised as another format.
    pub(super) fn require_obj(&mut self) -> Result<(), Problem> {
        // A source may return a few bytes at a time.
        while self.buffer.len() < ENOUGH_TO_TELL && !self.is_at_end {
            self.read_more()?;
        }
        not_an_obj(&self.buffer).map_or(Ok(()), |what| Err(Problem::Content(what)))
    }

    /// The next chunk, or `None` at the end.
    ///
    /// # Errors
    /// The file can't be read, a statement is too long, or the load was cancelled.
    pub(super) fn next(&mut self) -> Result<Option<Chunk>, Problem> {
        while !self.is_at_end {
            if self.buffer.len() >= self.chunk_size {
                if let Some(end) = self.last_end() {
                    return Ok(Some(self.take(end)));
                }
                if self.buffer.len() > self.longest {
                    let longest = match self.longest >> 20 {
                        0 => format!("{} kB", self.longest >> 10),
                        megabytes => format!("{megabytes} MB"),
                    };
                    let message = format!("the statement is longer than {longest}");
                    return Err(Problem::line(self.next_line, message));
                }
            }
            self.read_more()?;
        }
        let rest = self.buffer.len();
        Ok((rest > 0).then(|| self.take(rest)))
    }

    /// Whether bytes other than zeros follow the gzip data.
    pub(super) fn has_garbage(&self) -> bool {
        self.source.has_garbage()
    }

    fn read_more(&mut self) -> Result<(), Problem> {
        // To a fixed size, as a source may return few bytes at a time: chunks have the same bounds for any source.
        let (mut filled, size) = (self.buffer.len(), self.buffer.len() + self.chunk_size);
        self.buffer.resize(size, 0);
        while filled < size && !self.is_at_end {
            let count = self.source.read(&mut self.buffer[filled..])?;
            self.is_at_end = count == 0;
            filled += count;
        }
        self.buffer.truncate(filled);
        Ok(())
    }

    /// The offset after the last statement that ends in the buffer.
    fn last_end(&mut self) -> Option<usize> {
        let bytes = &self.buffer[..];
        // A CR at the end may be half of a CRLF.
        let mut end = bytes.len() - usize::from(bytes.ends_with(b"\r"));
        let searched = std::mem::replace(&mut self.searched, end);
        while let Some(at) = memrchr2(b'\n', b'\r', &bytes[searched.min(end)..end]) {
            let at = searched + at;
            let is_pair = bytes[at] == b'\n' && bytes[..at].ends_with(b"\r");
            let line_end = at - usize::from(is_pair);
            let start = memrchr2(b'\n', b'\r', &bytes[..line_end]).map_or(0, |before| before + 1);
            if before_backslash(&bytes[start..line_end]).is_none() {
                return Some(at + 1);
            }
            end = line_end;
        }
        None
    }

    /// Takes back a chunk that is no longer needed, to reuse its buffer.
    pub(super) fn recycle(&mut self, chunk: Chunk) {
        if chunk.bytes.capacity() <= 4 * self.chunk_size {
            self.spare.push(chunk.bytes);
        }
    }

    fn take(&mut self, end: usize) -> Chunk {
        let mut rest = self.spare.pop().unwrap_or_default();
        rest.clear();
        rest.extend(&self.buffer[end..]);
        self.buffer.truncate(end);
        let bytes = std::mem::replace(&mut self.buffer, rest);
        self.searched = 0;
        let first_line = self.next_line;
        self.next_line += count_lines(&bytes);
        Chunk { bytes, first_line }
    }
}

/// Number of line ends: LF, CR or CRLF.
fn count_lines(bytes: &[u8]) -> usize {
    let lf = memchr_iter(b'\n', bytes).count();
    if memchr(b'\r', bytes).is_none() {
        return lf;
    }
    let is_alone = |&at: &usize| bytes.get(at + 1) != Some(&b'\n');
    lf + memchr_iter(b'\r', bytes).filter(is_alone).count()
}

/// Passes each statement of a file to `take`, until it breaks or fails.
///
/// # Errors
/// The file can't be read, or `take` fails.
pub(super) fn each_statement(
    bytes: impl Read,
    progress: &Progress,
    mut take: impl FnMut(Statement<'_>) -> Result<ControlFlow<()>, Problem>,
) -> Result<(), Problem> {
    let mut chunks = Chunks::new(bytes, CHUNK_SIZE, progress)?;
    while let Some(chunk) = chunks.next()? {
        let mut statements = Statements::of(&chunk);
        while let Some(statement) = statements.next() {
            if take(statement)?.is_break() {
                return Ok(());
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;

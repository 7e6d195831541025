//! Reader of an OBJ or MTL file: decompresses gzip, converts UTF-16 to UTF-8 and removes the byte order mark.

use super::error::Problem;
use super::gzip::{GzipMembers, MAGIC};
use crate::progress::Progress;
use encoding_rs_io::DecodeReaderBytesBuilder;
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::rc::Rc;

/// The buffer size for file reads and for decompressed data, in bytes.
const BUFFER_SIZE: usize = 1 << 18;

/// Reads the decoded bytes of a file.
pub(super) struct Source<'p> {
    bytes: Box<dyn Read + 'p>,
    progress: &'p Progress,
    /// Set by [`GzipMembers`] if non-zero bytes follow the gzip data.
    has_garbage: Rc<Cell<bool>>,
}

impl<'p> Source<'p> {
    /// # Errors
    /// The file can't be read, or the load was cancelled.
    pub(super) fn new(bytes: impl Read + 'p, progress: &'p Progress) -> Result<Self, Problem> {
        let counted = CountingReader { bytes, progress };
        progress.check()?;
        let source = BufReader::with_capacity(BUFFER_SIZE, counted);
        let (start, source) = peeked(source, progress)?;
        let has_garbage = Rc::default();
        let source: Box<dyn BufRead + 'p> = if start.starts_with(&MAGIC) {
            let members = GzipMembers::new(source, Rc::clone(&has_garbage));
            Box::new(BufReader::with_capacity(BUFFER_SIZE, members))
        } else {
            Box::new(source)
        };
        let (start, source) = peeked(source, progress)?;
        let may_have_bom = start.first().is_some_and(|&b| b >= 0x80);
        let bytes: Box<dyn Read + 'p> = if may_have_bom {
            let mut decoder = DecodeReaderBytesBuilder::new();
            decoder.bom_sniffing(true).utf8_passthru(true);
            Box::new(decoder.strip_bom(true).build(source))
        } else {
            Box::new(source)
        };
        Ok(Self {
            bytes,
            progress,
            has_garbage,
        })
    }

    /// Reads bytes into `out` and returns their number; 0 at the end.
    ///
    /// # Errors
    /// The file can't be read, or the load was cancelled.
    pub(super) fn read(&mut self, out: &mut [u8]) -> Result<usize, Problem> {
        loop {
            self.progress.check()?;
            match self.bytes.read(out) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.progress.check()?;
                    return Err(Problem::Read(error));
                }
                Ok(count) => return Ok(count),
            }
        }
    }

    /// Reads all bytes.
    ///
    /// # Errors
    /// The file can't be read, or the load was cancelled.
    pub(super) fn read_to_end(mut self) -> Result<Vec<u8>, Problem> {
        let mut all = Vec::new();
        let read = self.bytes.read_to_end(&mut all);
        self.progress.check()?;
        read.map_err(Problem::Read)?;
        Ok(all)
    }

    /// Whether non-zero bytes follow the gzip data.
    pub(super) fn has_garbage(&self) -> bool {
        self.has_garbage.get()
    }
}

/// The first three bytes of a source, enough for a byte order mark or gzip's magic number, and the source with them. The
/// first read of a pipe may return fewer.
fn peeked<R: BufRead>(
    mut source: R,
    progress: &Progress,
) -> Result<(Vec<u8>, impl BufRead + use<R>), Problem> {
    let mut start = Vec::new();
    let read = source.by_ref().take(3).read_to_end(&mut start);
    progress.check()?;
    read.map_err(Problem::Read)?;
    Ok((start.clone(), Cursor::new(start).chain(source)))
}

/// Counts the bytes read as progress. Returns an error after cancellation.
struct CountingReader<'p, R> {
    bytes: R,
    progress: &'p Progress,
}

impl<R: Read> Read for CountingReader<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        // Check here too: a long run of compressed bytes may produce no output.
        self.progress.check().map_err(io::Error::other)?;
        let count = self.bytes.read(out)?;
        self.progress.add_read(count as u64);
        Ok(count)
    }
}

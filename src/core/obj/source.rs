//! The bytes of an OBJ or MTL file: gzip decompressed, UTF-16 converted to UTF-8, without a byte order mark.

use super::error::Problem;
use super::gzip::{GzipMembers, MAGIC};
use crate::progress::Progress;
use encoding_rs_io::DecodeReaderBytesBuilder;
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Read};
use std::rc::Rc;

/// Bytes read from the file at a time.
const PIECE: usize = 1 << 18;

/// Decoded bytes of a file.
pub(super) struct Source<'p> {
    bytes: Box<dyn Read + 'p>,
    progress: &'p Progress,
    has_garbage: Rc<Cell<bool>>,
}

impl<'p> Source<'p> {
    /// # Errors
    /// The file can't be read, or the load was cancelled.
    pub(super) fn new(bytes: impl Read + 'p, progress: &'p Progress) -> Result<Self, Problem> {
        let counted = CountingReader { bytes, progress };
        let mut source = BufReader::with_capacity(PIECE, counted);
        progress.check()?;
        let is_gzip = source
            .fill_buf()
            .map_err(Problem::Read)?
            .starts_with(&MAGIC);
        let has_garbage = Rc::default();
        let mut source: Box<dyn BufRead + 'p> = if is_gzip {
            let members = GzipMembers::new(source, Rc::clone(&has_garbage));
            Box::new(BufReader::with_capacity(PIECE, members))
        } else {
            Box::new(source)
        };
        // The first read may return less than a whole byte order mark.
        let start = source.fill_buf().map_err(Problem::Read)?;
        let may_be_marked = start.len() < 3 || start[0] >= 0x80;
        let bytes: Box<dyn Read + 'p> = if may_be_marked {
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

    /// Reads some bytes; returns 0 at the end.
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

    /// Whether bytes other than zeros follow the gzip data.
    pub(super) fn has_garbage(&self) -> bool {
        self.has_garbage.get()
    }
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

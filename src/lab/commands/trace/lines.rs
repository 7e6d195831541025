//! Reads numbered lines of bounded length from a file or a pipe, as soon as they arrive.

use std::io::{self, Read};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Maximum bytes of a line; eight numbers of several hundred digits fit many times.
pub(super) const LONGEST_LINE: usize = 1 << 16;

/// Bytes per read: the capacity of a pipe.
const PIECE: usize = 1 << 16;
/// Maximum number of pieces that are read ahead while rays are traced.
const WAITING_PIECES: usize = 64;

/// Complete lines.
#[derive(Default)]
pub(super) struct Lines {
    bytes: Vec<u8>,
    spans: Vec<Span>,
}

#[derive(Clone, Copy)]
struct Span {
    number: u64,
    start: usize,
    end: usize,
    is_cut: bool,
}

/// A line without its line ending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line<'l> {
    /// Counted from 1.
    pub number: u64,
    pub bytes: &'l [u8],
    /// Whether the line is longer than [`LONGEST_LINE`] and these are its first bytes.
    pub is_cut: bool,
}

impl Lines {
    pub(super) fn len(&self) -> usize {
        self.spans.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    pub(super) fn get(&self, index: usize) -> Line<'_> {
        let span = self.spans[index];
        Line {
            number: span.number,
            bytes: &self.bytes[span.start..span.end],
            is_cut: span.is_cut,
        }
    }
}

/// Splits text that arrives in pieces into lines, which end in LF, CR or CRLF.
#[derive(Default)]
pub(super) struct LineSplitter {
    lines: Lines,
    /// Start of the unfinished line in the bytes.
    start: usize,
    /// Number of lines so far, complete or cut.
    count: u64,
    /// The rest of the line is skipped: its beginning was handed over.
    is_skipping: bool,
    /// The last byte was a CR; an LF that follows belongs to it.
    is_after_cr: bool,
}

impl LineSplitter {
    pub(super) fn push(&mut self, mut piece: &[u8]) {
        if self.is_after_cr && !piece.is_empty() {
            piece = piece.strip_prefix(b"\n").unwrap_or(piece);
            self.is_after_cr = false;
        }
        while let Some(at) = piece.iter().position(|&b| b == b'\n' || b == b'\r') {
            self.extend(&piece[..at]);
            self.end_line();
            let rest = &piece[at + 1..];
            self.is_after_cr = piece[at] == b'\r' && rest.is_empty();
            let is_pair = piece[at] == b'\r' && rest.first() == Some(&b'\n');
            piece = if is_pair { &rest[1..] } else { rest };
        }
        self.extend(piece);
    }

    /// Ends the text and, if it is unfinished, the last line.
    pub(super) fn finish(&mut self) {
        if self.is_skipping || self.start < self.lines.bytes.len() {
            self.end_line();
        }
    }

    /// The number of complete lines.
    pub(super) fn len(&self) -> usize {
        self.lines.len()
    }

    /// Takes the complete lines.
    pub(super) fn take(&mut self) -> Lines {
        let unfinished = self.lines.bytes[self.start..].to_vec();
        self.start = 0;
        let next = Lines {
            bytes: unfinished,
            spans: Vec::new(),
        };
        std::mem::replace(&mut self.lines, next)
    }

    fn extend(&mut self, part: &[u8]) {
        if self.is_skipping {
            return;
        }
        let room = LONGEST_LINE - (self.lines.bytes.len() - self.start);
        self.lines.bytes.extend(&part[..part.len().min(room)]);
        if part.len() > room {
            // Handed over at once: the end may never arrive.
            self.hand_over(true);
            self.is_skipping = true;
        }
    }

    fn end_line(&mut self) {
        if !self.is_skipping {
            self.hand_over(false);
        }
        self.is_skipping = false;
    }

    fn hand_over(&mut self, is_cut: bool) {
        self.count += 1;
        let end = self.lines.bytes.len();
        self.lines.spans.push(Span {
            number: self.count,
            start: self.start,
            end,
            is_cut,
        });
        self.start = end;
    }
}

/// An input behind a lock, so that it survives a failed attempt to start a thread with it.
type Input = Arc<Mutex<Box<dyn Read + Send>>>;

/// The pieces of an input, read ahead by a thread if the system grants one.
pub(super) enum Pieces {
    ReadAhead(Receiver<io::Result<Vec<u8>>>),
    Direct(Input),
}

/// The next piece, if it is known without waiting.
pub(super) enum Next {
    Piece(Vec<u8>),
    End,
    /// Reading might block.
    Unknown,
}

impl Pieces {
    pub(super) fn of(input: Box<dyn Read + Send>) -> Self {
        let input = Arc::new(Mutex::new(input));
        let (sender, receiver) = sync_channel(WAITING_PIECES);
        let shared = Arc::clone(&input);
        let read_ahead = move || {
            loop {
                let piece = read_piece(&shared);
                let is_last = !matches!(&piece, Ok(piece) if !piece.is_empty());
                // Sending fails when the command has ended.
                if sender.send(piece).is_err() || is_last {
                    return;
                }
            }
        };
        // The thread isn't joined: it may wait for input forever.
        let thread = thread::Builder::new().name("read rays".to_owned());
        match thread.spawn(read_ahead) {
            Ok(_) => Self::ReadAhead(receiver),
            Err(_) => Self::Direct(input),
        }
    }

    /// # Errors
    /// The error of the read.
    pub(super) fn next_without_waiting(&mut self) -> io::Result<Next> {
        match self {
            Self::ReadAhead(pieces) => match pieces.try_recv() {
                Ok(piece) => Ok(next_of(piece?)),
                Err(TryRecvError::Empty) => Ok(Next::Unknown),
                Err(TryRecvError::Disconnected) => Ok(Next::End),
            },
            Self::Direct(_) => Ok(Next::Unknown),
        }
    }

    /// The next piece, after waiting for it.
    ///
    /// # Errors
    /// The error of the read.
    pub(super) fn wait(&mut self) -> io::Result<Next> {
        match self {
            // A thread that ends without a last piece has panicked; treat it as the end.
            Self::ReadAhead(pieces) => pieces
                .recv()
                .map_or(Ok(Next::End), |piece| Ok(next_of(piece?))),
            Self::Direct(input) => Ok(next_of(read_piece(input)?)),
        }
    }
}

/// Reads a piece; empty at the end of the input.
fn read_piece(input: &Input) -> io::Result<Vec<u8>> {
    let mut input = input.lock().unwrap_or_else(PoisonError::into_inner);
    let mut piece = vec![0; PIECE];
    let count = loop {
        match input.read(&mut piece) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            other => break other?,
        }
    };
    piece.truncate(count);
    Ok(piece)
}

fn next_of(piece: Vec<u8>) -> Next {
    if piece.is_empty() {
        Next::End
    } else {
        Next::Piece(piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(text: &[u8], piece: usize) -> Vec<(u64, String, bool)> {
        let mut splitter = LineSplitter::default();
        let mut found = Vec::new();
        let mut take = |splitter: &mut LineSplitter| {
            let lines = splitter.take();
            for line in (0..lines.len()).map(|k| lines.get(k)) {
                let text = String::from_utf8_lossy(line.bytes).into_owned();
                found.push((line.number, text, line.is_cut));
            }
        };
        for piece in text.chunks(piece) {
            splitter.push(piece);
            take(&mut splitter);
        }
        splitter.finish();
        take(&mut splitter);
        found
    }

    #[test]
    fn lines_end_in_lf_cr_or_crlf_however_the_text_is_split_into_pieces() {
        let expected = [(1, "a"), (2, ""), (3, "bc"), (4, "d")];
        let expected = expected.map(|(number, text)| (number, text.to_owned(), false));
        for end in ["\n", "\r", "\r\n"] {
            for last in ["", end] {
                let text = ["a", "", "bc", "d"].join(end) + last;
                for piece in 1..text.len() {
                    assert_eq!(split(text.as_bytes(), piece), expected, "{text:?} {piece}");
                }
            }
        }
        assert_eq!(split(b"", 1), []);
    }

    #[test]
    fn the_beginning_of_an_overlong_line_is_available_before_its_end() {
        let mut splitter = LineSplitter::default();
        for _ in 0..3 {
            splitter.push(&[b'7'; LONGEST_LINE / 2 + 1]);
        }
        let lines = splitter.take();
        assert_eq!((lines.len(), lines.get(0).is_cut), (1, true));
        assert_eq!(lines.get(0).bytes.len(), LONGEST_LINE);
        splitter.push(b"7\nnext");
        splitter.finish();
        let lines = splitter.take();
        let expected = Line {
            number: 2,
            bytes: b"next",
            is_cut: false,
        };
        assert_eq!((lines.len(), lines.get(0)), (1, expected));
        // The longest line that isn't cut.
        let whole = split(&[b'7'; LONGEST_LINE], 1000);
        assert_eq!(whole, [(1, "7".repeat(LONGEST_LINE), false)]);
    }
}

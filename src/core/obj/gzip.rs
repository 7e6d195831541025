//! Gzip decompressor. Like gzip(1), it reads consecutive members and ignores zeros after the last one.
//!
//! Source: RFC 1952, 2.2: a file is a series of members. Tapes and some servers pad files with zeros.

use flate2::bufread::GzDecoder;
use std::cell::Cell;
use std::io::{self, BufRead, Read};
use std::rc::Rc;

/// The first bytes of every gzip member.
pub(super) const MAGIC: [u8; 2] = [0x1F, 0x8B];

/// Reads the decompressed bytes of all members.
pub(super) struct GzipMembers<R> {
    /// The current member, or `None` after the last one.
    member: Option<GzDecoder<R>>,
    has_garbage: Rc<Cell<bool>>,
}

impl<R: BufRead> GzipMembers<R> {
    /// Sets `has_garbage` if non-zero bytes follow the last member. Doesn't read them.
    pub(super) fn new(source: R, has_garbage: Rc<Cell<bool>>) -> Self {
        Self {
            member: Some(GzDecoder::new(source)),
            has_garbage,
        }
    }
}

impl<R: BufRead> Read for GzipMembers<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        while let Some(member) = &mut self.member {
            let count = member.read(out)?;
            if count > 0 || out.is_empty() {
                return Ok(count);
            }
            let Some(ended) = self.member.take() else {
                break;
            };
            let mut source = ended.into_inner();
            match next(&mut source)? {
                Next::Member => self.member = Some(GzDecoder::new(source)),
                Next::Garbage => self.has_garbage.set(true),
                Next::End => {}
            }
        }
        Ok(0)
    }
}

/// The data after a member.
enum Next {
    Member,
    /// Non-zero bytes, possibly after zeros.
    Garbage,
    End,
}

/// Determines the data after a member; skips zeros.
fn next(source: &mut impl BufRead) -> io::Result<Next> {
    if source.fill_buf()?.first() == Some(&MAGIC[0]) {
        return Ok(Next::Member);
    }
    loop {
        let bytes = source.fill_buf()?;
        if bytes.is_empty() {
            return Ok(Next::End);
        }
        if bytes.iter().any(|&b| b != 0) {
            return Ok(Next::Garbage);
        }
        let count = bytes.len();
        source.consume(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufReader, Write};

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).expect("memory");
        encoder.finish().expect("memory")
    }

    /// The decompressed text, and whether garbage follows it.
    fn unpacked(bytes: &[u8]) -> io::Result<(String, bool)> {
        // A small odd size, so that members end at any position in the buffer.
        let source = BufReader::with_capacity(7, bytes);
        let has_garbage = Rc::default();
        let mut text = String::new();
        GzipMembers::new(source, Rc::clone(&has_garbage)).read_to_string(&mut text)?;
        Ok((text, has_garbage.get()))
    }

    #[test]
    fn several_members_and_trailing_zeros_are_read() {
        let [a, b, empty] = [&b"v 1\n"[..], b"v 2\n", b""].map(packed);
        for (parts, text, has_garbage) in [
            (vec![&a[..]], "v 1\n", false),
            (vec![&a, &empty, &b], "v 1\nv 2\n", false),
            (vec![&a, &b, &[0; 1000]], "v 1\nv 2\n", false),
            (vec![&a, b"garbage"], "v 1\n", true),
            (vec![&a, &[0; 100], &b], "v 1\n", true),
        ] {
            let found = unpacked(&parts.concat()).expect("good");
            assert_eq!(found, (text.to_owned(), has_garbage));
        }
    }

    #[test]
    fn a_truncated_second_member_is_an_error() {
        let [a, b] = [&b"v 1\n"[..], b"v 2\n"].map(packed);
        for length in [1, 5, b.len() - 1] {
            let bytes = [&a, &b[..length]].concat();
            let error = unpacked(&bytes).expect_err("half a member");
            assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
        }
    }
}

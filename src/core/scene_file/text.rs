//! A scene file's bytes as text, and the lines of offsets in it.

use std::borrow::Cow;

/// Why bytes aren't a text, and the line.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct NotText {
    pub line: u32,
    pub message: &'static str,
}

/// The text in a file's bytes: UTF-8, or UTF-16 with a byte order mark.
///
/// # Errors
/// The bytes are in another encoding.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, NotText> {
    match bytes {
        [0xFF, 0xFE, rest @ ..] => utf_16(rest, u16::from_le_bytes).map(Cow::Owned),
        [0xFE, 0xFF, rest @ ..] => utf_16(rest, u16::from_be_bytes).map(Cow::Owned),
        _ => {
            let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            let text = std::str::from_utf8(bytes).map_err(|error| NotText {
                line: 1 + line_feeds(&bytes[..error.valid_up_to()]),
                message: "the text isn't valid UTF-8",
            });
            text.map(Cow::Borrowed)
        }
    }
}

/// The memory that decoding takes, besides the bytes themselves.
pub(super) fn decoded_bytes(bytes: &[u8]) -> u64 {
    match bytes {
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => (UTF_8_PER_UTF_16 * (bytes.len() / 2)) as u64,
        _ => 0,
    }
}

/// Bytes of UTF-8 per unit of UTF-16, at most.
const UTF_8_PER_UTF_16: usize = 3;

fn utf_16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, NotText> {
    let (pairs, rest) = bytes.as_chunks();
    let units = pairs.iter().map(|pair| unit(*pair));
    let mut text = String::with_capacity(UTF_8_PER_UTF_16 * pairs.len());
    for decoded in char::decode_utf16(units) {
        let Ok(decoded) = decoded else { break };
        text.push(decoded);
    }
    let unit_count: usize = text.chars().map(char::len_utf16).sum();
    if unit_count < pairs.len() || !rest.is_empty() {
        return Err(NotText {
            line: 1 + line_feeds(text.as_bytes()),
            message: "the text isn't valid UTF-16",
        });
    }
    Ok(text)
}

fn line_feeds(bytes: &[u8]) -> u32 {
    memchr::memchr_iter(b'\n', bytes).count() as u32
}

/// The offsets of a text's line feeds.
pub(super) struct Lines(Vec<u32>);

impl Lines {
    /// The lines of a text of less than 4 GB.
    pub(super) fn of(text: &str) -> Self {
        let mut ends = Vec::with_capacity(line_feeds(text.as_bytes()) as usize);
        ends.extend(memchr::memchr_iter(b'\n', text.as_bytes()).map(|end| end as u32));
        Self(ends)
    }

    /// The memory that the list of a text takes.
    pub(super) fn bytes(text: &str) -> u64 {
        u64::from(line_feeds(text.as_bytes())) * size_of::<u32>() as u64
    }

    /// The line of an offset, counted from 1.
    pub(super) fn line(&self, offset: usize) -> u32 {
        1 + self.0.partition_point(|&end| (end as usize) < offset) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf_8_and_utf_16_are_read_with_byte_order_marks() {
        let text = "<é>\u{1F600}\n";
        let with_mark = format!("\u{FEFF}{text}");
        let little: Vec<u8> = with_mark
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        let big: Vec<u8> = with_mark
            .encode_utf16()
            .flat_map(u16::to_be_bytes)
            .collect();
        for bytes in [text.as_bytes(), with_mark.as_bytes(), &little, &big] {
            assert_eq!(decoded(bytes).as_deref(), Ok(text));
        }
        for bytes in [&little[..little.len() - 1], &little[..10]] {
            let error = decoded(bytes).expect_err("half a character");
            assert_eq!(error.message, "the text isn't valid UTF-16");
        }
        let error = decoded(b"a\nb\xE9").expect_err("Latin-1");
        assert_eq!(
            (error.line, error.message),
            (2, "the text isn't valid UTF-8")
        );
    }

    #[test]
    fn lines_are_counted_from_1() {
        let lines = Lines::of("a\nb\n\nc");
        let found = [0, 1, 2, 4, 5].map(|offset| lines.line(offset));
        assert_eq!(found, [1, 1, 2, 3, 4]);
    }
}

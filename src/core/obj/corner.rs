//! Parses the corners of faces, lines and points.

use super::tally::shortened;

/// The lists that a corner's indices refer to, in the order of a corner's notation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    Vertex,
    Texture,
    Normal,
}

impl List {
    pub(super) const ALL: [Self; 3] = [Self::Vertex, Self::Texture, Self::Normal];

    pub(super) fn name(self) -> &'static str {
        ["vertex", "texture", "normal"][self as usize]
    }

    /// The message for an index that refers to no entry.
    pub(super) fn out_of_range(self, written: i64, count: usize) -> String {
        let what = self.name();
        match written {
            0 => format!("{what} index 0; indices start at 1"),
            // Reported before the file's entries have been counted.
            _ if written > i64::from(u32::MAX) => format!("{what} index {written} is out of range"),
            _ => {
                let are = if count == 1 { "is" } else { "are" };
                format!("{what} index {written} is out of range: there {are} {count}")
            }
        }
    }
}

/// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn` as written: indices from 1 or, if negative, from the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub indices: [Option<i64>; 3],
    /// Offset of the corner in the line.
    pub offset: usize,
}

/// A word that isn't a corner: its offset and what is wrong with it.
#[derive(Debug, PartialEq)]
pub(super) struct Malformed {
    pub offset: usize,
    pub message: String,
}

/// Iterates over the corners in a line; ends after a malformed one.
pub(super) struct Corners<'l> {
    line: &'l [u8],
    at: usize,
}

impl<'l> Corners<'l> {
    /// The corners from an offset on.
    pub(super) fn of(line: &'l [u8], at: usize) -> Self {
        Self { line, at }
    }
}

impl Iterator for Corners<'_> {
    type Item = Result<Corner, Malformed>;

    fn next(&mut self) -> Option<Self::Item> {
        while is_blank(*self.line.get(self.at)?) {
            self.at += 1;
        }
        let offset = self.at;
        let mut corner = Corner {
            indices: [None; 3],
            offset,
        };
        for (list, place) in corner.indices.iter_mut().enumerate() {
            let start = self.at;
            *place = self.index();
            let next = self.line.get(self.at).copied();
            let is_left_out = self.at == start && list > 0;
            match next {
                None if place.is_some() || is_left_out => return Some(Ok(corner)),
                Some(b) if is_blank(b) && (place.is_some() || is_left_out) => {
                    return Some(Ok(corner));
                }
                Some(b'/') if place.is_some() || is_left_out => self.at += 1,
                _ => return Some(Err(self.malformed(offset, start))),
            }
        }
        let word = self.word(offset);
        let message = format!(
            "“{}” has more parts than vertex/texture/normal",
            shortened(&word)
        );
        self.at = self.line.len();
        Some(Err(Malformed { offset, message }))
    }
}

impl Corners<'_> {
    /// The number at the current position; `None` if there is none, or it is too long for any list.
    fn index(&mut self) -> Option<i64> {
        let sign = self.line.get(self.at);
        let is_negative = sign == Some(&b'-');
        let first = self.at + usize::from(matches!(sign, Some(b'-' | b'+')));
        let (mut at, mut value) = (first, 0i64);
        while let Some(digit) = self.line.get(at).map(|b| b.wrapping_sub(b'0'))
            && digit < 10
        {
            value = value.checked_mul(10)?.checked_add(digit.into())?;
            at += 1;
        }
        if at == first {
            return None;
        }
        self.at = at;
        Some(if is_negative { -value } else { value })
    }

    /// The word at an offset.
    fn word(&self, offset: usize) -> String {
        let word = self.line[offset..].split(|&b| is_blank(b)).next();
        String::from_utf8_lossy(word.unwrap_or_default()).into_owned()
    }

    fn malformed(&mut self, offset: usize, part: usize) -> Malformed {
        self.at = self.line.len();
        let (word, part) = (self.word(offset), self.word(part));
        let part = part.split('/').next().unwrap_or_default();
        let within = if part == word {
            String::new()
        } else {
            format!(" in “{}”", shortened(&word))
        };
        let is_number = part.bytes().all(|b| b.is_ascii_digit());
        let message = match part {
            "" if within.is_empty() => "an index is missing".to_owned(),
            "" => format!("an index is missing{within}"),
            _ if is_number => format!("index “{}”{within} is too large", shortened(part)),
            _ => format!("“{}”{within} is not an index", shortened(part)),
        };
        Malformed { offset, message }
    }
}

/// Whether a byte separates words.
pub(super) const fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | 0x0B | 0x0C)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(line: &str) -> Vec<Result<[Option<i64>; 3], String>> {
        Corners::of(line.as_bytes(), 0)
            .map(|corner| corner.map(|c| c.indices).map_err(|bad| bad.message))
            .collect()
    }

    #[test]
    fn every_notation_of_a_corner_is_read() {
        let read = corners(" 1\t+2/3 4//-5 6/7/8 9/ 1// ");
        let expected = [
            [Some(1), None, None],
            [Some(2), Some(3), None],
            [Some(4), None, Some(-5)],
            [Some(6), Some(7), Some(8)],
            [Some(9), None, None],
            [Some(1), None, None],
        ];
        assert_eq!(read, expected.map(Ok));
    }

    #[test]
    fn a_malformed_corner_is_reported() {
        for (line, message) in [
            (
                "1/1/1/1 2",
                "“1/1/1/1” has more parts than vertex/texture/normal",
            ),
            ("1.0", "“1.0” is not an index"),
            ("1/x/2", "“x” in “1/x/2” is not an index"),
            ("/1", "an index is missing in “/1”"),
            ("-", "“-” is not an index"),
            (
                "99999999999999999999",
                "index “99999999999999999999” is too large",
            ),
            ("é", "“é” is not an index"),
        ] {
            assert_eq!(corners(line), [Err(message.to_owned())], "{line}");
        }
    }
}

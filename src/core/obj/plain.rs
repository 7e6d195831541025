//! Fast paths for plain statements, which make up most lines of large files.
//!
//! Plain statements are vertices, texture coordinates and normals without extra numbers, and faces with positive indices,
//! on one line without a comment. They are parsed straight from the chunk, without first searching for the end of the
//! line. [`reader`](super::reader) parses all other statements and reports errors.

use super::chunk_contents::ChunkContents;
use super::corner::{List, is_blank};
use super::elements::{ElementKind, Elements};
use super::reader::WORDS_PER_CHECK;
use super::words::{EXACT_DIGITS, is_long_number};
use crate::mesh::NO_INDEX;
use glam::{DVec3, Vec2};

/// Parses the statement at the start of `text` if it is plain, and returns its length, including the line end. Otherwise
/// adds nothing. Longer faces than the reader parses without checking for cancellation aren't plain.
#[inline]
pub(super) fn read(part: &mut ChunkContents, text: &[u8], line: usize) -> Option<usize> {
    let rest = match text {
        [b'v', b' ', rest @ ..] => {
            let mut cursor = Cursor { rest };
            let [x, y, z] = cursor.numbers(|word| part.has_long_numbers |= is_long_number(word))?;
            let rest = cursor.end_line()?;
            part.positions.push(DVec3::new(x, y, z));
            rest
        }
        [b'v', b't', b' ', rest @ ..] => {
            let mut cursor = Cursor { rest };
            let [u, v] = cursor.numbers(|_| ())?;
            let rest = cursor.end_line().or_else(|| {
                let [_w] = cursor.numbers(|_| ())?;
                cursor.end_line()
            })?;
            part.textures.push(Vec2::new(u as f32, v as f32));
            rest
        }
        [b'v', b'n', b' ', rest @ ..] => {
            let mut cursor = Cursor { rest };
            let [x, y, z] = cursor.numbers(|_| ())?;
            let rest = cursor.end_line()?;
            part.normals.push(DVec3::new(x, y, z).as_vec3());
            rest
        }
        [b'f', b' ', rest @ ..] => face(&mut part.elements, rest, line)?,
        _ => return None,
    };
    Some(text.len() - rest.len())
}

/// Parses a face, and returns the text after its line.
fn face<'t>(elements: &mut Elements, text: &'t [u8], line: usize) -> Option<&'t [u8]> {
    let (first, highest) = (elements.corners[0].len(), elements.highest);
    let [_, textures, normals] = &elements.corners;
    let has_vertices_only = textures.is_empty() && normals.is_empty();
    let rest = has_vertices_only
        .then(|| vertices(elements, text))
        .flatten();
    let rest = rest.or_else(|| {
        elements.corners[0].truncate(first);
        corners(elements, text)
    });
    let count = elements.corners[0].len() - first;
    if rest.is_none() || count < 3 {
        elements.truncate(first);
        elements.highest = highest;
        return None;
    }
    elements.end(ElementKind::Face, first, line);
    rest
}

/// Parses corners without texture coordinates and normals, and returns the text after the line.
///
/// Not inlined, like [`corners`]: inside a larger function, the compiler keeps the loop's variables on the stack.
#[inline(never)]
fn vertices<'t>(elements: &mut Elements, text: &'t [u8]) -> Option<&'t [u8]> {
    let mut cursor = Cursor { rest: text };
    let vertices = &mut elements.corners[0];
    let (end, mut highest) = (vertices.len() + WORDS_PER_CHECK, 0);
    while vertices.len() < end
        && let Some(vertex) = cursor.index()
    {
        vertices.push(vertex);
        highest = highest.max(vertex as usize + 1);
    }
    let of_all = &mut elements.highest[List::Vertex as usize];
    *of_all = highest.max(*of_all);
    cursor.end_line()
}

/// Parses corners of the form `v`, `v/vt`, `v//vn` or `v/vt/vn`, and returns the text after the line.
#[inline(never)]
fn corners<'t>(elements: &mut Elements, text: &'t [u8]) -> Option<&'t [u8]> {
    let mut cursor = Cursor { rest: text };
    let end = elements.corners[0].len() + WORDS_PER_CHECK;
    while elements.corners[0].len() < end
        && let Some(vertex) = cursor.index()
    {
        let mut corner = [vertex, NO_INDEX, NO_INDEX];
        for index in &mut corner[1..] {
            if let [b'/', rest @ ..] = cursor.rest {
                cursor.rest = rest;
                if matches!(rest, [b'0'..=b'9', ..]) {
                    *index = cursor.index()?;
                }
            }
        }
        for list in List::ALL {
            elements.push(list, corner[list as usize]);
        }
    }
    cursor.end_line()
}

/// The rest of a text that is being parsed.
struct Cursor<'t> {
    rest: &'t [u8],
}

impl<'t> Cursor<'t> {
    #[inline]
    fn skip_blanks(&mut self) {
        while let [b, rest @ ..] = self.rest
            && is_blank(*b)
        {
            self.rest = rest;
        }
    }

    /// Skips blanks and the line end, and returns the text after them; `None` if anything else follows.
    #[inline]
    fn end_line(&mut self) -> Option<&'t [u8]> {
        self.skip_blanks();
        match self.rest {
            [b'\n', rest @ ..] | [b'\r', b'\n', rest @ ..] | [b'\r', rest @ ..] => Some(rest),
            rest => rest.is_empty().then_some(rest),
        }
    }

    /// Parses an index that counts from 1, and returns it counted from 0. Returns `None`, without moving on, if there are no
    /// digits, more than nine, or only zeros.
    #[inline]
    fn index(&mut self) -> Option<u32> {
        /// All numbers of nine digits fit in a u32.
        const MOST_DIGITS: usize = 9;
        self.skip_blanks();
        let (from_one, digits) = digits(self.rest, 0);
        if !(1..=MOST_DIGITS).contains(&digits) || from_one == 0 {
            return None;
        }
        self.rest = &self.rest[digits..];
        Some(from_one as u32 - 1)
    }

    /// Parses numbers separated by blanks. Calls `other` with each word that [`decimal`] doesn't parse.
    #[inline]
    fn numbers<const N: usize>(&mut self, mut other: impl FnMut(&[u8])) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            self.skip_blanks();
            let length;
            (*number, length) = match decimal(self.rest) {
                Some(parsed) => parsed,
                None => {
                    let parsed = fast_float2::parse_partial(self.rest).ok()?;
                    other(&self.rest[..parsed.1]);
                    parsed
                }
            };
            self.rest = &self.rest[length..];
            let is_whole = |&b: &u8| is_blank(b) || matches!(b, b'\n' | b'\r');
            if !self.rest.first().is_none_or(is_whole) {
                return None;
            }
        }
        Some(numbers)
    }
}

/// Parses the number at the start of a text, and returns it with its length. `None` if it has an exponent or more than 15
/// digits.
///
/// Integers below 10¹⁵ and powers of ten up to 10²² are exact in f64, so their quotient is correctly rounded.
/// Source: Clinger, "How to read floating point numbers accurately", PLDI 1990.
#[inline]
fn decimal(text: &[u8]) -> Option<(f64, usize)> {
    /// 18 digits, including leading zeros, fit in a u64.
    const MOST_DIGITS: usize = 18;
    const POWERS_OF_TEN: [f64; MOST_DIGITS + 1] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
        1e17, 1e18,
    ];
    const TOO_LARGE: u64 = 10u64.pow(EXACT_DIGITS);
    let (is_negative, unsigned) = match text {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, text),
    };
    let (whole, places) = digits(unsigned, 0);
    let (mantissa, decimals, length) = match &unsigned[places..] {
        [b'.', rest @ ..] => {
            let (mantissa, decimals) = digits(rest, whole);
            (mantissa, decimals, places + 1 + decimals)
        }
        _ => (whole, 0, places),
    };
    let has_exponent = matches!(unsigned[length..], [b'e' | b'E', ..]);
    if !(1..=MOST_DIGITS).contains(&(places + decimals)) || mantissa >= TOO_LARGE || has_exponent {
        return None;
    }
    let value = mantissa as f64 / POWERS_OF_TEN[decimals];
    let length = length + usize::from(is_negative);
    Some((if is_negative { -value } else { value }, length))
}

/// Appends the digits at the start of a text to a number. Returns the number, which wraps on overflow, and the count of
/// digits.
#[inline]
fn digits(text: &[u8], mut number: u64) -> (u64, usize) {
    let mut count = 0;
    for digit in text.iter().map(|b| b.wrapping_sub(b'0')) {
        if digit > 9 {
            break;
        }
        number = number.wrapping_mul(10).wrapping_add(digit.into());
        count += 1;
    }
    (number, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_rounded_as_in_rust() {
        for text in [
            "0",
            "-0",
            "1",
            "-.5",
            "1.",
            "0.1",
            "-0.000001",
            "123456789012345",
            "0.123456789012345",
            "0.00000000000000001",
            "999999999999999",
            "450359962.370497",
        ] {
            let expected: f64 = text.parse().expect("a number");
            let (number, length) = decimal(text.as_bytes()).expect(text);
            assert_eq!(
                (number.to_bits(), length),
                (expected.to_bits(), text.len()),
                "{text}"
            );
        }
        for text in [
            "",
            "-",
            ".",
            "+1",
            "1e5",
            "1.E5",
            "1000000000000000",
            "0.0000000000000000001",
            "x",
        ] {
            assert_eq!(decimal(text.as_bytes()), None, "{text}");
        }
        let mut random = crate::random::Random::new(1);
        for _ in 0..100_000 {
            let mantissa = random.bits() % 1_000_000_000_000_000;
            let text = format!("{}.{mantissa:015}", mantissa % 7);
            let text = &text[..text.len() - (mantissa % 14) as usize];
            if let Some((number, _)) = decimal(text.as_bytes()) {
                assert_eq!(text.parse(), Ok(number), "{text}");
            }
        }
    }

    /// The corner indices of a face, and the number of bytes parsed.
    fn read_face(text: &str) -> Option<([Vec<u32>; 3], usize)> {
        let mut part = ChunkContents::default();
        let length = read(&mut part, text.as_bytes(), 1);
        let elements = part.elements;
        if length.is_none() {
            assert_eq!(
                (elements.corners.concat().len(), elements.highest),
                (0, [0; 3]),
                "{text}"
            );
        }
        Some((elements.corners, length?))
    }

    #[test]
    fn faces_of_plain_indices_are_read_to_the_end_of_the_line() {
        let none = Vec::new();
        for (text, corners, length) in [
            (
                "f 1 2\t3 \nv",
                [vec![0, 1, 2], none.clone(), none.clone()],
                9,
            ),
            (
                "f 4 5 6\r\nv",
                [vec![3, 4, 5], none.clone(), none.clone()],
                9,
            ),
            (
                "f 1/4 2/5 3/\rf",
                [vec![0, 1, 2], vec![3, 4, NO_INDEX], none.clone()],
                13,
            ),
            (
                "f 1//7 2// 3//9",
                [vec![0, 1, 2], none, vec![6, NO_INDEX, 8]],
                15,
            ),
            (
                "f 9/8/7 6/5/4 3/2/1",
                [vec![8, 5, 2], vec![7, 4, 1], vec![6, 3, 0]],
                19,
            ),
        ] {
            assert_eq!(read_face(text), Some((corners, length)), "{text}");
        }
    }

    #[test]
    fn other_statements_are_left_and_add_nothing() {
        for text in [
            "f 1 2",
            "f 1 2 0",
            "f 1 2 -1",
            "f 1 2 3 # 4",
            "f 1 2 3 0",
            "f 1/2/3/4 2 3",
            "f 1 2 3\\",
            "f 1 2 3 1234567890",
            "f 1/0 2 3",
            "f 1 2 3x",
            "f /1 2 3",
            "F 1 2 3",
        ] {
            assert_eq!(read_face(text), None, "{text}");
        }
        for text in [
            "v 1 2",
            "v 1 2 3 4",
            "v 1 2 x",
            "v 1 2 3#",
            "vt 1",
            "vn 1 2",
            "v1 2 3",
            "# v",
            "",
        ] {
            let mut part = ChunkContents::default();
            assert_eq!(read(&mut part, text.as_bytes(), 1), None, "{text}");
            assert_eq!(
                part.positions.len() + part.textures.len() + part.normals.len(),
                0
            );
        }
    }
}

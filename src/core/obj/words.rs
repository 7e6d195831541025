//! Splits a line into words, and parses numbers.

use super::corner::is_blank;
use super::error::Problem;
use super::statement::Statement;
use super::tally::shortened;
use fast_float2::FastFloat;
use memchr::memchr_iter;

/// Iterates over the words of a line and their offsets.
#[derive(Clone)]
pub(super) struct Words<'l> {
    line: &'l [u8],
    at: usize,
}

impl<'l> Words<'l> {
    /// The words from an offset on.
    pub(super) fn of(line: &'l [u8], at: usize) -> Self {
        Self { line, at }
    }
}

impl<'l> Iterator for Words<'l> {
    type Item = (usize, &'l [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        while is_blank(*self.line.get(self.at)?) {
            self.at += 1;
        }
        let (start, rest) = (self.at, &self.line[self.at..]);
        let length = rest.iter().position(|&b| is_blank(b)).unwrap_or(rest.len());
        self.at += length;
        Some((start, &rest[..length]))
    }
}

/// Parses one of a statement's words as a number, rounded correctly.
pub(super) fn number<T: FastFloat>(
    statement: &Statement<'_>,
    (offset, word): (usize, &[u8]),
) -> Result<T, Problem> {
    let parsed = fast_float2::parse(word).ok();
    let parsed = parsed.or_else(|| fast_float2::parse(not_finite(word)?).ok());
    parsed.ok_or_else(|| {
        let message = format!("“{}” is not a number", shortened(&text(word)));
        statement.problem_at(offset, message)
    })
}

/// Converts other notations of NaN and infinity to `nan`, `inf` or `-inf`: `-nan(ind)` from C; `1.#QNAN`, `-1.#IND00`
/// and `1.#INF` from Microsoft's C runtime.
fn not_finite(word: &[u8]) -> Option<&'static [u8]> {
    let (sign, rest) = match word.split_first() {
        Some((sign @ (b'-' | b'+'), rest)) => (*sign, rest),
        _ => (b'+', word),
    };
    let rest = rest.to_ascii_lowercase();
    let is_nan = |rest: &[u8]| rest.starts_with(b"nan(") && rest.ends_with(b")");
    let microsoft = rest.strip_prefix(b"1.#").unwrap_or_default();
    let name = microsoft.trim_ascii_end();
    let name = match name.iter().position(|b| b.is_ascii_digit()) {
        Some(digits) if name[digits..].iter().all(u8::is_ascii_digit) => &name[..digits],
        _ => name,
    };
    match name {
        b"qnan" | b"snan" | b"nan" | b"ind" => Some(b"nan"),
        b"inf" => Some(if sign == b'-' { b"-inf" } else { b"inf" }),
        _ => is_nan(&rest).then_some(b"nan"),
    }
}

/// Different decimals of at most 15 digits are different f64s; those of 16 digits may be the same.
pub(super) const EXACT_DIGITS: u32 = f64::DIGITS;

/// Whether a word has more than [`EXACT_DIGITS`] digits, without leading zeros and the exponent.
pub(super) fn is_long_number(word: &[u8]) -> bool {
    let mantissa = word.split(|&b| matches!(b, b'e' | b'E')).next();
    let digits = mantissa
        .unwrap_or_default()
        .iter()
        .filter(|b| b.is_ascii_digit());
    digits.skip_while(|&&b| b == b'0').count() > EXACT_DIGITS as usize
}

/// A line up to its comment. A # between a point and a letter starts no comment: Microsoft writes NaN as `-1.#IND`.
pub(super) fn without_comment(bytes: &[u8]) -> &[u8] {
    let is_comment = |&at: &usize| {
        let is_after_point = at > 0 && bytes[at - 1] == b'.';
        !is_after_point || !bytes.get(at + 1).is_some_and(u8::is_ascii_alphabetic)
    };
    let comment = memchr_iter(b'#', bytes).find(is_comment);
    comment.map_or(bytes, |at| &bytes[..at])
}

/// A name up to a # after a blank, which may start a comment; `None` if there is no such #.
pub(super) fn before_comment(name: &str) -> Option<&str> {
    let at = name.find(" #").or_else(|| name.find("\t#"))?;
    Some(name[..at].trim_end())
}

/// A name, including any `#`, as exporters write `usemtl Material #27`.
pub(super) fn name(bytes: &[u8]) -> String {
    text(bytes).trim().to_owned()
}

/// Decodes bytes as UTF-8 or, if invalid, as Latin-1.
pub(super) fn text(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statement(bytes: &[u8]) -> Statement<'_> {
        Statement {
            line: 1,
            bytes,
            is_joined: false,
        }
    }

    #[test]
    fn words_are_separated_by_blanks() {
        let bytes = b"v  1\t2.5 ";
        let words: Vec<_> = Words::of(bytes, 1).collect();
        assert_eq!(words, [(3, &b"1"[..]), (5, &b"2.5"[..])]);
    }

    #[test]
    fn numbers_are_parsed_as_in_rust_and_in_other_languages_notations() {
        let read =
            |word: &str| number::<f64>(&statement(word.as_bytes()), (0, word.as_bytes())).ok();
        for word in [
            "1",
            "+1.5",
            "-.5",
            "1.",
            "1e5",
            "1E-3",
            "1e400",
            "4.9e-324",
            "0.1",
            "nan",
            "-inf",
            "9007199254740993",
            "",
            ".",
            "e5",
            "1e",
            "1e+",
            "--1",
            "1_0",
            "0x1",
            "1f",
            "é",
        ] {
            let bits = |x: f64| if x.is_nan() { None } else { Some(x.to_bits()) };
            let expected: Option<f64> = word.parse().ok();
            assert_eq!(read(word).map(bits), expected.map(bits), "{word}");
        }
        for word in ["-nan(ind)", "nan(snan)", "1.#QNAN", "-1.#IND00", "1.#SNAN"] {
            assert!(read(word).is_some_and(f64::is_nan), "{word}");
        }
        assert_eq!(read("1.#INF"), Some(f64::INFINITY));
        assert_eq!(read("-1.#INF00"), Some(f64::NEG_INFINITY));
        for word in ["1.#", "2.#INF", "nan(", "1.#INFx", "1.#IND0x"] {
            assert_eq!(read(word), None, "{word}");
        }
    }

    #[test]
    fn numbers_of_more_than_15_digits_are_detected() {
        for (word, is_long) in [
            ("1000000000000000.3", true),
            ("-123456.123456789", false),
            ("-1234567.123456789", true),
            ("0.000000000000000000125", false),
            ("0.1000000000000000", true),
            ("1.25e-000000000000000007", false),
        ] {
            assert_eq!(is_long_number(word.as_bytes()), is_long, "{word}");
        }
    }

    #[test]
    fn names_may_contain_any_bytes() {
        assert_eq!(name(b" caf\xe9 #2 "), "café #2");
        assert_eq!(name("café".as_bytes()), "café");
        assert_eq!(without_comment(b"1 2 # 3"), b"1 2 ");
        assert_eq!(without_comment(b"-1.#IND 2# 3"), b"-1.#IND 2");
        assert_eq!(without_comment(b"1.# a"), b"1.");
        assert_eq!(before_comment("wood # red"), Some("wood"));
        assert_eq!(before_comment("wood#2"), None);
    }
}

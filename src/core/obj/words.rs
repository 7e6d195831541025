//! Splits a line into words, and parses numbers.

use super::corner::is_blank;
use super::error::Problem;
use super::facts::shortened;
use super::lines::Statement;
use memchr::memchr_iter;
use std::str::FromStr;

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

/// Word count and related facts about a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WordCount {
    pub words: usize,
    /// Length of the longest word in bytes.
    pub longest: usize,
    /// Whether all bytes of the words can be parts of decimal numbers.
    pub is_plain: bool,
}

/// Counts the words from an offset on.
pub(super) fn count_words(line: &[u8], at: usize) -> WordCount {
    /// 1 for blanks, 2 for bytes that are neither blanks nor parts of numbers.
    const CLASSES: [u8; 256] = {
        let mut classes = [2; 256];
        let mut byte = 0;
        while byte < 256 {
            classes[byte] = match byte as u8 {
                b'0'..=b'9' | b'-' | b'.' | b'e' | b'E' | b'+' => 0,
                b if is_blank(b) => 1,
                _ => 2,
            };
            byte += 1;
        }
        classes
    };
    let (mut words, mut longest, mut classes, mut length) = (0, 0, 0, 0);
    for &byte in &line[at..] {
        let class = CLASSES[usize::from(byte)];
        words += usize::from(length == 0 && class != 1);
        length = if class == 1 { 0 } else { length + 1 };
        longest = longest.max(length);
        classes |= class;
    }
    WordCount {
        words,
        longest,
        is_plain: classes & 2 == 0,
    }
}

/// Parses one of a statement's words as a number.
pub(super) fn number<T: FromStr>(
    statement: &Statement<'_>,
    (offset, word): (usize, &[u8]),
) -> Result<T, Problem> {
    let parsed = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
    parsed.ok_or_else(|| {
        let message = format!("“{}” is not a number", shortened(&text(word)));
        statement.problem_at(offset, message)
    })
}

/// Whether a word has more than 15 digits, without leading zeros and the exponent.
pub(super) fn is_long_number(word: &[u8]) -> bool {
    const MOST_DIGITS: usize = 15;
    let mantissa = word.split(|&b| matches!(b, b'e' | b'E')).next();
    let digits = mantissa
        .unwrap_or_default()
        .iter()
        .filter(|b| b.is_ascii_digit());
    digits.skip_while(|&&b| b == b'0').count() > MOST_DIGITS
}

/// A line up to its comment. A # after a point starts no comment: Microsoft writes NaN as `-1.#IND`.
pub(super) fn without_comment(bytes: &[u8]) -> &[u8] {
    let is_comment = |&at: &usize| at == 0 || bytes[at - 1] != b'.';
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

    #[test]
    fn words_are_separated_by_blanks() {
        let count = |words, longest, is_plain| WordCount {
            words,
            longest,
            is_plain,
        };
        assert_eq!(count_words(b"v  1\t2.5 ", 1), count(2, 3, true));
        assert_eq!(count_words(b"v nan 1 20000", 1), count(3, 5, false));
        assert_eq!(count_words(b"v", 1), count(0, 0, true));
        let bytes = b"v  1\t2.5 ";
        let words: Vec<_> = Words::of(bytes, 1).collect();
        assert_eq!(words, [(3, &b"1"[..]), (5, &b"2.5"[..])]);
        let statement = Statement {
            line: 1,
            bytes,
            is_joined: false,
        };
        assert_eq!(number::<f64>(&statement, words[1]).expect("a number"), 2.5);
        assert!(number::<f64>(&statement, (0, b"v")).is_err());
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
        assert_eq!(before_comment("wood # red"), Some("wood"));
        assert_eq!(before_comment("wood#2"), None);
    }
}

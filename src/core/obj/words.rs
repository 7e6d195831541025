//! What are the words of a line, and which numbers are they?

use super::corner::is_blank;
use super::error::Problem;
use super::facts::shortened;
use super::lines::Statement;
use memchr::memchr_iter;
use std::str::FromStr;

/// The words of a line, and where they begin.
#[derive(Clone)]
pub(super) struct Words<'l> {
    line: &'l [u8],
    at: usize,
}

impl<'l> Words<'l> {
    /// Those from an offset on.
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

/// How many words there are from an offset on, and whether all bytes of them can be parts of decimal numbers.
pub(super) fn count_words(line: &[u8], at: usize) -> (usize, bool) {
    /// 1 for blanks, 2 for what is neither blank nor of a number.
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
    let (mut count, mut classes, mut before) = (0, 0, 1);
    for &byte in &line[at..] {
        let class = CLASSES[usize::from(byte)];
        count += usize::from(before == 1 && class != 1);
        classes |= class;
        before = class;
    }
    (count, classes & 2 == 0)
}

/// The number that one of a statement's words is.
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

/// A line up to its comment. A # behind a point is part of a number that is none: Microsoft's NaN is `-1.#IND`.
pub(super) fn without_comment(bytes: &[u8]) -> &[u8] {
    let is_comment = |&at: &usize| at == 0 || bytes[at - 1] != b'.';
    let comment = memchr_iter(b'#', bytes).find(is_comment);
    comment.map_or(bytes, |at| &bytes[..at])
}

/// A name up to what may be a comment, if there is something that may be one: a # behind a blank.
pub(super) fn before_comment(name: &str) -> Option<&str> {
    let at = name.find(" #").or_else(|| name.find("\t#"))?;
    Some(name[..at].trim_end())
}

/// A name keeps its `#`, as exporters write `usemtl Material #27`.
pub(super) fn name(bytes: &[u8]) -> String {
    text(bytes).trim().to_owned()
}

/// Bytes that aren't UTF-8 are read as Latin-1.
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
    fn words_stand_between_blanks() {
        assert_eq!(count_words(b"v  1\t2.5 ", 1), (2, true));
        assert_eq!(count_words(b"v nan 1 2", 1), (3, false));
        assert_eq!(count_words(b"v", 1), (0, true));
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
    fn names_may_have_any_bytes() {
        assert_eq!(name(b" caf\xe9 #2 "), "café #2");
        assert_eq!(name("café".as_bytes()), "café");
        assert_eq!(without_comment(b"1 2 # 3"), b"1 2 ");
        assert_eq!(without_comment(b"-1.#IND 2# 3"), b"-1.#IND 2");
        assert_eq!(before_comment("wood # red"), Some("wood"));
        assert_eq!(before_comment("wood#2"), None);
    }
}

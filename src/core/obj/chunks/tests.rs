//! Tests: chunks and the statements in them.

use super::*;
use std::io::{self, Write};

/// Each statement and its line.
fn statements_of(bytes: &[u8]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let take = |statement: Statement<'_>| {
        let text = String::from_utf8_lossy(statement.bytes).into_owned();
        found.push((statement.line, text));
        Ok(ControlFlow::Continue(()))
    };
    each_statement(bytes, &Progress::default(), take).expect("good");
    found
}

fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

#[test]
fn lines_have_any_line_end_and_continue_after_a_backslash() {
    let expected = [(1, "v 1"), (2, ""), (3, "f 1  2 3"), (5, "g a")];
    let expected: Vec<(usize, String)> = expected.map(|(n, text)| (n, text.to_owned())).into();
    for end in ["\n", "\r", "\r\n"] {
        let text = ["v 1", "", "f 1 \\", "2 3", "g a"].join(end);
        assert_eq!(statements_of(text.as_bytes()), expected);
        let marked = [b"\xEF\xBB\xBF", text.as_bytes()].concat();
        assert_eq!(statements_of(&marked), expected);
        assert_eq!(statements_of(&gzipped(&marked)), expected);
        let wide = text.encode_utf16().flat_map(u16::to_le_bytes);
        let wide: Vec<u8> = [0xFF, 0xFE].into_iter().chain(wide).collect();
        assert_eq!(statements_of(&wide), expected);
    }
    assert_eq!(statements_of(b"f 1 \\"), [(1, "f 1 ".to_owned())]);
    assert_eq!(statements_of(b"f 1 \\ \t\n2"), [(1, "f 1  2".to_owned())]);
}

#[test]
fn a_comment_does_not_continue_after_a_backslash() {
    let comment = r" # C:\models\".to_owned();
    let text = format!("{comment}\nv 1");
    assert_eq!(
        statements_of(text.as_bytes()),
        [(1, comment), (2, "v 1".to_owned())]
    );
}

#[test]
fn chunks_end_between_statements_and_know_their_lines() {
    for end in ["\n", "\r", "\r\n"] {
        // The lines have all lengths, so that chunks would end anywhere in them.
        let line = |k: usize| match k % 5 {
            0 => format!("f {:>1$} \\", k, k % 97),
            1 => String::new(),
            _ => format!("v {k}{}", ".5".repeat(k % 31)),
        };
        let lines: Vec<String> = (0..60_000).map(line).collect();
        let text = lines.join(end);
        let mut chunks = 0;
        let progress = Progress::default();
        let mut source = Chunks::new(text.as_bytes(), CHUNK_SIZE, &progress).expect("bytes");
        let mut expected = (1..).zip(&lines).filter(|(n, _)| n % 5 != 2);
        while let Some(chunk) = source.next().expect("good") {
            chunks += 1;
            let mut statements = Statements::of(&chunk);
            while let Some(statement) = statements.next() {
                let (line, text) = expected.next().expect("as many statements");
                let text = text
                    .strip_suffix('\\')
                    .map_or(text.clone(), |text| format!("{text} "));
                assert_eq!(statement.line, line);
                assert_eq!(String::from_utf8_lossy(statement.bytes), text);
            }
        }
        assert!(chunks > 3 && expected.next().is_none(), "{chunks}");
    }
}

#[test]
fn a_statement_may_be_longer_than_a_chunk() {
    let long = "1 ".repeat(CHUNK_SIZE);
    let text = format!("v 1\nf {long}\\\n{long}\\\n2\nv 2\n");
    let lines: Vec<usize> = statements_of(text.as_bytes())
        .iter()
        .map(|(n, _)| *n)
        .collect();
    assert_eq!(lines, [1, 2, 5]);
}

#[test]
fn other_formats_are_recognised_after_empty_lines() {
    for bytes in [
        &b"\r\n\n <html>"[..],
        b"\n<!DOCTYPE html>",
        b"\n\n\0\x01",
        b"# a\n\0",
    ] {
        let progress = Progress::default();
        let mut chunks = Chunks::new(bytes, CHUNK_SIZE, &progress).expect("bytes");
        let is_recognised = matches!(chunks.require_obj(), Err(Problem::Content(_)));
        assert!(is_recognised, "{}", bytes.escape_ascii());
    }
}

#[test]
fn a_truncated_gzip_file_is_an_error() {
    let whole = gzipped(&b"v 0 0 0\n".repeat(1000));
    let take = |_: Statement<'_>| Ok(ControlFlow::Continue(()));
    let read = each_statement(&whole[..whole.len() / 2], &Progress::default(), take);
    assert!(matches!(read, Err(Problem::Read(e)) if e.kind() == io::ErrorKind::UnexpectedEof));
}

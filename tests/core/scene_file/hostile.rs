//! Malicious files give one clear line, within the memory limit.

use super::{MAX_MEMORY, message, parse, parse_bytes, scene};
use std::fmt::Write as _;

#[test]
fn an_entity_bomb_is_refused_at_its_declaration() {
    let mut text = String::from("<?xml version='1.0'?>\n<!DOCTYPE scene [\n<!ENTITY a0 'ha'>\n");
    for k in 1..10 {
        let references = format!("&a{};", k - 1).repeat(10);
        writeln!(text, "<!ENTITY a{k} '{references}'>").expect("memory");
    }
    text += "]>\n<scene version='3.0.0'>&a9;</scene>";
    let expected = "x.xml:2: a document type declaration (“<!…>”) isn't allowed";
    assert_eq!(message(parse(&text)), expected);
    // Nor is a file outside read.
    let text = "<!DOCTYPE s [<!ENTITY a SYSTEM 'file:///etc/passwd'>]><s>&a;</s>";
    let expected = "x.xml:1: a document type declaration (“<!…>”) isn't allowed";
    assert_eq!(message(parse(text)), expected);
}

#[test]
fn deep_nesting_is_refused() {
    let expected = "x.xml:101: elements are nested more than 100 deep";
    assert_eq!(message(parse(&"<a>\n".repeat(100_000))), expected);
    let csg = "<shape type='csg'><string name='operation' value='union'/><shape type='disk'/>\n";
    let nested = |depth: usize| {
        let inner = "<shape type='disk'/>";
        scene(&(csg.repeat(depth) + inner + &"</shape>".repeat(depth)))
    };
    let expected = "x.xml:101: elements are nested more than 100 deep";
    assert_eq!(message(parse(&nested(100_000))), expected);
    // The innermost shapes are empty elements.
    assert_eq!(message(parse(&nested(99))), "read");
    assert_eq!(message(parse(&nested(100))), expected);
}

#[test]
fn a_million_attributes_are_refused() {
    let mut text = String::from("<scene version='3.0.0'>\n<shape type='disk'");
    for k in 0..1_000_000 {
        write!(text, " a{k}=''").expect("memory");
    }
    text += "/></scene>";
    let expected = "x.xml:2: the element has more than 64 attributes";
    assert_eq!(message(parse(&text)), expected);
}

#[test]
fn a_million_parameters_of_one_shape_are_refused() {
    let mut text = String::from("<shape type='disk'>");
    for k in 0..1_000_000 {
        writeln!(text, "<float name='a{k}' value='1'/>").expect("memory");
    }
    let expected = "x.xml:66: shape “disk” has more than 64 parameters";
    assert_eq!(message(parse(&scene(&(text + "</shape>")))), expected);
}

#[test]
fn other_encodings_are_refused_with_the_line() {
    let latin_1 = b"<scene version='3.0.0'>\n<!-- caf\xE9 -->\n</scene>";
    let expected = "x.xml:2: the text isn't valid UTF-8";
    assert_eq!(message(parse_bytes(latin_1, MAX_MEMORY)), expected);
    let odd = b"\xFF\xFE<\0\n\0\0";
    let expected = "x.xml:2: the text isn't valid UTF-16";
    assert_eq!(message(parse_bytes(odd, MAX_MEMORY)), expected);
    let without_mark: Vec<u8> = "<scene/>"
        .encode_utf16()
        .flat_map(u16::to_be_bytes)
        .collect();
    let expected = "x.xml:1:1: unknown token";
    assert_eq!(message(parse_bytes(&without_mark, MAX_MEMORY)), expected);
}

#[test]
fn a_scene_beyond_the_memory_limit_is_refused() {
    // What is needed is rounded up, and depends on the sizes of types.
    let is_refused = |text: &str| {
        let message = message(parse_bytes(text.as_bytes(), 16 << 20));
        let needed = message.strip_prefix("x.xml: loading needs at least ");
        let needed = needed.and_then(|rest| {
            rest.strip_suffix(" MB of memory, more than the 16 MB allowed (--max-memory)")
        });
        let needed: Option<u64> = needed.and_then(|number| number.parse().ok());
        assert!(needed.is_some_and(|needed| needed > 16), "{message}");
    };
    is_refused(&scene(&"<shape type='disk'/>".repeat(100_000)));
    // Nothing but text, of which the parser needs no list.
    for text in ["=", "x"] {
        is_refused(&scene(&text.repeat(20 << 20)));
    }
    let parameters = (0..5_000).map(|k| format!("<default name='b{k}' value='$a'/>"));
    let start = format!("<default name='a' value='{}'/>", "x".repeat(60_000));
    let defaults = scene(&(start + &parameters.collect::<String>()));
    is_refused(&defaults);
}

#[test]
fn parameters_that_double_are_refused() {
    let mut text = String::from("<default name='a0' value='0123456789'/>\n");
    for k in 1..60 {
        writeln!(text, "<default name='a{k}' value='$a{0}$a{0}'/>", k - 1).expect("memory");
    }
    let expected = "x.xml:15: a value with parameters is longer than 65536 bytes";
    assert_eq!(message(parse(&scene(&text))), expected);
}

#[test]
fn messages_are_one_short_line() {
    let name = "a\n\u{1b}[31m\u{202e}".to_owned() + &"x".repeat(100_000);
    for contents in [
        "<shape type='NAME'/>",
        "<shape type='disk' id='NAME'/><shape type='disk' id='NAME'/>",
        "<shape type='sphere'><float name='radius' value='NAME'/></shape>",
        "<shape type='sphere'><float name='NAME' value='1'/></shape>",
        "<shape type='disk'><ref id='NAME'/></shape>",
        "<include filename='NAME'/>",
        "<xNAME/>",
    ] {
        // Attributes keep line ends only as references.
        let name = name.replace('\n', "&#10;").replace('\u{1b}', "");
        let error = message(parse(&scene(&contents.replace("NAME", &name))));
        assert!(error.len() < 400, "{contents}: {} bytes", error.len());
        assert!(!error.contains(['\n', '\u{1b}', '\u{202e}']), "{error}");
    }
}

#[test]
fn a_million_spheres_are_read() {
    let mut text = String::new();
    for k in 0..1_000_000 {
        writeln!(
            text,
            "<shape type='sphere'><point name='center' value='{k}, 0, 0.5'/><float name='radius' value='0.25'/></shape>"
        )
        .expect("memory");
    }
    let scene = parse_bytes(scene(&text).as_bytes(), 8 << 30).expect("good");
    assert_eq!(scene.shapes.len(), 1_000_000);
    assert_eq!(scene.shapes[999_999].place.line, 1_000_001);
}

#[test]
fn a_long_file_is_read_in_pieces_with_the_same_lines() {
    // Each shape has two lines, and pieces start within lines.
    let shape = "<shape type='sphere'>\n<float name='radius' value='2'/></shape> ";
    let count = 4_000;
    let shapes = shape.repeat(count);
    let read = parse(&scene(&shapes)).expect("good");
    assert_eq!(read.shapes.len(), count);
    let lines: Vec<u32> = read.shapes.iter().map(|shape| shape.place.line).collect();
    let expected: Vec<u32> = (2..).take(count).collect();
    assert_eq!(lines, expected);
    let line = 2 + count;
    for (end, expected) in [
        (
            "<shape type='spher'/>",
            "unknown shape “spher”; the nearest known one is “sphere”",
        ),
        ("<shape type='disk'>", ""),
    ] {
        let message = message(parse(&scene(&(shapes.clone() + end))));
        assert!(
            message.starts_with(&format!("x.xml:{line}:")) || expected.is_empty(),
            "{message}"
        );
        assert!(message.contains(expected), "{message}");
    }
    // Row and column of malformed XML are those of the file.
    let message = message(parse(&scene(&(shapes + "é<shape <"))));
    let column = shape.lines().last().expect("a line").chars().count() + "é<shape ".len();
    assert!(
        message.starts_with(&format!("x.xml:{line}:{column}: ")),
        "{message}"
    );
}

//! Messages about invalid JSON for users.

use hitscope_core::counts::counted;
use hitscope_core::obj::shortened;
use serde_json::Error;
use serde_json::error::Category;

/// The message about a JSON text that can't be parsed, without the position in the text.
pub fn explained(error: &Error) -> String {
    let text = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    let message = text.strip_suffix(&position).unwrap_or(&text);
    match error.classify() {
        Category::Eof => "the text ends too early".to_owned(),
        _ => in_words(message),
    }
}

/// A message of serde in words for users who know JSON but not Rust.
fn in_words(message: &str) -> String {
    let is_mismatch = |message: &&str| {
        ["invalid type: ", "invalid value: ", "invalid length "]
            .iter()
            .any(|start| message.starts_with(start))
    };
    let mismatch = Some(message).filter(is_mismatch);
    if let Some((found, expected)) = mismatch.and_then(|text| text.split_once(", expected ")) {
        let found = match found.strip_prefix("invalid length ") {
            Some(count) => counted(count.parse().unwrap_or_default(), "value"),
            None => found_in_words(found.split_once(": ").unwrap_or_default().1),
        };
        return format!("expected {}, found {found}", expected_in_words(expected));
    }
    if let Some(name) = quoted_after(message, "missing field ") {
        return format!("“{name}” is missing");
    }
    if let Some(name) = quoted_after(message, "unknown variant ") {
        return format!("“{}” is unknown", shortened(name));
    }
    match message {
        "trailing characters" => "there is a value too many, or text after the end".to_owned(),
        "number out of range" => "a number is too large".to_owned(),
        _ => in_quotes(message),
    }
}

/// The name in backticks after a beginning.
fn quoted_after<'m>(message: &'m str, start: &str) -> Option<&'m str> {
    let rest = message.strip_prefix(start)?.strip_prefix('`')?;
    rest.split_once('`').map(|(name, _)| name)
}

/// A value as serde describes it, such as ``integer `3` ``.
fn found_in_words(found: &str) -> String {
    match found.split_once(' ') {
        _ if found == "map" => "an object".to_owned(),
        _ if found == "sequence" => "a list".to_owned(),
        Some(("string", text)) => {
            let text = text.trim_matches('"');
            format!("the text “{}”", shortened(text))
        }
        Some(("integer" | "boolean", value)) => value.trim_matches('`').to_owned(),
        Some(("floating", value)) => {
            let value = value.trim_start_matches("point ");
            value.trim_matches('`').to_owned()
        }
        _ => in_quotes(found),
    }
}

/// A kind of value as serde describes it, such as `a sequence` or `struct Sight`.
fn expected_in_words(expected: &str) -> String {
    let length = expected.strip_prefix("an array of length ");
    match expected {
        "a map" => "an object".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a string" | "path string" => "a text".to_owned(),
        "f32" | "f64" => "a number".to_owned(),
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number that isn't too large".to_owned(),
        _ if expected.starts_with("struct ") => "an object".to_owned(),
        _ => match length {
            Some(count) => format!("a list of {count} values"),
            None => in_quotes(expected),
        },
    }
}

/// A text with quotation marks instead of backticks.
fn in_quotes(text: &str) -> String {
    let mut parts = text.split('`');
    let mut quoted = parts.next().unwrap_or_default().to_owned();
    for (index, part) in parts.enumerate() {
        quoted.push(if index % 2 == 0 { '“' } else { '”' });
        quoted += part;
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[expect(dead_code, reason = "only read")]
    struct Thing {
        size: [u32; 2],
        is_on: bool,
        mode: Mode,
        name: String,
    }

    #[derive(Debug, Deserialize)]
    enum Mode {
        Dark,
    }

    #[test]
    fn errors_are_in_plain_words() {
        let good = r#"{"size": [1, 2], "is_on": true, "mode": "Dark", "name": "x"}"#;
        assert!(serde_json::from_str::<Thing>(good).is_ok());
        for (from, to, words) in [
            ("{", "", "expected an object, found the text “size”"),
            ("}", "", "the text ends too early"),
            ("[1, 2]", "[1, 2, 3]", "there is a value too many"),
            (
                "[1, 2]",
                "[1]",
                "expected a list of 2 values, found 1 value",
            ),
            ("[1, 2]", "7", "expected a list of 2 values, found 7"),
            (
                "1, 2",
                "1, 2.5",
                "a whole number that isn't too large, found 2.5",
            ),
            ("true", "{}", "expected true or false, found an object"),
            (
                "true",
                "\"yes\"",
                "expected true or false, found the text “yes”",
            ),
            ("\"Dark\"", "\"Light\"", "“Light” is unknown"),
            ("\"x\"", "[]", "expected a text, found a list"),
            ("\"is_on\"", "\"is_off\"", "“is_on” is missing"),
            (", \"name\"", "; \"name\"", "expected “,” or “}”"),
        ] {
            let text = good.replacen(from, to, 1);
            let error = serde_json::from_str::<Thing>(&text).expect_err(&text);
            let found = explained(&error);
            let is_rust = found.contains(['`']) || found.contains(" at line ");
            assert!(found.contains(words) && !is_rust, "{text}: {found}");
        }
    }
}

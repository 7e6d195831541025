//! Indented XML text.

use super::problem::quoted;
use glam::{DMat4, DVec3};
use std::fmt::Write as _;

/// Why a scene can't be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{text} can't be written to a scene file: {reason}")]
pub struct WriteError {
    /// The name or other text that has no form in the format, quoted.
    text: String,
    reason: &'static str,
}

impl WriteError {
    pub(super) fn new(text: &str, reason: &'static str) -> Self {
        Self {
            text: quoted(text),
            reason,
        }
    }
}

/// The text written so far.
#[derive(Default)]
pub(super) struct Xml {
    text: String,
    /// The open elements.
    open: Vec<String>,
}

/// An attribute's name and value.
pub(super) type Attribute<'a> = (&'a str, &'a str);

impl Xml {
    /// Starts an element whose children follow.
    ///
    /// # Errors
    /// A value has no form in the format.
    pub(super) fn open(&mut self, tag: &str, attributes: &[Attribute]) -> Result<(), WriteError> {
        self.tag(tag, attributes, ">")?;
        self.open.push(tag.to_owned());
        Ok(())
    }

    /// Ends the element started last.
    pub(super) fn close(&mut self) {
        if let Some(tag) = self.open.pop() {
            self.indent();
            self.text += &format!("</{tag}>\n");
        }
    }

    /// An element without children.
    ///
    /// # Errors
    /// A value has no form in the format.
    pub(super) fn empty(&mut self, tag: &str, attributes: &[Attribute]) -> Result<(), WriteError> {
        self.tag(tag, attributes, "/>")
    }

    /// The text.
    pub(super) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn tag(&mut self, tag: &str, attributes: &[Attribute], end: &str) -> Result<(), WriteError> {
        self.indent();
        self.text += "<";
        self.text += tag;
        for (name, value) in attributes {
            self.text += " ";
            self.text += name;
            self.text += "=\"";
            self.value(value)?;
            self.text += "\"";
        }
        self.text += end;
        self.text += "\n";
        Ok(())
    }

    fn indent(&mut self) {
        for _ in &self.open {
            self.text += "    ";
        }
    }

    fn value(&mut self, value: &str) -> Result<(), WriteError> {
        let error = |reason| Err(WriteError::new(value, reason));
        for c in value.chars() {
            match c {
                '$' => return error("“$” starts the name of a parameter"),
                '&' => self.text += "&amp;",
                '<' => self.text += "&lt;",
                '>' => self.text += "&gt;",
                '"' => self.text += "&quot;",
                '\t' | '\n' | '\r' => self.text += &format!("&#{};", u32::from(c)),
                // Source: XML 1.0, production 2.
                '\0'..=' ' | '\u{FFFE}' | '\u{FFFF}' if c != ' ' => {
                    return error("XML has no form for one of its characters");
                }
                _ => self.text.push(c),
            }
        }
        Ok(())
    }
}

/// The shortest decimal that reads back to the same number.
pub(crate) fn number(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

pub(crate) fn vector(v: DVec3) -> String {
    v.to_array().map(number).join(", ")
}

/// The numbers of a matrix, row by row.
pub(super) fn matrix(matrix: DMat4) -> String {
    let mut text = String::new();
    for (k, value) in matrix.transpose().to_cols_array().into_iter().enumerate() {
        let separator = if k == 0 { "" } else { " " };
        // Writing to a string can't fail.
        _ = write!(text, "{separator}{}", number(value));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_read_back() {
        for (value, text) in [
            (1.0, "1"),
            (-0.5, "-0.5"),
            (0.1, "0.1"),
            (1e300, "1e300"),
            (5e-324, "5e-324"),
            (-0.0, "-0"),
            (1.0 / 3.0, "0.3333333333333333"),
        ] {
            assert_eq!(number(value), text);
            assert_eq!(text.parse().map(f64::to_bits), Ok(value.to_bits()));
        }
    }

    #[test]
    fn special_characters_are_escaped_or_refused() {
        let mut xml = Xml::default();
        xml.open("a", &[("b", "<&>\"'\n é")]).expect("possible");
        xml.empty("c", &[]).expect("possible");
        let text = xml.finish();
        let expected = "<a b=\"&lt;&amp;&gt;&quot;'&#10; é\">\n    <c/>\n</a>\n";
        assert_eq!(text, expected);
        for (value, reason) in [
            ("a$b", "“$” starts the name of a parameter"),
            ("a\u{1}b", "XML has no form for one of its characters"),
        ] {
            let error = Xml::default().empty("a", &[("b", value)]);
            let message = error.expect_err("impossible").to_string();
            let text = quoted(value);
            assert_eq!(
                message,
                format!("{text} can't be written to a scene file: {reason}")
            );
        }
    }
}

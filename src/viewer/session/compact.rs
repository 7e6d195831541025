//! Compact JSON of sessions: fields with default values are left out, and each list is on one line.

use serde::ser::Error as _;
use serde::{Serialize, Serializer};
use serde_json::Value;
use serde_json::ser::{Formatter, PrettyFormatter};
use std::io::{self, Write};

/// Serializes the fields of a value that differ from the default. A reader gives missing fields the default.
pub(super) fn changed<T, S>(value: &T, serializer: S) -> Result<S::Ok, S::Error>
where
    T: Serialize + Default,
    S: Serializer,
{
    // Through text, in which an f32 has few digits.
    let plain = |value: &T| serde_json::from_str(&serde_json::to_string(value)?);
    let both = plain(value).and_then(|value| Ok((value, plain(&T::default())?)));
    let (mut value, default): (Value, Value) = both.map_err(S::Error::custom)?;
    leave_out(&mut value, &default);
    value.serialize(serializer)
}

/// Removes the fields of an object that are equal to those of another one.
fn leave_out(value: &mut Value, default: &Value) {
    let (Value::Object(fields), Value::Object(defaults)) = (value, default) else {
        return;
    };
    fields.retain(|name, field| defaults.get(name) != Some(field));
    for (name, field) in fields {
        if let Some(default) = defaults.get(name) {
            leave_out(field, default);
        }
    }
}

/// JSON with a field on each line, and each list on one line.
pub(super) fn text(value: &impl Serialize) -> serde_json::Result<String> {
    let mut bytes = Vec::new();
    let lines = Lines(PrettyFormatter::new());
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, lines);
    value.serialize(&mut serializer)?;
    String::from_utf8(bytes).map_err(serde_json::Error::custom)
}

struct Lines(PrettyFormatter<'static>);

impl Formatter for Lines {
    fn begin_array_value<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        is_first: bool,
    ) -> io::Result<()> {
        writer.write_all(if is_first { b"" } else { b", " })
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object(writer)
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object(writer)
    }

    fn begin_object_key<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        is_first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(writer, is_first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object_value(writer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn equal_fields_are_left_out_at_each_depth() {
        let default = json!({"a": 1, "b": {"c": [1, 2], "d": {"e": true}}});
        let mut value = json!({"a": 1, "b": {"c": [1, 3], "d": {"e": true}}, "f": null});
        leave_out(&mut value, &default);
        assert_eq!(value, json!({"b": {"c": [1, 3]}, "f": null}));
    }

    #[test]
    fn a_list_is_on_one_line() {
        let value = json!({"a": [1, 2.5, [3]], "b": [{"c": 1}, {}]});
        let expected = "{\n  \"a\": [1, 2.5, [3]],\n  \"b\": [{\n      \"c\": 1\n    }, {}]\n}";
        let found = text(&value).expect("plain data");
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(words(&found), words(expected));
        assert_eq!(found.lines().next_back(), Some("}"));
        assert!(found.contains("\"a\": [1, 2.5, [3]],\n"), "{found}");
    }
}

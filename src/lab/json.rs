//! JSON output whose numbers, parsed as doubles, are exactly the values that were written.
//!
//! serde_json writes an f32 with just enough digits to distinguish it from other f32 numbers: `1.0000029` for
//! 1.00000286102294921875. Parsed as a double, that is another number. This module writes an f32 as the f64 of the
//! same value, and minus zero as zero.

use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter};
use std::io::{self, Write};

/// A value as JSON on one line.
pub fn to_line(value: &impl Serialize) -> String {
    written(value, CompactFormatter)
}

/// A value as indented JSON.
pub fn to_pretty(value: &impl Serialize) -> String {
    written(value, PrettyFormatter::new())
}

/// Appends a value as JSON on one line, with the line's end.
pub fn append_line(text: &mut Vec<u8>, value: &impl Serialize) {
    write(text, value, CompactFormatter);
    text.push(b'\n');
}

fn written(value: &impl Serialize, layout: impl Formatter) -> String {
    let mut text = Vec::new();
    write(&mut text, value, layout);
    String::from_utf8(text).expect("JSON is UTF-8")
}

fn write(text: &mut Vec<u8>, value: &impl Serialize, layout: impl Formatter) {
    let mut serializer = Serializer::with_formatter(text, ExactNumbers(layout));
    value
        .serialize(&mut serializer)
        .expect("results are plain data, and writing to memory can't fail");
}

/// A formatter that writes numbers as described in the [module](self).
struct ExactNumbers<F>(F);

/// Forwards methods to the inner formatter.
macro_rules! delegate {
    ($($method:ident($($argument:ident: $type:ty),*);)*) => {$(
        fn $method<W: ?Sized + Write>(&mut self, out: &mut W $(, $argument: $type)*) -> io::Result<()> {
            self.0.$method(out $(, $argument)*)
        }
    )*};
}

impl<F: Formatter> Formatter for ExactNumbers<F> {
    fn write_f32<W: ?Sized + Write>(&mut self, out: &mut W, value: f32) -> io::Result<()> {
        self.write_f64(out, value.into())
    }

    fn write_f64<W: ?Sized + Write>(&mut self, out: &mut W, value: f64) -> io::Result<()> {
        // −0 + 0 is 0; no other number changes.
        self.0.write_f64(out, value + 0.0)
    }

    delegate! {
        begin_array();
        end_array();
        begin_array_value(first: bool);
        end_array_value();
        begin_object();
        end_object();
        begin_object_key(first: bool);
        end_object_key();
        begin_object_value();
        end_object_value();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn an_f32_reads_back_as_the_double_of_the_same_value() {
        for x in [1.000_002_9f32, 0.1, 16_777_215.0, 1e-45, f32::MAX] {
            let double: f64 = to_line(&x).parse().expect("a number");
            assert_eq!(double, f64::from(x), "{x}");
        }
        assert_eq!(to_line(&[1.5f32, 2.0]), "[1.5,2.0]");
        // Numbers that went through a `Value` are f64 already.
        let value: Value = json!({ "t": 0.1f32 });
        assert_eq!(to_line(&value), format!("{{\"t\":{}}}", f64::from(0.1f32)));
    }

    #[test]
    fn minus_zero_is_written_as_zero_and_non_finite_numbers_as_null() {
        assert_eq!(to_line(&(-0.0f32, -0.0f64, json!(-0.0))), "[0.0,0.0,0.0]");
        assert_eq!(to_line(&(f32::NAN, f64::INFINITY)), "[null,null]");
    }

    #[test]
    fn the_layouts_equal_those_of_serde_json() {
        let value = json!({ "a": [1, 2.5, []], "b": {}, "c": [{ "d": null }] });
        assert_eq!(to_line(&value), value.to_string());
        assert_eq!(to_pretty(&value), format!("{value:#}"));
    }
}

//! Parameters of a scene: `<default name value>`, and `$name` in attributes.

use super::description::Place;
use super::problem::{Problem, quoted, unknown};
use std::borrow::Cow;
use std::collections::HashMap;

/// The length of the longest value with inserted parameters, in bytes. Parameters may be inserted into parameters, so
/// that lengths could double with each of them.
const MAX_LENGTH: usize = 1 << 16;

/// The values of the parameters defined so far.
#[derive(Default)]
pub(super) struct Defaults(HashMap<String, String>);

impl Defaults {
    /// Defines a parameter, unless it is defined: the first definition counts, as in Mitsuba.
    pub(super) fn define(&mut self, name: &str, value: &str) {
        if !self.0.contains_key(name) {
            self.0.insert(name.to_owned(), value.to_owned());
        }
    }

    /// A text with the values of parameters in place of `$name`. A name consists of ASCII letters, digits and
    /// underscores.
    ///
    /// # Errors
    /// A parameter isn't defined, or the text becomes too long.
    pub(super) fn insert_into<'a>(
        &self,
        text: &'a str,
        place: Place,
    ) -> Result<Cow<'a, str>, Problem> {
        let Some((start, mut rest)) = text.split_once('$') else {
            return Ok(Cow::Borrowed(text));
        };
        let mut inserted = start.to_owned();
        loop {
            let is_end = |c: char| !(c.is_ascii_alphanumeric() || c == '_');
            let (name, after) = rest.split_at(rest.find(is_end).unwrap_or(rest.len()));
            inserted += self.value(name).map_err(|why| Problem::at(place, why))?;
            let next = after.split_once('$');
            inserted += next.map_or(after, |(between, _)| between);
            if inserted.len() > MAX_LENGTH {
                let message = format!("a value with parameters is longer than {MAX_LENGTH} bytes");
                return Err(Problem::at(place, message));
            }
            let Some((_, after)) = next else {
                return Ok(Cow::Owned(inserted));
            };
            rest = after;
        }
    }

    fn value(&self, name: &str) -> Result<&str, String> {
        /// More than any scene has; comparing a name with all takes time.
        const MAX_COMPARED: usize = 1000;
        if name.is_empty() {
            return Err("no name of a parameter follows “$”".to_owned());
        }
        let undefined = || {
            let mut known: Vec<&str> = self
                .0
                .keys()
                .take(MAX_COMPARED)
                .map(String::as_str)
                .collect();
            known.sort_unstable();
            if known.is_empty() {
                return format!("parameter {} isn't defined", quoted(name));
            }
            unknown("parameter", name, &known)
        };
        self.0.get(name).map(String::as_str).ok_or_else(undefined)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inserted(defaults: &Defaults, text: &str) -> Result<String, String> {
        let place = Place { file: 0, line: 3 };
        match defaults.insert_into(text, place) {
            Ok(text) => Ok(text.into_owned()),
            Err(problem) => Err(problem.with_path(&["x.xml".into()]).to_string()),
        }
    }

    #[test]
    fn names_end_at_the_first_other_character() {
        let mut defaults = Defaults::default();
        for (name, value) in [("q", "3"), ("q_1", "4"), ("é", "5"), ("q", "6")] {
            defaults.define(name, value);
        }
        for (text, expected) in [
            ("none", Ok("none")),
            ("a$q-$q.b", Ok("a3-3.b")),
            ("$q_1$q", Ok("43")),
            ("$qé", Ok("3é")),
            (
                "$x",
                Err("x.xml:3: unknown parameter “x”; expected “q”, “q_1” or “é”"),
            ),
            ("5$", Err("x.xml:3: no name of a parameter follows “$”")),
            ("$é", Err("x.xml:3: no name of a parameter follows “$”")),
            ("${q}", Err("x.xml:3: no name of a parameter follows “$”")),
        ] {
            let expected = expected.map(str::to_owned).map_err(str::to_owned);
            assert_eq!(inserted(&defaults, text), expected, "{text}");
        }
        let none = inserted(&Defaults::default(), "$x");
        assert_eq!(none, Err("x.xml:3: parameter “x” isn't defined".to_owned()));
    }

    #[test]
    fn a_value_that_doubles_again_and_again_is_refused() {
        let mut defaults = Defaults::default();
        defaults.define("a0", "0123456789");
        let mut last = String::new();
        for k in 0..40 {
            match inserted(&defaults, &format!("$a{k}$a{k}")) {
                Ok(value) => defaults.define(&format!("a{}", k + 1), &value),
                Err(message) => {
                    last = message;
                    break;
                }
            }
        }
        assert_eq!(
            last,
            "x.xml:3: a value with parameters is longer than 65536 bytes"
        );
    }
}

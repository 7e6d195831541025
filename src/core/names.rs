//! Names in messages: lists of alternatives, and hints about misspelt names.

use std::borrow::Borrow;

/// A list of alternatives: `a`, `a or b`, `a, b or c`.
pub fn alternatives<S: Borrow<str>>(names: &[S]) -> String {
    match names {
        [] => String::new(),
        [only] => only.borrow().to_owned(),
        [others @ .., last] => format!("{} or {}", others.join(", "), last.borrow()),
    }
}

/// The known name that a misspelt one resembles most; `None` if none is near. Lower and upper case count as equal. A
/// third of its letters, but at most two, may be wrong, missing, superfluous or swapped with the next.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    /// With more errors, short words resemble too many others.
    const MOST_ERRORS: usize = 2;
    /// Longer than any known name; comparing takes time.
    const LENGTH: usize = 60;
    let lower_case = name.chars().take(LENGTH).collect::<String>().to_lowercase();
    let most = MOST_ERRORS.min(lower_case.chars().count() / 3);
    let distances = known.into_iter().map(|known| {
        let distance = strsim::damerau_levenshtein(&lower_case, &known.to_lowercase());
        (distance, known)
    });
    let nearest = distances.min_by_key(|(distance, _)| *distance);
    nearest.and_then(|(distance, name)| (distance <= most).then_some(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternatives_are_separated_by_commas_and_or() {
        assert_eq!(alternatives(&["a", "b", "c"]), "a, b or c");
        assert_eq!(alternatives(&["a", "b"]), "a or b");
        assert_eq!(alternatives(&["a"]), "a");
        assert_eq!(alternatives::<&str>(&[]), "");
    }

    #[test]
    fn only_similar_names_are_near() {
        let known = ["sphere", "cylinder", "obj", "Ag"];
        for (name, expected) in [
            ("spere", Some("sphere")),
            ("Sphere", Some("sphere")),
            ("pshree", Some("sphere")),
            ("ob", None),
            ("ag", Some("Ag")),
            ("objs", Some("obj")),
            ("cone", None),
            ("", None),
        ] {
            assert_eq!(nearest(name, known), expected, "{name}");
        }
    }
}

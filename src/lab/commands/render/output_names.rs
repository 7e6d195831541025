//! Names of the files of several pictures: `out-{view}-{name}.png`.

use super::super::CommandError;
use super::super::output::is_stream;
use hitscope_core::obj::shown;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The place in a name for the name of the view.
pub const VIEW: &str = "view";
/// The place for the name of the camera.
pub const NAME: &str = "name";
/// The place for the number of the camera.
pub const INDEX: &str = "index";

/// Whether a name has a place, as in `{view}`.
pub fn has_place(pattern: &Path, key: &str) -> bool {
    pattern.to_string_lossy().contains(&place(key))
}

/// The name for one picture: each place is filled with its value.
pub fn filled(pattern: &Path, values: &[(&str, &str)]) -> PathBuf {
    // A name that isn't UTF-8 has no places.
    let Some(mut text) = pattern.to_str().map(str::to_owned) else {
        return pattern.to_owned();
    };
    for (key, value) in values {
        text = text.replace(&place(key), value);
    }
    text.into()
}

/// Refuses outputs of which one would replace another.
///
/// # Errors
/// [`CommandError::Usage`].
pub fn check_distinct(names: &[PathBuf]) -> Result<(), CommandError> {
    let refuse = |message: String| Err(CommandError::Usage(message));
    if names.len() > 1 && names.iter().any(|name| is_stream(name)) {
        return refuse("several outputs can't be written to pipes or devices".to_owned());
    }
    let mut seen = BTreeSet::new();
    match names.iter().find(|&name| !seen.insert(name)) {
        Some(name) => refuse(format!("two outputs have the name {}", shown(name))),
        None => Ok(()),
    }
}

/// An index with as many digits as the last of `count`, so that files sort by it.
pub fn padded(index: usize, count: usize) -> String {
    let width = count.saturating_sub(1).max(1).ilog10() as usize + 1;
    format!("{index:0width$}")
}

fn place(key: &str) -> String {
    format!("{{{key}}}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_filled_and_other_braces_are_kept() {
        let values = [(NAME, "front"), (INDEX, "07")];
        let name = |pattern: &str| filled(Path::new(pattern), &values);
        assert_eq!(name("a/{name}-{index}.png"), Path::new("a/front-07.png"));
        assert_eq!(name("{names}{view}.png"), Path::new("{names}{view}.png"));
        assert!(has_place(Path::new("{view}.png"), VIEW));
        assert!(!has_place(Path::new("view.png"), VIEW));
    }

    #[test]
    fn indices_have_the_digits_of_the_last() {
        for (index, count, text) in [(0, 1, "0"), (9, 10, "9"), (9, 11, "09"), (7, 101, "007")] {
            assert_eq!(padded(index, count), text);
        }
    }

    #[test]
    fn equal_names_are_refused() {
        let names = ["a.png", "b.png", "a.png"].map(PathBuf::from);
        let error = check_distinct(&names).expect_err("refused");
        assert!(error.is_usage());
        assert_eq!(error.to_string(), "two outputs have the name a.png");
        assert!(check_distinct(&names[..2]).is_ok());
        let streams = ["/dev/stdout", "a.png"].map(PathBuf::from);
        assert!(check_distinct(&streams).is_err());
        assert!(check_distinct(&streams[..1]).is_ok());
    }
}

//! The files beside the open one that the window can open, in natural order.

use std::cmp::Ordering;
use std::io;
use std::path::{Path, PathBuf};

/// The way to a file beside the open one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To the next file; from the last one to the first.
    Next,
    /// To the previous file; from the first one to the last.
    Previous,
}

/// The next or previous file of a file's folder that the window can open; `None` if there is no other one. The file
/// itself needn't exist.
///
/// # Errors
/// If the folder can't be read.
pub fn neighbour(file: &Path, direction: Direction) -> io::Result<Option<PathBuf>> {
    let file = std::path::absolute(file)?;
    let (Some(folder), Some(own)) = (file.parent(), file.file_name()) else {
        return Ok(None);
    };
    let own = own.to_string_lossy();
    let mut others = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        // A folder may be called `x.obj`.
        if can_be_opened(&name) && name != own && entry.path().is_file() {
            others.push((name, entry.path()));
        }
    }
    others.sort_by(|(a, _), (b, _)| natural_order(a, b));
    let count = others.len();
    if count == 0 {
        return Ok(None);
    }
    let following = others.partition_point(|(name, _)| natural_order(name, &own).is_lt());
    let index = match direction {
        Direction::Next => following,
        Direction::Previous => following + count - 1,
    };
    Ok(Some(others.swap_remove(index % count).1))
}

/// Whether a name is that of an OBJ file, plain or gzipped, or of a scene file.
fn can_be_opened(name: &str) -> bool {
    let name = name.to_lowercase();
    [".obj", ".obj.gz", ".xml"]
        .iter()
        .any(|ending| name.ends_with(ending))
}

/// The order in which people expect names: digits count as numbers, upper and lower case as the same.
fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut rest_a, mut rest_b) = (a, b);
    while let (Some(char_a), Some(char_b)) = (rest_a.chars().next(), rest_b.chars().next()) {
        let order = if char_a.is_ascii_digit() && char_b.is_ascii_digit() {
            let (number_a, number_b);
            (number_a, rest_a) = number(rest_a);
            (number_b, rest_b) = number(rest_b);
            // More digits are a larger number.
            let lengths = number_a.len().cmp(&number_b.len());
            lengths.then_with(|| number_a.cmp(number_b))
        } else {
            rest_a = &rest_a[char_a.len_utf8()..];
            rest_b = &rest_b[char_b.len_utf8()..];
            char_a.to_lowercase().cmp(char_b.to_lowercase())
        };
        if order.is_ne() {
            return order;
        }
    }
    // Names that differ only by case or by leading zeros have an order, too.
    rest_a.len().cmp(&rest_b.len()).then_with(|| a.cmp(b))
}

/// The digits at the beginning of a text, without leading zeros, and the rest of the text.
fn number(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit());
    let (digits, rest) = text.split_at(end.unwrap_or(text.len()));
    (digits.trim_start_matches('0'), rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ordered_by_their_numbers_and_without_regard_to_case() {
        let ordered = [
            "a.obj",
            "B.obj",
            "b.xml",
            "mesh.obj",
            "mesh1.obj",
            "mesh2.obj",
            "mesh10.obj",
            "mesh10b.obj",
            "mesh010c.obj",
            "Mesh99999999999999999999999.obj",
        ];
        let mut sorted = ordered;
        sorted.reverse();
        sorted.sort_by(|a, b| natural_order(a, b));
        assert_eq!(sorted, ordered);
        for name in ordered {
            assert_eq!(natural_order(name, name), Ordering::Equal);
        }
        assert!(natural_order("a01", "a1").is_ne());
    }

    #[test]
    fn neighbours_are_files_that_can_be_opened_and_the_last_leads_to_the_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let names = ["m1.obj", "m2.OBJ.gz", "m10.xml"];
        for name in names.iter().chain(&["m3.txt", "m4.mtl", "m5.gz"]) {
            std::fs::write(folder.path().join(name), "").expect("written");
        }
        std::fs::create_dir(folder.path().join("m6.obj")).expect("made");
        let beside = |name: &str, direction| {
            let found = neighbour(&folder.path().join(name), direction).expect("a folder");
            found.map(|path| path.file_name().expect("a name").to_owned())
        };
        for (k, name) in names.iter().enumerate() {
            let next = names[(k + 1) % 3];
            assert_eq!(beside(name, Direction::Next), Some(next.into()));
            assert_eq!(beside(next, Direction::Previous), Some((*name).into()));
        }
        // One that was deleted.
        assert_eq!(beside("m7.obj", Direction::Next), Some("m10.xml".into()));
        assert_eq!(
            beside("m7.obj", Direction::Previous),
            Some("m2.OBJ.gz".into())
        );
    }

    #[test]
    fn a_file_alone_has_no_neighbour_and_a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("one.obj");
        std::fs::write(&file, "").expect("written");
        for direction in [Direction::Next, Direction::Previous] {
            assert_eq!(neighbour(&file, direction).expect("a folder"), None);
        }
        let none = folder.path().join("none/one.obj");
        assert!(neighbour(&none, Direction::Next).is_err());
    }
}

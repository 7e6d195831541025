//! Links in messages, to the files, parts and elements that the text names.

use crate::session::is_session;
use hitscope_lab::element::Element;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The target of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// An element of the scene that was open.
    Element(Element),
    /// The parts with this name.
    Part(String),
    /// A file, and a line in it.
    File(PathBuf, Option<usize>),
}

/// A link.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The bytes of the text that are the link.
    pub range: Range<usize>,
    /// The target.
    pub target: Target,
}

impl Link {
    fn is_of_session(&self) -> bool {
        matches!(&self.target, Target::File(path, _) if is_session(path))
    }
}

/// A word that precedes a number, and the element that both name.
type NumberedElement = (&'static str, fn(usize) -> Element);

/// All kinds of numbered elements.
const ELEMENTS: [NumberedElement; 4] = [
    ("triangle", Element::Triangle),
    ("face", Element::Face),
    ("vertex", Element::Vertex),
    ("line", Element::Line),
];
/// The words that precede the quoted name of a part.
const PARTS: [&str; 4] = ["part", "group", "object", "material"];
/// The beginning of messages about saved files.
const SAVED: &str = "Saved ";

/// The links of a text, in order. `is_file` says whether a path is a file.
pub fn links(text: &str, is_file: impl Fn(&Path) -> bool) -> Vec<Link> {
    if let Some(path) = text.strip_prefix(SAVED) {
        let range = SAVED.len()..text.len();
        let target = Target::File(path.into(), None);
        return Vec::from_iter(is_file(Path::new(path)).then_some(Link { range, target }));
    }
    let mut links = Vec::from_iter(file_at_start(text, is_file));
    // Line numbers in messages about a session refer to the session, not to the mesh.
    if links.iter().any(Link::is_of_session) {
        return links;
    }
    let mut at = links.first().map_or(0, |link| link.range.end);
    while let Some(rest) = text.get(at..) {
        let Some(start) = rest.find(|c: char| c.is_ascii_alphabetic()) else {
            break;
        };
        let word_at = at + start;
        let word: &str = &text[word_at..];
        let length = word
            .find(|c: char| !c.is_alphanumeric())
            .unwrap_or(word.len());
        let (word, after) = word.split_at(length);
        at = word_at + length;
        if let Some((target, more)) = target(&word.to_lowercase(), after) {
            let range = word_at..at + more;
            at = range.end;
            links.push(Link { range, target });
        }
    }
    links
}

/// The target that a word and the text after it name, and the number of bytes of that text that belong to the link.
fn target(word: &str, after: &str) -> Option<(Target, usize)> {
    let rest = after.strip_prefix(' ')?;
    if let Some((_, element)) = ELEMENTS.iter().find(|(name, _)| *name == word) {
        let end = rest.find(|c: char| !c.is_ascii_digit());
        let number = &rest[..end.unwrap_or(rest.len())];
        let target = Target::Element(element(number.parse().ok()?));
        return Some((target, 1 + number.len()));
    }
    let quoted = rest.strip_prefix('“').filter(|_| PARTS.contains(&word))?;
    let (name, _) = quoted.split_once('”')?;
    let length = 1 + '“'.len_utf8() + name.len() + '”'.len_utf8();
    Some((Target::Part(name.to_owned()), length))
}

/// The file at the beginning of a message, as in `mesh.obj:12: a message`.
fn file_at_start(text: &str, is_file: impl Fn(&Path) -> bool) -> Option<Link> {
    let colons = text.match_indices(':').map(|(at, _)| at);
    let end = colons.take(4).find(|&at| is_file(Path::new(&text[..at])))?;
    let after = &text[end + 1..];
    let digits = after
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(after.len());
    let line = after[..digits].parse().ok();
    let length = line.map_or(0, |_| 1 + digits);
    let target = Target::File(text[..end].into(), line);
    Some(Link {
        range: 0..end + length,
        target,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_parts_and_files_are_found_and_other_words_are_not() {
        let is_file = |path: &Path| path == Path::new("a/mesh.obj") || path == Path::new("a b.png");
        let found = |text: &str| -> Vec<(String, Target)> {
            let links = links(text, is_file).into_iter();
            links
                .map(|link| (text[link.range].to_owned(), link.target))
                .collect()
        };
        assert_eq!(
            found("mesh.obj: line 12: Triangle 7 and face x of group “left side”, vertex 3"),
            [
                ("line 12".to_owned(), Target::Element(Element::Line(12))),
                (
                    "Triangle 7".to_owned(),
                    Target::Element(Element::Triangle(7))
                ),
                (
                    "group “left side”".to_owned(),
                    Target::Part("left side".to_owned())
                ),
                ("vertex 3".to_owned(), Target::Element(Element::Vertex(3))),
            ]
        );
        let file = |name: &str, line| Target::File(name.into(), line);
        assert_eq!(
            found("a/mesh.obj:12: a bad face"),
            [("a/mesh.obj:12".to_owned(), file("a/mesh.obj", Some(12)))]
        );
        assert_eq!(
            found("a/mesh.obj: too short"),
            [("a/mesh.obj".to_owned(), file("a/mesh.obj", None))]
        );
        let is_session = |path: &Path| path == Path::new("x.hitscope");
        let links = links("x.hitscope: not a session, line 1: empty", is_session);
        let targets: Vec<Target> = links.into_iter().map(|link| link.target).collect();
        assert_eq!(targets, [file("x.hitscope", None)]);
        assert_eq!(
            found("Saved a b.png"),
            [("a b.png".to_owned(), file("a b.png", None))]
        );
        for text in [
            "",
            "Saved none.png",
            "surface 3, polyline 4",
            "line",
            "face 99999999999999999999999",
        ] {
            assert_eq!(found(text), [], "{text}");
        }
    }
}

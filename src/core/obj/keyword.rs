//! The keywords of OBJ statements.

use super::corner::List;
use super::elements::ElementKind;

/// The first word of a statement that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    Numbers(List),
    Element(ElementKind),
    Material,
    Group,
    Smoothing,
    Library,
}

impl Keyword {
    /// The keyword that a word is, in upper or lower case: some programs write `V` and `F`.
    pub(super) fn of(word: &[u8]) -> Option<Self> {
        /// Length of the longest keywords, `usemtl` and `mtllib`.
        const LONGEST: usize = "usemtl".len();
        Self::in_lower_case(word).or_else(|| {
            let word = (word.len() <= LONGEST).then_some(word)?;
            Self::in_lower_case(&word.to_ascii_lowercase())
        })
    }

    fn in_lower_case(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"v" => Self::Numbers(List::Vertex),
            b"vt" => Self::Numbers(List::Texture),
            b"vn" => Self::Numbers(List::Normal),
            b"f" => Self::Element(ElementKind::Face),
            b"l" => Self::Element(ElementKind::Line),
            b"p" => Self::Element(ElementKind::Points),
            b"usemtl" => Self::Material,
            b"o" | b"g" => Self::Group,
            b"s" => Self::Smoothing,
            b"mtllib" => Self::Library,
            _ => return None,
        })
    }
}

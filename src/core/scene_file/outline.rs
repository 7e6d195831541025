//! A scan of XML text before it is parsed, which bounds the parser's time and memory, and cuts a long text into pieces
//! that are parsed one after the other.
//!
//! The parser compares each attribute with all others of its element, and keeps the namespaces of all enclosing
//! elements for each element. Both take quadratic time or memory, so that few attributes are allowed, and namespaces
//! aren't.

use memchr::{memchr, memchr_iter, memchr3, memmem};
use std::ops::Range;

/// More than any element of a scene has.
const MAX_ATTRIBUTES: usize = 64;
/// Deeper than any scene, and shallow enough for recursion.
pub(super) const MAX_DEPTH: usize = 100;
/// Sizes of the parser's nodes and attributes. Verified by the test program `scene_file_fuzz`, which measures memory.
const BYTES_PER_NODE: usize = 80;
const BYTES_PER_ATTRIBUTE: usize = 72;

/// Length in bytes from which a piece ends after the next child of the root element. The parser takes some twenty times
/// as much.
const PIECE_LENGTH: usize = 1 << 16;

/// The pieces of a text. Where a text isn't well-formed XML, a piece isn't either.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Outline<'a> {
    /// The name of the root element.
    pub root: &'a str,
    /// The ranges of the pieces. Those after the first start with a child of the root element.
    pub pieces: Vec<Range<usize>>,
    /// The bytes that the parser takes at most for a piece.
    pub piece_bytes: u64,
    /// The number of shapes that are children of the root element.
    pub shape_count: usize,
}

/// Something that isn't allowed, and its offset in the text.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Excess {
    pub offset: usize,
    pub message: String,
}

impl<'a> Outline<'a> {
    /// # Errors
    /// The text contains a document type declaration, namespaces, too many attributes or too many levels.
    pub(super) fn of(text: &'a str) -> Result<Self, Excess> {
        let bytes = text.as_bytes();
        let excess = |offset, message: String| Err(Excess { offset, message });
        let mut outline = Self::default();
        let (mut piece_start, mut node_count) = (0, NODES_ANYHOW);
        let (mut depth, mut at) = (0usize, 0);
        while let Some(found) = memchr(b'<', &bytes[at..]) {
            let start = at + found;
            let rest = &bytes[start..];
            let has_text = found > 0;
            node_count += usize::from(has_text) + usize::from(!rest.starts_with(b"</"));
            let length = if rest.starts_with(b"<!--") {
                through(rest, 4, b"-->")
            } else if rest.starts_with(b"<![CDATA[") {
                through(rest, 9, b"]]>")
            } else if rest.starts_with(b"<?") {
                through(rest, 2, b"?>")
            } else if rest.starts_with(b"<!") {
                let message = "a document type declaration (“<!…>”) isn't allowed".to_owned();
                return excess(start, message);
            } else {
                let tag = Tag::of(rest);
                if tag.has_namespace {
                    return excess(start, "XML namespaces aren't supported".to_owned());
                }
                if tag.attribute_count > MAX_ATTRIBUTES {
                    let message = format!("the element has more than {MAX_ATTRIBUTES} attributes");
                    return excess(start, message);
                }
                let (is_end, name) = (rest.starts_with(b"</"), tag.name(&text[start..]));
                if is_end {
                    depth = depth.saturating_sub(1);
                } else {
                    if depth == 0 && outline.root.is_empty() {
                        outline.root = name;
                    }
                    outline.shape_count += usize::from(depth == 1 && name == "shape");
                    depth += usize::from(!tag.is_empty);
                }
                if depth > MAX_DEPTH {
                    let message = format!("elements are nested more than {MAX_DEPTH} deep");
                    return excess(start, message);
                }
                let end = start + tag.length;
                let is_end_of_child = depth == 1 && (is_end || tag.is_empty);
                if is_end_of_child && end - piece_start >= PIECE_LENGTH {
                    outline.add(bytes, piece_start..end, node_count);
                    (piece_start, node_count) = (end, NODES_ANYHOW);
                }
                tag.length
            };
            at = start + length;
        }
        outline.add(bytes, piece_start..bytes.len(), node_count);
        Ok(outline)
    }

    fn add(&mut self, text: &[u8], piece: Range<usize>, node_count: usize) {
        let bytes = parser_bytes(&text[piece.clone()], node_count);
        self.piece_bytes = self.piece_bytes.max(bytes);
        self.pieces.push(piece);
    }

    /// What stands before and after a piece to make it a document.
    pub(super) fn ends(&self, piece: usize) -> [String; 2] {
        let start = match piece {
            0 => String::new(),
            _ => format!("<{}>", self.root),
        };
        let end = if piece + 1 == self.pieces.len() {
            String::new()
        } else {
            format!("</{}>", self.root)
        };
        [start, end]
    }
}

/// The document and its root element.
const NODES_ANYHOW: usize = 2;
/// The tags of a root element that is added to a piece.
const TAGS_ANYHOW: usize = 2;

/// The bytes that the parser takes at most for a text with a number of nodes.
///
/// Its lists start with room for as many nodes as there are `<` and for as many attributes as there are `=`. The list
/// of nodes may double once. Finally, both are copied to lists of the right size. Values with references are copied, and so
/// are pieces.
fn parser_bytes(text: &[u8], node_count: usize) -> u64 {
    let capacity = memchr_iter(b'<', text).count() + TAGS_ANYHOW;
    let attribute_count = memchr_iter(b'=', text).count();
    let node_capacity = if node_count <= capacity {
        capacity
    } else {
        2 * capacity.max(4)
    };
    let nodes = BYTES_PER_NODE * (node_capacity + node_count);
    let attributes = BYTES_PER_ATTRIBUTE * 2 * attribute_count;
    (nodes + attributes + 3 * text.len()) as u64
}

/// The length of a part that ends with `end`, not before `from`.
fn through(bytes: &[u8], from: usize, end: &[u8]) -> usize {
    let found = memmem::find(&bytes[from..], end);
    found.map_or(bytes.len(), |at| from + at + end.len())
}

/// A start or end tag.
struct Tag {
    length: usize,
    attribute_count: usize,
    has_namespace: bool,
    /// Whether it ends with `/>`.
    is_empty: bool,
}

impl Tag {
    /// The name of the element whose tag starts a text.
    fn name<'a>(&self, text: &'a str) -> &'a str {
        let tag = &text[..self.length];
        let name = tag.trim_start_matches(['<', '/']);
        let is_end = |c: char| matches!(c, ' ' | '\t' | '\r' | '\n' | '/' | '>');
        &name[..name.find(is_end).unwrap_or(name.len())]
    }

    /// The tag at the start of `bytes`.
    fn of(bytes: &[u8]) -> Self {
        let mut tag = Self {
            length: bytes.len(),
            attribute_count: 0,
            has_namespace: false,
            is_empty: false,
        };
        let mut at = 1;
        while let Some(found) = memchr3(b'>', b'"', b'\'', &bytes[at..]) {
            let name_end = at + found;
            let before = &bytes[at..name_end];
            if bytes[name_end] == b'>' {
                tag.length = name_end + 1;
                tag.is_empty = bytes[name_end - 1] == b'/';
                break;
            }
            // A quote: the name before it, and the value to the next one.
            tag.attribute_count += 1;
            tag.has_namespace |= memmem::find(before, b"xmlns").is_some();
            let Some(end) = memchr(bytes[name_end], &bytes[name_end + 1..]) else {
                break;
            };
            at = name_end + 1 + end + 1;
        }
        tag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> Option<(usize, String)> {
        Outline::of(text).err().map(|e| (e.offset, e.message))
    }

    #[test]
    fn nodes_and_attributes_are_counted_outside_comments() {
        let text =
            "<?xml version='1.0'?><a b=\"<>'\" c='/>'><!-- <x y=\"\"> -->t<d/><![CDATA[<q>]]></a>";
        let outline = Outline::of(text).expect("well-formed");
        assert_eq!((outline.root, outline.pieces.len()), ("a", 1));
        // One more for a root element that isn't added; the declaration, a, the comment, t, d and the character data.
        let bytes = parser_bytes(text.as_bytes(), NODES_ANYHOW + 6);
        assert_eq!(outline.piece_bytes, bytes);
    }

    #[test]
    fn long_texts_are_cut_between_children_of_the_root() {
        let children = "<shape a='>'><shape/>\n</shape> text <!-- <shape/> --><shape\n/>\n";
        let count = 3 * PIECE_LENGTH / children.len();
        let text = format!(
            "<?xml version='1.0'?><scene >{}</scene>\n",
            children.repeat(count)
        );
        let outline = Outline::of(&text).expect("well-formed");
        assert_eq!((outline.root, outline.shape_count), ("scene", 2 * count));
        assert_eq!(outline.pieces.len(), 3);
        let mut end = 0;
        for (index, piece) in outline.pieces.iter().enumerate() {
            assert_eq!(piece.start, end);
            assert!(index == 0 || text[..end].ends_with("/>") || text[..end].ends_with("</shape>"));
            assert!(piece.len() < PIECE_LENGTH + children.len());
            let [before, after] = outline.ends(index);
            let document = format!("{before}{}{after}", &text[piece.clone()]);
            roxmltree::Document::parse(&document).expect("well-formed");
            end = piece.end;
        }
        assert_eq!(end, text.len());
        // What has no children isn't cut.
        let long = format!("<scene>{}</scene>", "x".repeat(2 * PIECE_LENGTH));
        assert_eq!(Outline::of(&long).expect("well-formed").pieces.len(), 1);
    }

    #[test]
    fn excessive_texts_are_refused_where_they_become_excessive() {
        let deep = "<a>".repeat(MAX_DEPTH + 1);
        let nested = Some((
            3 * MAX_DEPTH,
            "elements are nested more than 100 deep".to_owned(),
        ));
        assert_eq!(message(&deep), nested);
        assert_eq!(message(&deep[3..]), None);
        let wide = format!("\n<a{}/>", " b=''".repeat(MAX_ATTRIBUTES + 1));
        let many = Some((1, "the element has more than 64 attributes".to_owned()));
        assert_eq!(message(&wide), many);
        assert_eq!(message(&wide.replacen(" b=''", "", 1)), None);
        let space = Some((0, "XML namespaces aren't supported".to_owned()));
        assert_eq!(message("<a xmlns:b='c'/>"), space);
        assert_eq!(message("<a b='xmlns'/>"), None);
        assert!(message(" <!DOCTYPE a>").is_some_and(|(offset, _)| offset == 1));
    }

    #[test]
    fn unfinished_texts_end_the_scan() {
        for text in [
            "<",
            "<!--",
            "<a",
            "<a b",
            "<a b='",
            "<a b='\">",
            "<?",
            "<![CDATA[",
            "</",
        ] {
            assert_eq!(message(text), None, "{text}");
        }
    }
}

//! A scan of XML text before it is parsed, which bounds the parser's time and memory.
//!
//! The parser compares each attribute with all others of its element, and keeps the namespaces of all enclosing
//! elements for each element. Both take quadratic time or memory, so that few attributes are allowed, and namespaces
//! aren't.

use memchr::{memchr, memchr_iter, memchr3, memmem};

/// More than any element of a scene has.
const MAX_ATTRIBUTES: usize = 64;
/// Deeper than any scene, and shallow enough for recursion.
pub(super) const MAX_DEPTH: usize = 100;
/// Sizes of the parser's nodes and attributes. Verified by the test program `scene_file_fuzz`, which measures memory.
const BYTES_PER_NODE: usize = 80;
const BYTES_PER_ATTRIBUTE: usize = 72;

/// What the parser needs for a text. It stops where a text isn't well-formed XML, so that it needs less then.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Outline {
    /// The bytes that the parser takes at most.
    pub bytes: u64,
}

/// Something that isn't allowed, and its offset in the text.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Excess {
    pub offset: usize,
    pub message: String,
}

impl Outline {
    /// # Errors
    /// The text contains a document type declaration, namespaces, too many attributes or too many levels.
    pub(super) fn of(text: &str) -> Result<Self, Excess> {
        let bytes = text.as_bytes();
        let excess = |offset, message: String| Err(Excess { offset, message });
        // The root of the document.
        let mut node_count = 1;
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
                if rest.starts_with(b"</") {
                    depth = depth.saturating_sub(1);
                } else if !tag.is_empty {
                    depth += 1;
                }
                if depth > MAX_DEPTH {
                    let message = format!("elements are nested more than {MAX_DEPTH} deep");
                    return excess(start, message);
                }
                tag.length
            };
            at = start + length;
        }
        Ok(Self {
            bytes: parser_bytes(bytes, node_count),
        })
    }
}

/// The bytes that the parser takes at most for a text with a number of nodes.
///
/// Its lists start with room for as many nodes as there are `<` and for as many attributes as there are `=`. The list
/// of nodes may double once. Finally, both are copied to lists of the right size. Values with references are copied.
fn parser_bytes(text: &[u8], node_count: usize) -> u64 {
    let capacity = memchr_iter(b'<', text).count();
    let attribute_count = memchr_iter(b'=', text).count();
    let node_capacity = if node_count <= capacity {
        capacity
    } else {
        2 * capacity.max(4)
    };
    let nodes = BYTES_PER_NODE * (node_capacity + node_count);
    let attributes = BYTES_PER_ATTRIBUTE * 2 * attribute_count;
    (nodes + attributes + 2 * text.len()) as u64
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
        let bytes = Outline::of(text).map(|outline| outline.bytes);
        // The document, its declaration, a, the comment, t, d and the character data.
        assert_eq!(bytes, Ok(parser_bytes(text.as_bytes(), 7)));
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

//! An XML element with its place, and its attributes with inserted parameters.

use super::defaults::Defaults;
use super::description::Place;
use super::problem::{Problem, quoted, unknown};
use super::text::Lines;
use roxmltree::Node;
use std::borrow::Cow;
use std::path::PathBuf;

/// A file that is being read.
pub(super) struct OpenFile {
    /// Index into the description's list of files.
    pub index: u32,
    /// The folder against which the names in the file are resolved.
    pub folder: PathBuf,
    pub lines: Lines,
    /// The offset in the file of the text that is parsed: a piece of the file after `added` bytes.
    pub offset: usize,
    /// The length of what is added before the piece.
    pub added: usize,
}

/// An element of a file.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    pub node: Node<'a, 'a>,
    pub file: &'a OpenFile,
    /// The start of the element. Finding it takes time, and it is needed often.
    pub place: Place,
}

impl OpenFile {
    /// The place of an offset in the text that is parsed.
    pub(super) fn place_at(&self, offset: usize) -> Place {
        let offset = self.offset + offset.saturating_sub(self.added);
        Place {
            file: self.index,
            line: self.lines.line(offset),
        }
    }
}

impl<'a> Element<'a> {
    pub(super) fn new(node: Node<'a, 'a>, file: &'a OpenFile) -> Self {
        Self {
            node,
            file,
            place: file.place_at(node.range().start),
        }
    }

    /// The first element in this one.
    pub(super) fn first_child(&self) -> Option<Self> {
        let child = self.node.first_element_child()?;
        Some(Self::new(child, self.file))
    }

    /// The element's name.
    pub(super) fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    pub(super) fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::at(self.place, message)
    }

    /// Checks that every attribute is known.
    ///
    /// # Errors
    /// An attribute isn't known.
    pub(super) fn require_known_attributes(&self, known: &[&str]) -> Result<(), Problem> {
        for attribute in self.node.attributes() {
            if !known.contains(&attribute.name()) {
                let what = format!("attribute of <{}>:", self.tag());
                return Err(self.problem(unknown(&what, attribute.name(), known)));
            }
        }
        Ok(())
    }

    /// The value of an attribute, with the values of parameters in place of `$name`.
    ///
    /// # Errors
    /// A parameter isn't defined.
    pub(super) fn attribute(
        &self,
        name: &str,
        defaults: &Defaults,
    ) -> Result<Option<Cow<'a, str>>, Problem> {
        let value = self.node.attribute(name);
        value
            .map(|value| defaults.insert_into(value, self.place))
            .transpose()
    }

    /// Like [`attribute`](Self::attribute).
    ///
    /// # Errors
    /// The attribute is missing, or a parameter isn't defined.
    pub(super) fn required(
        &self,
        name: &str,
        defaults: &Defaults,
    ) -> Result<Cow<'a, str>, Problem> {
        let missing = || {
            self.problem(format!(
                "<{}> has no attribute {}",
                self.tag(),
                quoted(name)
            ))
        };
        self.attribute(name, defaults)?.ok_or_else(missing)
    }
}

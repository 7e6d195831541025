//! Files of a scene: the main one and those that are included.

use super::description::{Place, Shape};
use super::element::{Element, OpenFile};
use super::outline::Outline;
use super::problem::{Problem, quoted};
use super::reader::{Reader, Visit};
use super::text::{Lines, decoded, decoded_bytes};
use crate::obj::{reason, shown};
use roxmltree::{Document, ParsingOptions};
use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

/// As in Mitsuba.
const MAX_INCLUDE_DEPTH: usize = 15;
/// More than any scene has. Bounds the time for files that include others several times.
const MAX_INCLUDE_COUNT: usize = 10_000;

/// The included files.
#[derive(Default)]
pub(super) struct Includes {
    /// The paths of the files that are open, each included by the one before.
    open: Vec<PathBuf>,
    count: usize,
    /// The bytes of all files together.
    bytes: u64,
}

impl<'r> Reader<'r> {
    /// Reads the main file.
    pub(super) fn read_main(&mut self, bytes: &[u8], path: &Path) -> Result<(), Problem> {
        self.read_scene(bytes, path, &mut |reader, element| reader.object(element))
    }

    /// Calls `visit` for the objects of an included file.
    ///
    /// # Errors
    /// The file can't be read, includes itself, or contains an error.
    pub(super) fn include(
        &mut self,
        element: Element,
        visit: Visit<'_, 'r>,
    ) -> Result<(), Problem> {
        element.require_known_attributes(&["filename"])?;
        let name = element.required("filename", &self.defaults)?;
        let path = self.named_file(&name, &element.file.folder, element.place)?;
        self.require_includable(&path, element)?;
        let limit = self.memory.left();
        let read = (self.read_file)(&path, limit);
        let bytes = read.map_err(|error| {
            let reason = reason(&error);
            element.problem(format!("included file {}: {reason}", quoted(&name)))
        })?;
        self.read_scene(&bytes, &path, visit)
    }

    fn require_includable(&mut self, path: &Path, element: Element) -> Result<(), Problem> {
        let path = normal(path);
        let open = &self.includes.open;
        let chain = |from: usize| {
            let paths = open[from..].iter().chain([&path]);
            let shown: Vec<String> = paths.map(|path| shown(path)).collect();
            shown.join(" → ")
        };
        if let Some(first) = open.iter().position(|other| *other == path) {
            return Err(element.problem(format!("the file includes itself: {}", chain(first))));
        }
        if open.len() > MAX_INCLUDE_DEPTH {
            let message = format!("files are included more than {MAX_INCLUDE_DEPTH} deep: ");
            return Err(element.problem(message + &chain(0)));
        }
        self.includes.count += 1;
        if self.includes.count > MAX_INCLUDE_COUNT {
            let message = format!("more than {MAX_INCLUDE_COUNT} files are included");
            return Err(element.problem(message));
        }
        Ok(())
    }

    /// Calls `visit` for the children of a file's `<scene>`.
    fn read_scene(
        &mut self,
        bytes: &[u8],
        path: &Path,
        visit: Visit<'_, 'r>,
    ) -> Result<(), Problem> {
        let index = self.scene.files.len() as u32;
        self.scene.files.push(path.to_owned());
        let start = Place {
            file: index,
            line: 1,
        };
        // In this list, in that of open files, and in the load report.
        let path_bytes = 3 * (2 * size_of::<PathBuf>() + path.as_os_str().len());
        self.memory.take(path_bytes as u64, start)?;
        self.includes.bytes += bytes.len() as u64;
        if self.includes.bytes > self.memory.limit() {
            // Bounds the time for a large file that is included often.
            return Err(self.memory.exceeded(bytes.len() as u64, start));
        }
        let mut held = bytes.len() as u64 + decoded_bytes(bytes);
        self.memory.take(held, start)?;
        let text = decoded(bytes).map_err(|error| {
            let line = error.line;
            Problem::at(Place { file: index, line }, error.message)
        })?;
        self.memory.take(Lines::bytes(&text), start)?;
        held += Lines::bytes(&text);
        let lines = Lines::of(&text);
        let outline = Outline::of(&text).map_err(|excess| {
            let line = lines.line(excess.offset);
            Problem::at(Place { file: index, line }, excess.message)
        })?;
        let shapes = if self.includes.open.is_empty() {
            outline.shape_count
        } else {
            0
        };
        let shape_bytes = (shapes * size_of::<Shape>()) as u64;
        self.memory.take(outline.piece_bytes + shape_bytes, start)?;
        self.scene.shapes.reserve_exact(shapes);
        held += outline.piece_bytes;
        let mut file = OpenFile {
            index,
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            lines,
            offset: 0,
            added: 0,
        };
        self.includes.open.push(normal(path));
        for piece in 0..outline.pieces.len() {
            self.read_piece(&text, (&outline, piece), &mut file, visit)?;
        }
        self.includes.open.pop();
        self.memory.give_back(held);
        Ok(())
    }

    /// Calls `visit` for the children of `<scene>` in a piece of the text.
    fn read_piece(
        &mut self,
        text: &str,
        (outline, index): (&Outline, usize),
        file: &mut OpenFile,
        visit: Visit<'_, 'r>,
    ) -> Result<(), Problem> {
        let piece = outline.pieces[index].clone();
        let [before, after] = outline.ends(index);
        (file.offset, file.added) = (piece.start, before.len());
        let piece = match &outline.pieces[..] {
            [_] => Cow::Borrowed(text),
            _ => Cow::Owned(before + &text[piece] + &after),
        };
        let document = document(&piece).map_err(|error| error.in_file(text, file))?;
        let root = Element::new(document.root_element(), file);
        if index == 0 {
            require_scene(root)?;
        }
        self.each_child(root, visit)
    }
}

/// Why a piece of a file isn't well-formed XML.
struct Malformed {
    /// Row and column in the piece, counted from 1.
    row: u32,
    column: u32,
    message: String,
}

impl Malformed {
    /// The problem in the file with a text.
    fn in_file(self, text: &str, file: &OpenFile) -> Problem {
        let mut column = self.column as usize;
        if self.row == 1 {
            // The piece starts within a line.
            let line = text[..file.offset].rsplit('\n').next();
            column += line.map_or(0, |line| line.chars().count());
            column = column.saturating_sub(file.added).max(1);
        }
        Problem::Line {
            place: Place {
                file: file.index,
                line: self.row + file.lines.line(file.offset) - 1,
            },
            column: Some(column),
            message: self.message,
        }
    }
}

fn document(text: &str) -> Result<Document<'_>, Malformed> {
    let options = ParsingOptions {
        allow_dtd: false,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| {
        let position = error.pos();
        // The position stands before the message.
        let message = error.to_string();
        let message = message.replacen(&format!(" at {position}"), "", 1);
        Malformed {
            row: position.row,
            column: position.col,
            message: shown(Path::new(&message)),
        }
    })
}

/// Checks the root element and its version.
fn require_scene(root: Element) -> Result<(), Problem> {
    if root.tag() != "scene" {
        let tag = quoted(root.tag());
        return Err(root.problem(format!("the root element is {tag}, not “scene”")));
    }
    root.require_known_attributes(&["version"])?;
    let Some(version) = root.node.attribute("version") else {
        return Err(root.problem("<scene> has no attribute “version”, such as “3.0.0”"));
    };
    let parts: Vec<Option<u32>> = version.split('.').map(|part| part.parse().ok()).collect();
    match parts[..] {
        [Some(0 | 1), Some(_), Some(_)] => {
            let version = quoted(version);
            let message =
                format!("version {version} of the format isn't supported: 2.0.0 is the first");
            Err(root.problem(message))
        }
        [Some(_), Some(_), Some(_)] => Ok(()),
        _ => {
            let version = quoted(version);
            Err(root.problem(format!("{version} isn't a version such as “3.0.0”")))
        }
    }
}

/// A path without `.`, and without `..` after another part. Only compares paths: a link may lead elsewhere.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if ends_with_name(&normal) => {
                normal.pop();
            }
            other => normal.push(other),
        }
    }
    normal
}

fn ends_with_name(path: &Path) -> bool {
    matches!(path.components().next_back(), Some(Component::Normal(_)))
}

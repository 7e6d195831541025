//! Reads one face statement of a loaded file again, for the inspector.

use super::chunks::each_statement;
use super::corner::{Corner, Corners, List};
use super::elements::ElementKind;
use super::error::{LoadError, Problem};
use super::keyword::Keyword;
use super::statement::Statement;
use super::tally::shortened_to;
use super::words::{Words, number, text, without_comment};
use crate::progress::Progress;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::io::{self, Read};
use std::ops::ControlFlow;
use std::path::Path;

/// A face as written in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceSource {
    /// The statement's text, shortened if it is long.
    pub statement: String,
    /// The face's corners, in the file's order.
    pub corners: Vec<FaceCorner>,
}

/// A corner of a face in the file. Indices start at 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceCorner {
    /// Index of the `v` statement.
    pub vertex: usize,
    /// Index of the `vt` statement.
    pub texture: Option<usize>,
    /// Index of the `vn` statement.
    pub normal: Option<usize>,
    /// The vertex's coordinates.
    pub position: DVec3,
    /// The texture coordinates; `None` if the corner has no index or the index is out of range.
    pub uv: Option<DVec2>,
}

/// Reads the `f` statement that starts on a line (from 1), and its vertices and texture coordinates.
///
/// `open` opens the file at its start and is called twice. `path` is used in errors. Returns `None` if no face
/// starts on that line or a vertex doesn't exist, because the file has changed since it was loaded.
///
/// # Errors
/// See [`LoadError`].
pub fn face_source<R: Read>(
    open: impl Fn() -> io::Result<R>,
    path: &Path,
    line: usize,
    progress: &Progress,
) -> Result<Option<FaceSource>, LoadError> {
    let read = || {
        let Some(mut source) = statement_on(open().map_err(Problem::Read)?, line, progress)? else {
            return Ok(None);
        };
        let bytes = open().map_err(Problem::Read)?;
        let is_complete = read_coordinates(bytes, &mut source.corners, progress)?;
        Ok(is_complete.then_some(source))
    };
    read().map_err(|problem: Problem| problem.in_file(path))
}

/// The face statement on a line, with the indices of its corners but no coordinates.
fn statement_on(
    bytes: impl Read,
    line: usize,
    progress: &Progress,
) -> Result<Option<FaceSource>, Problem> {
    /// Enough for a polygon of about ten corners.
    const LONGEST_TEXT: usize = 160;
    let (mut counts, mut found) = ([0; 3], None);
    each_statement(bytes, progress, |statement| {
        let (word, after) = statement.keyword().unwrap_or_default();
        let keyword = Keyword::of(word);
        if statement.line == line && keyword == Some(Keyword::Element(ElementKind::Face)) {
            let plain = without_comment(statement.bytes);
            let corners = Corners::of(plain, after);
            let corners = corners.map(|corner| from_one(corner.ok()?, counts));
            found = corners.collect::<Option<_>>().map(|corners| FaceSource {
                statement: shortened_to(LONGEST_TEXT, text(plain).trim()),
                corners,
            });
        }
        if statement.line >= line {
            return Ok(ControlFlow::Break(()));
        }
        if let Some(Keyword::Numbers(list)) = keyword {
            counts[list as usize] += 1;
        }
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(found)
}

/// Converts a corner's indices to indices from 1. Negative indices count back from the last entry read.
fn from_one(corner: Corner, counts: [usize; 3]) -> Option<FaceCorner> {
    let index = |list: List| {
        let written = corner.indices[list as usize]?;
        let from_start = if written < 0 {
            counts[list as usize] as i64 + 1 + written
        } else {
            written
        };
        usize::try_from(from_start).ok().filter(|&index| index > 0)
    };
    Some(FaceCorner {
        vertex: index(List::Vertex)?,
        texture: index(List::Texture),
        normal: index(List::Normal),
        ..FaceCorner::default()
    })
}

/// Reads the coordinates of corners. Returns whether every vertex exists.
fn read_coordinates(
    bytes: impl Read,
    corners: &mut [FaceCorner],
    progress: &Progress,
) -> Result<bool, Problem> {
    let mut vertices: BTreeMap<usize, Option<DVec3>> =
        corners.iter().map(|corner| (corner.vertex, None)).collect();
    let textures = corners.iter().filter_map(|corner| corner.texture);
    let mut uvs: BTreeMap<usize, Option<DVec2>> = textures.map(|index| (index, None)).collect();
    let mut missing = vertices.len() + uvs.len();
    let mut counts = [0; 3];
    each_statement(bytes, progress, |statement| {
        let keyword = statement.keyword().and_then(|(word, _)| Keyword::of(word));
        let Some(Keyword::Numbers(list)) = keyword else {
            return Ok(ControlFlow::Continue(()));
        };
        counts[list as usize] += 1;
        let count = counts[list as usize];
        match list {
            List::Vertex => {
                if let Some(position) = vertices.get_mut(&count) {
                    *position = Some(DVec3::from_array(numbers(&statement)?));
                    missing -= 1;
                }
            }
            List::Texture => {
                if let Some(uv) = uvs.get_mut(&count) {
                    *uv = Some(DVec2::from_array(numbers(&statement)?));
                    missing -= 1;
                }
            }
            List::Normal => {}
        }
        Ok(if missing > 0 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        })
    })?;
    for corner in corners {
        let Some(position) = vertices[&corner.vertex] else {
            return Ok(false);
        };
        corner.position = position;
        corner.uv = corner.texture.and_then(|index| uvs[&index]);
    }
    Ok(true)
}

/// The first numbers of a statement, padded with zeros.
pub(super) fn numbers<const N: usize>(statement: &Statement<'_>) -> Result<[f64; N], Problem> {
    let plain = statement.without_comment();
    let (_, after) = statement.keyword().unwrap_or_default();
    let mut numbers = [0.0; N];
    for (slot, word) in numbers.iter_mut().zip(Words::of(plain.bytes, after)) {
        *slot = number(&plain, word)?;
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0 # here\nvt 0.5 0.25\n\
        f 1/1 2 \\\n3\nV 0 1 0\n  F -4 -2/-1 -1//9 5\nv 7 8 9\n";

    fn source(line: usize) -> Option<FaceSource> {
        let progress = Progress::default();
        face_source(|| Ok(FILE.as_bytes()), Path::new("a.obj"), line, &progress).expect("it parses")
    }

    #[test]
    fn a_face_is_read_with_the_coordinates_of_its_corners() {
        let joined = source(6).expect("a face");
        assert_eq!(joined.statement, "f 1/1 2  3");
        assert_eq!(joined.corners[0].uv, Some(DVec2::new(0.5, 0.25)));
        assert_eq!(joined.corners[1].uv, None);
        let quad = source(9).expect("a face");
        let vertices: Vec<usize> = quad.corners.iter().map(|corner| corner.vertex).collect();
        // Negative indices refer to earlier entries; positive ones may refer to later entries.
        assert_eq!(vertices, [1, 3, 4, 5]);
        assert_eq!(quad.corners[1].position, DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(quad.corners[3].position, DVec3::new(7.0, 8.0, 9.0));
        assert_eq!(
            (quad.corners[1].texture, quad.corners[2].normal),
            (Some(1), Some(9))
        );
    }

    #[test]
    fn a_line_without_a_face_returns_none() {
        for line in [0, 1, 7, 10, 99] {
            assert_eq!(source(line), None, "{line}");
        }
    }
}

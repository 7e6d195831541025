//! Reads one vertex statement of a loaded file again, to go to it.

use super::chunks::each_statement;
use super::corner::List;
use super::error::{LoadError, Problem};
use super::face_source::numbers;
use super::keyword::Keyword;
use crate::progress::Progress;
use glam::DVec3;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::Path;

/// How a vertex of a file is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexKey {
    /// By the number of its `v` statement, counted from 1.
    Number(usize),
    /// By the line on which this statement starts, counted from 1.
    Line(usize),
}

/// A vertex as written in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexSource {
    /// The number of its `v` statement, counted from 1.
    pub number: usize,
    /// The line of the statement, counted from 1.
    pub line: usize,
    /// Its coordinates.
    pub position: DVec3,
}

/// Reads a vertex of a file. `path` is used in errors. Returns `None` if there is no such vertex.
///
/// # Errors
/// See [`LoadError`].
pub fn vertex_source(
    bytes: impl Read,
    path: &Path,
    key: VertexKey,
    progress: &Progress,
) -> Result<Option<VertexSource>, LoadError> {
    let (mut count, mut found) = (0, None);
    let read = each_statement(bytes, progress, |statement| {
        let keyword = statement.keyword().and_then(|(word, _)| Keyword::of(word));
        if keyword == Some(Keyword::Numbers(List::Vertex)) {
            count += 1;
            let is_named = match key {
                VertexKey::Number(number) => number == count,
                VertexKey::Line(line) => line == statement.line,
            };
            if is_named {
                found = Some(VertexSource {
                    number: count,
                    line: statement.line,
                    position: DVec3::from_array(numbers(&statement)?),
                });
            }
        }
        let is_past = matches!(key, VertexKey::Line(line) if statement.line >= line);
        Ok(if is_past || found.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    });
    read.map_err(|problem: Problem| problem.in_file(path))?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_is_found_by_its_number_and_by_its_line() {
        let file = "# two vertices\nv 1 2 3\nvn 0 0 1\n\nV 4 5 6.5 # the second\nf 1 2 1\n";
        let find = |key| {
            let progress = Progress::default();
            vertex_source(file.as_bytes(), Path::new("a.obj"), key, &progress).expect("it parses")
        };
        let second = VertexSource {
            number: 2,
            line: 5,
            position: DVec3::new(4.0, 5.0, 6.5),
        };
        assert_eq!(find(VertexKey::Number(2)), Some(second));
        assert_eq!(find(VertexKey::Line(5)), Some(second));
        for key in [0, 3, 4, 6, 99].map(VertexKey::Line) {
            assert_eq!(find(key), None, "{key:?}");
        }
        assert_eq!(find(VertexKey::Number(0)), None);
        assert_eq!(find(VertexKey::Number(3)), None);
    }
}

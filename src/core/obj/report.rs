//! Warnings, counts and timing of a load.

use super::error::Warning;
use super::steps::LoadSteps;
use super::tally::LineRuns;
use std::path::PathBuf;
use std::time::Duration;

/// Warnings, counts and timing of a load.
#[derive(Clone, Debug, Default)]
pub struct LoadReport {
    /// Warnings about dropped, ignored or unusual parts of the file.
    pub warnings: Vec<Warning>,
    /// Counts of dropped triangles and elements.
    pub dropped: Dropped,
    /// Number of `v` statements in the file.
    pub vertex_count: usize,
    /// Upper bound on the difference between a coordinate of the traced mesh and its decimal in the file, in the file's
    /// units; 0 if no coordinate was rounded.
    pub max_rounding: f64,
    /// The line of each face, indexed like [`TriangleMesh::face_of`](crate::TriangleMesh::face_of).
    pub face_lines: LineRuns,
    /// Paths of the libraries and textures that were looked for, including missing ones.
    pub files: Vec<PathBuf>,
    /// Time for reading, parsing and checking.
    pub duration: Duration,
    /// The duration of each step; empty for scene files.
    pub steps: LoadSteps,
}

/// Counts of the file's triangles and other elements that were dropped, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Triangles whose area is exactly zero after rounding their corners to f32.
    pub zero_area: usize,
    /// Triangles with a corner that is NaN, infinite or too large for f32.
    pub non_finite: usize,
    /// Faces (not triangles) with an invalid index or fewer than three corners.
    pub bad_index: usize,
    /// Lines and points, dropped for any of these reasons.
    pub elements: usize,
}

//! The contents of a chunk.

use super::elements::Elements;
use super::error::Problem;
use super::tally::Tally;
use glam::{DVec3, Vec2, Vec3};
use std::collections::BTreeMap;

/// The contents of a chunk.
#[derive(Default)]
pub(super) struct Part {
    pub positions: Vec<DVec3>,
    pub textures: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// Colours, and the vertices that have them.
    pub colours: Vec<(u32, [f32; 3])>,
    pub elements: Elements,
    /// Names and smoothing groups, each with the index of the first face that it may apply to.
    pub marks: Vec<(u32, Mark)>,
    /// Material libraries, and their lines.
    pub libraries: Vec<(usize, String)>,
    /// Ignored statements by keyword.
    pub ignored: BTreeMap<String, Tally>,
    /// Dropped faces; `dropped_others` counts lines and points.
    pub dropped_faces: Tally,
    pub dropped_others: Tally,
    /// Indices of texture coordinates and normals that were ignored, by list.
    pub bad_indices: [Tally; 3],
    /// The error about the first of them: it matters if the file has such a list and is read strictly.
    pub bad_index: [Option<Problem>; 3],
    /// Whether a vertex coordinate may have more than 15 digits.
    pub has_long_numbers: bool,
    /// The error at which reading stopped.
    pub problem: Option<Problem>,
    /// Whether the chunk must be read again with the number of entries before it.
    pub needs_counts: bool,
}

/// A statement that applies to the faces after it.
pub(super) enum Mark {
    Material(String),
    Group(String),
    Smoothing(u32),
}

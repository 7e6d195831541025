//! The contents of a chunk.

use super::elements::Elements;
use super::error::Problem;
use super::skipped::Skipped;
use glam::{DVec3, Vec2, Vec3};

/// The contents of a chunk.
#[derive(Default)]
pub(super) struct ChunkContents {
    pub positions: Vec<DVec3>,
    pub textures: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// Colours, and the vertices that have them.
    pub colours: Vec<(u32, [f32; 3])>,
    pub elements: Elements,
    /// Names and smoothing groups, each with the index of the first face that it may apply to.
    pub state_changes: Vec<(u32, StateChange)>,
    /// Material libraries, and their lines.
    pub libraries: Vec<(usize, String)>,
    pub skipped: Skipped,
    /// Whether a vertex coordinate may have more than 15 digits.
    pub has_long_numbers: bool,
    /// The error at which reading stopped.
    pub problem: Option<Problem>,
    /// Whether the chunk must be read again with the number of entries before it.
    pub needs_counts: bool,
}

/// A statement that applies to the faces after it.
pub(super) enum StateChange {
    Material(String),
    Group(String),
    Smoothing(u32),
}

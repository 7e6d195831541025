//! Estimates the memory that loading takes, from what has been read so far.
//!
//! Three phases use most. Their lists don't exist at the same time:
//!
//! | phase | lists |
//! |---|---|
//! | reading | the file's numbers, positions in f64, and the elements' indices |
//! | assembling | the same, and the mesh, part of it twice |
//! | building the tree | the mesh, the tree, and the builder's lists |
//!
//! A growing list is copied to one of twice the capacity, of which only the used part takes memory; only one
//! list grows at a time.

use super::contents::Contents;
use super::corner::List;
use super::polygon;
use crate::bvh;
use glam::{DVec3, Vec2, Vec3};

/// Bytes of an entry of each list in the file's contents.
const IN_FILE: [usize; 3] = [size_of::<DVec3>(), size_of::<Vec2>(), size_of::<Vec3>()];
/// The same in a mesh.
const IN_MESH: [usize; 3] = [size_of::<Vec3>(), size_of::<Vec2>(), size_of::<Vec3>()];
/// Per triangle: indices, face and outline.
const TRIANGLE: usize = 12 + 4 + 1;
/// Per triangle: the indices of its corners' normals, or of their texture coordinates.
const CORNERS: usize = 12;
/// Memory per corner for triangulating a large polygon (measured 2026-11).
const POLYGON_CORNER: usize = 300;

/// Upper bound on the bytes that loading takes, if the file ended here.
pub(super) fn bytes(contents: &Contents) -> usize {
    let counts = contents.counts();
    let has = |list: List| {
        let is_used = |corners: &Vec<u32>| !corners.is_empty();
        let of_parts = contents.elements.iter();
        usize::from(
            of_parts
                .map(|part| &part.corners[list as usize])
                .any(is_used),
        )
    };
    let (textures, normals) = (has(List::Texture), has(List::Normal));
    let corners = size_of::<u32>() * contents.corner_count * (1 + textures + normals);
    let colours = size_of::<Vec3>() * contents.colours.len();
    let file = per_entry(counts, IN_FILE) + corners + colours;
    let triangles = (TRIANGLE + CORNERS * (textures + normals)) * contents.triangle_count;
    let mesh = per_entry(counts, IN_MESH) + colours + triangles;
    let polygon = POLYGON_CORNER * contents.largest_element.min(polygon::LARGEST);
    let assembling = file + mesh + polygon;
    let building = mesh + bvh::BYTES_WHILE_BUILDING * contents.triangle_count;
    assembling.max(building) + contents.other_bytes
}

fn per_entry(counts: [usize; 3], sizes: [usize; 3]) -> usize {
    counts.iter().zip(sizes).map(|(n, size)| n * size).sum()
}

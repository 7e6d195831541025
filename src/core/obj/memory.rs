//! Estimates the memory that loading takes, from what has been read so far.
//!
//! Three phases use most. Their lists don't exist at the same time:
//!
//! | phase | lists |
//! |---|---|
//! | reading | the file's numbers, positions in f64 (twice while they are joined), and the elements' indices |
//! | assembling | the same, and the mesh |
//! | building the tree | the mesh, the tree, and the builder's lists |
//!
//! A growing list has up to twice the capacity that it needs, of which only the used part takes memory.

use super::contents::Contents;
use crate::bvh;
use crate::polygon;
use glam::{DVec3, Vec2, Vec3};

/// Bytes of an entry of each list in the file's contents.
const IN_FILE: [usize; 3] = [size_of::<DVec3>(), size_of::<Vec2>(), size_of::<Vec3>()];
/// The same in a mesh.
const IN_MESH: [usize; 3] = [size_of::<Vec3>(), size_of::<Vec2>(), size_of::<Vec3>()];
/// Per triangle: its indices; and its face and outline, if polygons are among the elements. Faces are also listed after a
/// dropped triangle.
const BYTES_PER_TRIANGLE: usize = 12;
const BYTES_PER_POLYGON_TRIANGLE: usize = 4 + 1;
/// Per triangle: the indices of its corners' normals, or of their texture coordinates.
const BYTES_PER_CORNER_LIST: usize = 12;
/// Per corner of the largest polygon: its positions, in f64 and f32, and its vertex twice.
const BYTES_PER_OUTLINE_CORNER: usize = size_of::<DVec3>() + size_of::<Vec3>() + 8;
/// Flag and new index of each entry of a list, while entries that aren't used are removed.
const BYTES_PER_FLAG: usize = 1 + 4;

/// Upper bound on the bytes that loading takes, if the file ended here, besides the chunks that are being read.
pub(super) fn bytes(contents: &Contents) -> u64 {
    let counts = contents.counts().map(|count| count as u64);
    let [_, textures, normals] = contents.has_indices.map(u64::from);
    let corners = 4 * contents.corner_count as u64 * (1 + textures + normals);
    let colours = match contents.colours.len() {
        0 => 0,
        // Vertices without a colour get one.
        _ => size_of::<Vec3>() as u64 * counts[0],
    };
    let file = per_entry(counts, IN_FILE) + corners + colours;
    let of_polygon = if contents.has_polygons {
        BYTES_PER_POLYGON_TRIANGLE
    } else {
        0
    };
    let of_triangle = (BYTES_PER_TRIANGLE + of_polygon) as u64
        + BYTES_PER_CORNER_LIST as u64 * (textures + normals);
    let triangle_count = contents.triangle_count as u64;
    let mesh = per_entry(counts, IN_MESH) + colours + of_triangle * triangle_count;
    let polygon = contents.largest_element.min(polygon::LARGEST);
    let assembling = file
        + mesh
        + per_entry(counts, [BYTES_PER_FLAG; 3])
        + (polygon::BYTES_PER_CORNER * polygon) as u64
        + (BYTES_PER_OUTLINE_CORNER * contents.largest_element) as u64;
    let building = mesh + bvh::BYTES_WHILE_BUILDING as u64 * triangle_count;
    let joining = file + per_entry(counts, IN_FILE);
    joining.max(assembling).max(building) + contents.other_bytes as u64
}

fn per_entry(counts: [u64; 3], sizes: [usize; 3]) -> u64 {
    counts
        .iter()
        .zip(sizes)
        .map(|(n, size)| n * size as u64)
        .sum()
}

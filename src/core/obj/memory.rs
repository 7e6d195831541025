//! Estimates the memory that loading takes, from what has been read so far.
//!
//! Three phases use most. Their lists don't exist at the same time:
//!
//! | phase | lists |
//! |---|---|
//! | reading | tobj's numbers in f64, its copies of them for each list of faces, indices in tobj and in `Facts` |
//! | assembling | the file's numbers in f64 and its indices, the mesh |
//! | building the tree | the mesh, the tree, and the builder's lists |
//!
//! A growing list is copied to one of twice the capacity, of which only the used part takes memory; only one
//! list grows at a time.

use super::corner::List;
use super::facts::Facts;
use super::polygon;
use crate::bvh;

/// tobj's bytes per entry of each list: three numbers in f64, two for texture coordinates.
const IN_F64: [usize; 3] = [24, 16, 24];
/// The same in f32, as in a mesh.
const IN_F32: [usize; 3] = [12, 8, 12];
/// An index.
const INDEX: usize = 4;
/// A colour in f32.
const COLOUR: usize = 12;
/// Per triangle: indices, face and outline.
const TRIANGLE: usize = 12 + 4 + 1;
/// Per triangle: the indices of its corners' normals, or of their texture coordinates.
const CORNERS: usize = 12;
/// tobj's `Face`, and a corner of it if there are more than four; lists may have twice the capacity.
const PENDING_FACE: usize = 2 * 104;
const PENDING_CORNER: usize = 2 * 24;
/// Memory per corner for triangulating a large polygon (measured 2026-11).
const POLYGON_CORNER: usize = 300;

impl Facts {
    /// Upper bound on the bytes that loading takes, if the file ended here.
    pub(super) fn bytes(&mut self) -> usize {
        self.copies.look_at(&self.corners);
        let phases = [self.reading(), self.assembling(), self.mesh() + self.tree()];
        let most = phases.into_iter().max().unwrap_or_default();
        most + self.largest_list() + self.names()
    }

    fn reading(&self) -> usize {
        let copies = self.copies.counts(&self.corners);
        let corners: usize = self.corners.iter().map(Vec::len).sum();
        let pending_corners = self.corners[0].len().saturating_sub(self.copies.corners[0]);
        per_entry(self.counts, IN_F64)
            + per_entry(copies, IN_F64)
            + 2 * INDEX * corners
            + self.arities()
            + COLOUR * self.colours.len()
            + PENDING_FACE * self.elements_since_cut()
            + PENDING_CORNER * pending_corners
    }

    fn assembling(&self) -> usize {
        let corners: usize = self.corners.iter().map(Vec::len).sum();
        let polygon = self.largest_face.min(polygon::LARGEST);
        IN_F64[0] * self.counts[0]
            + INDEX * corners
            + self.arities()
            + self.mesh()
            + POLYGON_CORNER * polygon
    }

    fn mesh(&self) -> usize {
        let has = |list: List| usize::from(!self.corners[list as usize].is_empty());
        let of_triangle = TRIANGLE + CORNERS * (has(List::Texture) + has(List::Normal));
        let used = List::ALL.map(|list| match list {
            List::Vertex => self.counts[0],
            _ => self.counts[list as usize] * has(list),
        });
        per_entry(used, IN_F32) + COLOUR * self.colours.len() + of_triangle * self.triangle_count()
    }

    fn tree(&self) -> usize {
        bvh::BYTES_WHILE_BUILDING * self.triangle_count()
    }

    /// Memory for the elements' corner counts, unless all are triangles.
    fn arities(&self) -> usize {
        if self.corners[0].len() == 3 * self.element_count {
            0
        } else {
            INDEX * self.element_count
        }
    }

    fn largest_list(&self) -> usize {
        let entries = self.counts.iter().zip(IN_F64).map(|(n, size)| n * size);
        let corners = self.corners[0].len() * INDEX;
        let triangles = self.triangle_count() * CORNERS;
        entries
            .chain([corners, triangles])
            .max()
            .unwrap_or_default()
    }

    fn names(&self) -> usize {
        let runs = 16 * (self.smoothing.capacity() + self.non_faces.capacity());
        let names = self.materials.bytes() + self.groups.bytes() + self.libraries.bytes();
        names + runs + self.face_lines.bytes()
    }
}

fn per_entry(counts: [usize; 3], sizes: [usize; 3]) -> usize {
    counts.iter().zip(sizes).map(|(n, size)| n * size).sum()
}

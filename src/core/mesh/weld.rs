//! Vertex welding: vertices at the same position count as one.

use super::TriangleMesh;
use glam::Vec3;
use rayon::prelude::*;

/// Maps vertices at exactly the same position to one of them, so that seams don't divide the surface.
#[derive(Clone, Debug)]
pub(super) struct Welded {
    /// For each vertex, the first one at its position.
    first: Vec<u32>,
}

impl Welded {
    /// Welds the vertices of a mesh. Positions are compared bit by bit, except that −0 equals 0.
    pub(super) fn of(mesh: &TriangleMesh) -> Self {
        let place = |(vertex, &p): (usize, &Vec3)| (bits(p), vertex as u32);
        let mut order: Vec<([u32; 3], u32)> =
            mesh.positions.par_iter().enumerate().map(place).collect();
        order.par_sort_unstable();
        let mut first = vec![0; order.len()];
        for same in order.chunk_by(|a, b| a.0 == b.0) {
            for &(_, vertex) in same {
                first[vertex as usize] = same[0].1;
            }
        }
        Self { first }
    }

    /// The vertex that represents all vertices at this vertex's position.
    pub(super) fn vertex(&self, vertex: u32) -> u32 {
        self.first[vertex as usize]
    }

    /// A triangle's corners as representative vertices.
    pub(super) fn corners(&self, triangle: [u32; 3]) -> [u32; 3] {
        triangle.map(|vertex| self.vertex(vertex))
    }
}

/// The bits of a position, with −0 replaced by 0.
fn bits(p: Vec3) -> [u32; 3] {
    (p + Vec3::ZERO).to_array().map(f32::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_vertices_at_equal_positions_are_welded() {
        let next = f32::from_bits(1.0f32.to_bits() + 1);
        let points = [0.0, 1.0, -0.0, next, 1.0];
        let positions = points.map(|x| Vec3::new(x, 0.0, 2.0)).to_vec();
        let mesh = TriangleMesh::new(positions, Vec::new());
        let welded = Welded::of(&mesh);
        let first: Vec<u32> = (0..5).map(|vertex| welded.vertex(vertex)).collect();
        assert_eq!(first, [0, 1, 0, 3, 1]);
        assert_eq!(welded.corners([4, 2, 3]), [1, 0, 3]);
    }
}

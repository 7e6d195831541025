//! The outline of a triangulated polygon: its edges, without diagonals and bridges to holes.

/// The bridges of a polygon, to tell its edges from diagonals and bridges to holes.
///
/// ```text
///   4───────────3
///   │   6───7   │    a hole is written as a detour along a bridge, here from 1 to 5 and back:
///   │   │   │   │    1 2 3 4 1 5 6 7 8 5
///   │   5───8   │
///   │ ╱         │
///   1───────────2
/// ```
#[derive(Default)]
pub(crate) struct Outline {
    /// The polygon's vertices, sorted to find repeated ones.
    sorted: Vec<u32>,
    /// Edges that the polygon traverses in both directions, lower vertex first, sorted.
    bridges: Vec<[u32; 2]>,
}

impl Outline {
    /// Finds the bridges of a polygon.
    pub(crate) fn prepare(&mut self, vertices: &[u32]) {
        /// Minimum number of corners of a polygon with a hole: three for the polygon, three for the hole, and one more
        /// for each end of the bridge.
        const MIN_CORNERS: usize = 8;
        self.bridges.clear();
        if vertices.len() < MIN_CORNERS {
            return;
        }
        self.sorted.clear();
        self.sorted.extend(vertices);
        self.sorted.sort_unstable();
        if self.sorted.windows(2).all(|pair| pair[0] != pair[1]) {
            return;
        }
        let count = vertices.len();
        let edge = |k: usize| [vertices[k], vertices[(k + 1) % count]];
        let mut edges: Vec<[u32; 2]> = (0..count).map(edge).collect();
        edges.sort_unstable();
        let is_bridge = |[a, b]: &[u32; 2]| a < b && edges.binary_search(&[*b, *a]).is_ok();
        self.bridges
            .extend(edges.iter().filter(|edge| is_bridge(edge)));
    }

    /// The polygon edges of a triangle: bit k is set if its edge from corner k to the next corner is an edge of the
    /// polygon. `local` holds the triangle's corners as indices into the polygon's `vertices`.
    pub(crate) fn of(&self, local: [usize; 3], vertices: &[u32]) -> u8 {
        let count = vertices.len();
        let is_edge = |k: usize| {
            let (from, to) = (local[k], local[(k + 1) % 3]);
            let is_neighbour = (from + 1) % count == to || (to + 1) % count == from;
            let [a, b] = [vertices[from], vertices[to]];
            is_neighbour && self.bridges.binary_search(&[a.min(b), a.max(b)]).is_err()
        };
        (0..3).fold(0, |bits, k| bits | u8::from(is_edge(k)) << k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonals_and_bridges_are_not_edges() {
        let mut outline = Outline::default();
        let quad = [7, 8, 9, 10];
        outline.prepare(&quad);
        assert_eq!(outline.of([0, 1, 2], &quad), 0b011);
        assert_eq!(outline.of([0, 2, 3], &quad), 0b110);
        let frame = [1, 2, 3, 4, 1, 5, 6, 7, 8, 5];
        outline.prepare(&frame);
        // Vertices 1 2 8: 2–8 and 8–1 are diagonals.
        assert_eq!(outline.of([0, 1, 8], &frame), 0b001);
        // Vertices 4 1 5: 1–5 is the bridge.
        assert_eq!(outline.of([3, 4, 5], &frame), 0b001);
        outline.prepare(&quad);
        assert_eq!(outline.of([3, 0, 1], &quad), 0b011);
    }
}

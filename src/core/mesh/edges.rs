//! Mesh adjacency: the triangles at each edge, and the fans of corners around each vertex.

use super::{TriangleMesh, Welded};
use rayon::prelude::*;

/// One triangle's use of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeUse {
    /// The edge's end vertices, lower index first.
    pub ends: [u32; 2],
    /// The triangle, and its corner from which the edge leads to the next corner.
    pub triangle: u32,
    pub corner: u8,
    /// Whether the triangle traverses the edge from the lower to the higher vertex index.
    pub is_forward: bool,
}

/// All edge uses of a mesh, sorted by edge.
pub(crate) struct EdgeTable {
    uses: Vec<EdgeUse>,
}

impl EdgeTable {
    /// Builds the table with the vertices at each position as one.
    pub(crate) fn welded(mesh: &TriangleMesh, welded: &Welded) -> Self {
        Self::of(mesh, |vertex| welded.vertex(vertex))
    }

    /// Builds the table. `vertex` maps each vertex to its representative, such as the first one at its position.
    pub(crate) fn of(mesh: &TriangleMesh, vertex: impl Fn(u32) -> u32 + Sync) -> Self {
        let of_triangle = |(triangle, corners): (usize, &[u32; 3])| {
            let ends = corners.map(&vertex);
            [0, 1, 2].map(|k| {
                let (from, to) = (ends[k], ends[(k + 1) % 3]);
                EdgeUse {
                    ends: [from.min(to), from.max(to)],
                    triangle: triangle as u32,
                    corner: k as u8,
                    is_forward: from < to,
                }
            })
        };
        let triangles = mesh.triangles.par_iter().enumerate();
        let mut uses: Vec<EdgeUse> = triangles.flat_map_iter(of_triangle).collect();
        uses.par_sort_unstable();
        Self { uses }
    }

    /// The uses of each edge.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[EdgeUse]> {
        self.uses.chunk_by(|a, b| a.ends == b.ends)
    }
}

impl EdgeUse {
    /// The triangle's corners at the lower and higher end, numbered as in [`VertexFans`].
    fn corners(&self) -> [u32; 2] {
        let k = u32::from(self.corner);
        let [from, to] = [k, (k + 1) % 3].map(|k| 3 * self.triangle + k);
        if self.is_forward {
            [from, to]
        } else {
            [to, from]
        }
    }
}

/// Disjoint sets of corners around vertices, joined across edges. Corner k of triangle t is number 3·t + k.
///
/// Source: Tarjan, "Efficiency of a Good But Not Linear Set Union Algorithm", JACM 22(2), 1975.
pub(crate) struct VertexFans {
    parent: Vec<u32>,
}

impl VertexFans {
    /// Builds the sets. Two consecutive uses of an edge are connected if `is_joined` holds for them.
    pub(crate) fn of(
        mesh: &TriangleMesh,
        edges: &EdgeTable,
        is_joined: impl Fn(&EdgeUse, &EdgeUse) -> bool,
    ) -> Self {
        let count = 3 * mesh.triangles.len() as u32;
        let mut fans = Self {
            parent: (0..count).collect(),
        };
        for uses in edges.iter() {
            for pair in uses.windows(2) {
                if is_joined(&pair[0], &pair[1]) {
                    let (a, b) = (pair[0].corners(), pair[1].corners());
                    fans.join(a[0], b[0]);
                    fans.join(a[1], b[1]);
                }
            }
        }
        fans
    }

    /// The representative of a corner's set.
    pub(crate) fn find(&mut self, mut corner: u32) -> u32 {
        while self.parent[corner as usize] != corner {
            let above = self.parent[self.parent[corner as usize] as usize];
            self.parent[corner as usize] = above;
            corner = above;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

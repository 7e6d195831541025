//! Is a mesh healthy: closed, manifold, consistently wound, free of slivers?

use super::{TriangleMesh, place};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// A triangle whose longest edge is more than this many times its height is counted as a sliver: from
/// there on f32 kernels decide some rays wrongly, so the count is a warning.
pub const SLIVER_ASPECT: f64 = 1e3;

/// What is unusual about a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Health {
    /// Edges with one triangle: the mesh has a border there.
    pub open_edges: usize,
    /// Edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Edges whose two triangles run along them in the same direction: one of them is flipped.
    pub flipped_edges: usize,
    /// Triangles more than [`SLIVER_ASPECT`] times longer than high.
    pub slivers: usize,
    /// The largest ratio of longest edge to height.
    pub max_aspect: f64,
}

impl Health {
    /// Looks at every triangle and every edge. Edges count as shared if their ends are at the same
    /// place, whether or not they are the same vertices.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let mut health = Self::default();
        for triangle in 0..mesh.triangles.len() as u32 {
            let aspect = aspect(mesh.corners(triangle));
            health.slivers += usize::from(aspect > SLIVER_ASPECT);
            health.max_aspect = health.max_aspect.max(aspect);
        }
        for EdgeUse { forward, backward } in edge_uses(mesh).into_values() {
            match forward + backward {
                1 => health.open_edges += 1,
                2 => health.flipped_edges += usize::from(forward != backward),
                _ => health.non_manifold_edges += 1,
            }
        }
        health
    }
}

/// How many triangles run along an edge in either direction.
#[derive(Default)]
struct EdgeUse {
    forward: u32,
    backward: u32,
}

fn edge_uses(mesh: &TriangleMesh) -> HashMap<[[u32; 3]; 2], EdgeUse> {
    let mut edges: HashMap<_, EdgeUse> = HashMap::with_capacity(mesh.triangles.len() * 3 / 2);
    for triangle in 0..mesh.triangles.len() as u32 {
        let corners = mesh.corners(triangle).map(place);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            if from < to {
                edges.entry([from, to]).or_default().forward += 1;
            } else {
                edges.entry([to, from]).or_default().backward += 1;
            }
        }
    }
    edges
}

/// Longest edge over the height on it; infinite where f64 finds no height.
fn aspect(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let longest = [b - a, c - b, a - c]
        .map(DVec3::length_squared)
        .into_iter()
        .fold(0.0, f64::max);
    longest / (b - a).cross(c - a).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> TriangleMesh {
        TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            ..TriangleMesh::default()
        }
    }

    #[test]
    fn a_closed_mesh_is_healthy() {
        let health = Health::of(&tetrahedron());
        assert_eq!(
            (
                health.open_edges,
                health.non_manifold_edges,
                health.flipped_edges,
                health.slivers
            ),
            (0, 0, 0, 0)
        );
    }

    #[test]
    fn what_is_wrong_is_counted() {
        let mut mesh = tetrahedron();
        mesh.triangles.truncate(3);
        assert_eq!(Health::of(&mesh).open_edges, 3);
        mesh.triangles.extend([[1, 3, 2], [1, 2, 3]]);
        let health = Health::of(&mesh);
        assert_eq!(health.non_manifold_edges, 3);
        let mut mesh = tetrahedron();
        mesh.triangles[3] = [1, 3, 2];
        assert_eq!(Health::of(&mesh).flipped_edges, 3);
        mesh.positions[3] = Vec3::new(0.5, 0.5, 1e-4);
        assert!(Health::of(&mesh).slivers > 0);
    }
}

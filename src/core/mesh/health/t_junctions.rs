//! T-junctions: border vertices in the interior of another border edge.

use crate::mesh::TriangleMesh;
use glam::DVec3;

/// Limit on the number of edge–vertex pairs to check: about 0.2 s (2026-11).
const MAX_PAIRS: usize = 20_000_000;

/// The vertices of open edges that lie in the interior of another open edge, within f32 accuracy. `None` if there are
/// more than [`MAX_PAIRS`] pairs to check.
pub(super) fn find(mesh: &TriangleMesh, open: &[[u32; 2]]) -> Option<Vec<u32>> {
    let at = |vertex: u32| mesh.positions[vertex as usize].as_dvec3();
    let axis = longest_axis(open.iter().flatten().map(|&vertex| at(vertex)));

    // Sort vertices along the axis of their largest extent.
    let mut vertices: Vec<u32> = open.as_flattened().to_vec();
    let along = |vertex: &u32| at(*vertex)[axis];
    vertices.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
    vertices.dedup();

    let mut found = Vec::new();
    let mut pairs = 0;
    for edge in open {
        let (a, b) = (at(edge[0]), at(edge[1]));
        let slack = slack(a, b);
        let low = a[axis].min(b[axis]) - slack;
        let high = a[axis].max(b[axis]) + slack;
        let first = vertices.partition_point(|vertex| along(vertex) < low);
        let nearby = vertices[first..]
            .iter()
            .take_while(|vertex| along(vertex) <= high);
        for &vertex in nearby {
            pairs += 1;
            if pairs > MAX_PAIRS {
                return None;
            }
            if !edge.contains(&vertex) && is_inside(at(vertex), a, b, slack) {
                found.push(vertex);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    Some(found)
}

/// Largest distance from an edge at which a vertex counts as on it. The coordinates of the vertex and of the edge's
/// ends are each off by at most half an ulp, 2⁻²⁴ of the largest one; 2·√3 times that is less than 2⁻²².
fn slack(a: DVec3, b: DVec3) -> f64 {
    a.abs().max(b.abs()).max_element() * 2f64.powi(-22)
}

/// Whether p is within `slack` of the edge from a to b, and farther than that from its ends.
fn is_inside(p: DVec3, a: DVec3, b: DVec3, slack: f64) -> bool {
    let (edge, to_p) = (b - a, p - a);
    let along = to_p.dot(edge) / edge.length_squared();
    let distance = (to_p - along * edge).length();
    let length = edge.length();
    distance <= slack && along * length > slack && (1.0 - along) * length > slack
}

/// The axis along which the points' bounding box is longest.
fn longest_axis(points: impl Iterator<Item = DVec3>) -> usize {
    let (min, max) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    (max - min).max_position()
}

//! Marks at the file's lines and points, and at flaws.

use super::wireframe;
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::mesh::{Flaw, FlawLocations, Health};
use hitscope_core::{Scene, TriangleMesh};

/// Half the length of a cross, as a fraction of the scene's radius: some 5 pixels if the whole scene is in view.
const CROSS: f32 = 0.008;

/// The file's lines (`l`), and crosses at its points (`p`).
pub fn elements(scene: &Scene) -> Vec<Line> {
    let mesh = scene.mesh();
    let lines = mesh
        .attributes()
        .lines
        .iter()
        .map(|&ends| between(mesh, ends));
    let points = mesh
        .attributes()
        .points
        .iter()
        .flat_map(|&vertex| cross(scene, vertex));
    lines.chain(points).collect()
}

/// Marks at all flaws of a kind: edges, outlines of triangles, or crosses at vertices.
pub fn flaws(scene: &Scene, health: &Health, flaw: Flaw) -> Vec<Line> {
    let mesh = scene.mesh();
    match health.places(flaw) {
        FlawLocations::Edges(edges) => edges.iter().map(|&ends| between(mesh, ends)).collect(),
        FlawLocations::Triangles(triangles) => triangles
            .iter()
            .flat_map(|&triangle| wireframe::triangle_lines(mesh, triangle))
            .collect(),
        FlawLocations::Vertices(vertices) => vertices
            .iter()
            .flat_map(|&vertex| cross(scene, vertex))
            .collect(),
        FlawLocations::Unknown => Vec::new(),
    }
}

fn between(mesh: &TriangleMesh, ends: [u32; 2]) -> Line {
    let [start, end] = ends.map(|vertex| mesh.positions()[vertex as usize]);
    Line {
        start,
        end,
        gap: Vec3::ZERO,
    }
}

fn cross(scene: &Scene, vertex: u32) -> [Line; 3] {
    let at = scene.mesh().positions()[vertex as usize];
    let arm = CROSS * scene.bounds_with_elements().radius() as f32;
    [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| Line {
        start: at - arm * axis,
        end: at + arm * axis,
        gap: Vec3::ZERO,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::TriangleMesh;
    use hitscope_core::mesh::Attributes;
    use hitscope_core::scene::scene;

    #[test]
    fn lines_and_points_of_the_file_and_open_edges_are_marked() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let triangle = TriangleMesh::new(corners, vec![[0, 1, 2]]);
        let scene = scene(triangle.with_attributes(Attributes {
            lines: vec![[0, 2]],
            points: vec![1],
            ..Attributes::default()
        }));
        let lines = elements(&scene);
        assert_eq!(lines.len(), 4);
        assert_eq!((lines[0].start, lines[0].end), (Vec3::ZERO, Vec3::Y));
        assert_eq!(0.5 * (lines[1].start + lines[1].end), Vec3::X);
        let health = Health::of(scene.mesh());
        assert_eq!(flaws(&scene, &health, Flaw::OpenEdge).len(), 3);
        assert_eq!(flaws(&scene, &health, Flaw::Sliver), []);
    }
}

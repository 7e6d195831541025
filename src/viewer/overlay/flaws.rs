//! Marks at the flaws of the selected kind.

use super::elements::{between, cross};
use super::gather::{Gather, Same};
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use super::wireframe;
use crate::gpu::lines::Line;
use hitscope_core::Scene;
use hitscope_core::mesh::{Flaw, FlawLocations, Health};

/// The overlay.
pub static FLAWS: OverlaySpec = OverlaySpec {
    name: "flaws",
    title: "Flaws",
    about: "The flaws of the kind that is selected in the Mesh tab",
    style: OverlayStyle {
        colour: [242, 38, 51],
        opacity: 1.0,
        width_px: 2.6,
    },
    lines: &[LineSpec {
        behind: Behind::Faint,
        ..LineSpec::new(|input, _| {
            let (flaw, health) = input.marks.flaw.clone()?;
            let gather = Gather::new((flaw, Same(health)), |scene, (flaw, health)| {
                lines(scene, &health.0, *flaw)
            });
            Some(gather)
        })
    }],
    ..OverlaySpec::MARK
};

/// Marks at all flaws of a kind: edges, outlines of triangles, or crosses at vertices.
pub fn lines(scene: &Scene, health: &Health, flaw: Flaw) -> Vec<Line> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::scene::scene;

    #[test]
    fn open_edges_are_marked() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let scene = scene(TriangleMesh::new(corners, vec![[0, 1, 2]]));
        let health = Health::of(scene.mesh());
        assert_eq!(lines(&scene, &health, Flaw::OpenEdge).len(), 3);
        assert_eq!(lines(&scene, &health, Flaw::Sliver), []);
    }
}

//! The file's lines and points, which rays don't hit.

use super::gather::Gather;
use super::spec::{LineSpec, OverlaySpec, OverlayStyle, Trigger};
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::{Scene, TriangleMesh};

/// The overlay.
pub static ELEMENTS: OverlaySpec = OverlaySpec {
    name: "elements",
    title: "Lines and points",
    about: "The lines and points of the file",
    trigger: Trigger::Switch { is_on: true },
    style: OverlayStyle {
        colour: [26, 191, 158],
        opacity: 0.95,
        width_px: 1.6,
    },
    lines: &[LineSpec::new(|input, _| {
        let gather = Gather::new((), |scene, ()| lines(scene));
        input.scene.mesh().has_lines_or_points().then_some(gather)
    })],
    ..OverlaySpec::SWITCH
};

/// Half the length of a cross, as a fraction of the scene's radius: some 5 pixels if the whole scene is in view.
const CROSS: f32 = 0.008;

/// The file's lines (`l`), and crosses at its points (`p`).
pub fn lines(scene: &Scene) -> Vec<Line> {
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

/// A line between two vertices.
pub(super) fn between(mesh: &TriangleMesh, ends: [u32; 2]) -> Line {
    let [start, end] = ends.map(|vertex| mesh.positions()[vertex as usize]);
    Line::between(start, end)
}

/// A cross at a vertex.
pub(super) fn cross(scene: &Scene, vertex: u32) -> [Line; 3] {
    let at = scene.mesh().positions()[vertex as usize];
    let arm = CROSS * scene.bounds_with_elements().radius() as f32;
    [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| Line::between(at - arm * axis, at + arm * axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::mesh::Attributes;
    use hitscope_core::scene::scene;

    #[test]
    fn lines_and_points_of_the_file_are_drawn() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let triangle = TriangleMesh::new(corners, vec![[0, 1, 2]]);
        let scene = scene(triangle.with_attributes(Attributes {
            lines: vec![[0, 2]],
            points: vec![1],
            ..Attributes::default()
        }));
        let lines = lines(&scene);
        assert_eq!(lines.len(), 4);
        assert_eq!((lines[0].start, lines[0].end), (Vec3::ZERO, Vec3::Y));
        assert_eq!(0.5 * (lines[1].start + lines[1].end), Vec3::X);
    }
}

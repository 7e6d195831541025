//! The normals of vertices, which smooth shading interpolates, and of other shapes.

use super::gather::Gather;
use super::normals::{LENGTH, line};
use super::shape_normals::NORMALS_OF_SHAPES;
use super::spec::{Fade, LineSpec, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::Scene;

/// The overlay.
pub static VERTEX_NORMALS: OverlaySpec = OverlaySpec {
    name: "vertex-normals",
    title: "Vertex normals",
    about: "The normals that smooth shading interpolates, and those of other shapes",
    style: OverlayStyle {
        colour: [214, 100, 220],
        opacity: 0.8,
        width_px: 1.0,
    },
    options: &[&LENGTH],
    lines: &[
        LineSpec {
            fade: Fade::ShortOrDense,
            length: Some(&LENGTH),
            // Normals differ at creases.
            ..LineSpec::new(|input, _| {
                Some(Gather::new(input.scene.crease(), |scene, _| lines(scene)))
            })
        },
        NORMALS_OF_SHAPES,
    ],
    ..OverlaySpec::SWITCH
};

/// One line per distinct normal of a vertex of the triangles that are shown.
pub fn lines(scene: &Scene) -> Vec<Line> {
    let (mesh, normals) = (scene.mesh(), scene.vertex_normals());
    let mut corners: Vec<(u32, [u32; 3], u32, usize)> = Vec::new();
    let triangles = (0..).zip(mesh.triangles());
    for (triangle, vertices) in triangles.filter(|(triangle, _)| scene.is_shown(*triangle)) {
        let normal = normals.of_triangle(mesh, triangle);
        for k in 0..3 {
            let bits = normal[k].to_array().map(f32::to_bits);
            corners.push((vertices[k], bits, triangle, k));
        }
    }
    corners.sort_unstable();
    corners.dedup_by_key(|(vertex, normal, ..)| (*vertex, *normal));
    let from_corner = |&(_, normal, triangle, k): &(u32, [u32; 3], u32, usize)| {
        let p = mesh.corners(triangle);
        let normal = Vec3::from_array(normal.map(f32::from_bits));
        line(scene, p[k], normal, p[(k + 1) % 3] - p[k])
    };
    corners.iter().map(from_corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::TriangleMesh;
    use hitscope_core::mesh::Crease;
    use hitscope_core::scene::scene;

    /// Two triangles at a right angle that share an edge.
    fn roof() -> Scene {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        scene(TriangleMesh::new(corners, vec![[0, 1, 2], [0, 3, 1]]))
    }

    #[test]
    fn a_vertex_has_one_normal_or_one_on_each_side_of_a_crease() {
        let smooth = roof().with_crease(Crease::Above(3.0));
        assert_eq!(lines(&smooth).len(), 4);
        let creased = roof().with_crease(Crease::Above(0.5));
        assert_eq!(lines(&creased).len(), 6);
    }

    #[test]
    fn normals_are_gathered_again_when_the_crease_changes() {
        use crate::overlay::tests::{input, state_of};
        use std::sync::Arc;
        let key = |crease| {
            let scene = Arc::new(roof().with_crease(crease));
            let gather = VERTEX_NORMALS.lines[0].gather;
            gather(&input(&scene), &state_of(&VERTEX_NORMALS)).expect("lines")
        };
        let (a, b) = (key(Crease::FromFile), key(Crease::Above(0.5)));
        assert!(a.key() == key(Crease::FromFile).key());
        assert!(a.key() != b.key());
    }
}

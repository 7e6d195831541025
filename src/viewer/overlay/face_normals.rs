//! The normals of faces, at the centres of their triangles, and of other shapes.

use super::gather::Gather;
use super::normals::{LENGTH, line};
use super::shape_normals::NORMALS_OF_SHAPES;
use super::spec::{Fade, LineSpec, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;
use hitscope_core::Scene;

/// The overlay.
pub static FACE_NORMALS: OverlaySpec = OverlaySpec {
    name: "face-normals",
    title: "Face normals",
    about: "Normals at the centres of triangles, and of other shapes",
    style: OverlayStyle {
        colour: [41, 140, 242],
        opacity: 0.8,
        width_px: 1.0,
    },
    options: &[&LENGTH],
    lines: &[
        LineSpec {
            fade: Fade::ShortOrDense,
            length: Some(&LENGTH),
            ..LineSpec::new(|_, _| Some(Gather::new((), |scene, ()| lines(scene))))
        },
        NORMALS_OF_SHAPES,
    ],
    ..OverlaySpec::SWITCH
};

/// One line per triangle that is shown.
pub fn lines(scene: &Scene) -> Vec<Line> {
    let mesh = scene.mesh();
    let of_triangle = |triangle: u32| {
        let [a, b, c] = mesh.corners(triangle);
        let centre = a / 3.0 + b / 3.0 + c / 3.0;
        line(
            scene,
            centre,
            mesh.geometric_normal(triangle),
            0.5 * (b - a),
        )
    };
    (0..mesh.triangles().len() as u32)
        .filter(|&triangle| scene.is_shown(triangle))
        .map(of_triangle)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::scene::scene;

    #[test]
    fn a_triangle_has_one_normal_at_its_centre() {
        let corners = vec![Vec3::ZERO, 3.0 * Vec3::X, 3.0 * Vec3::Y];
        let scene = scene(TriangleMesh::new(corners, vec![[0, 1, 2]]));
        let [normal] = lines(&scene)[..] else {
            panic!("one line");
        };
        assert!((normal.start - Vec3::new(1.0, 1.0, 0.0)).length() < 1e-6);
        let along = normal.end - normal.start;
        assert!((along / scene.bounds().radius() as f32 - Vec3::Z).length() < 1e-6);
    }
}

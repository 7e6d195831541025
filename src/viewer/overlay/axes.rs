//! The axes of the file's coordinates at their origin.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::Label;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;
use glam::DVec3;
use hitscope_core::Scene;

/// The overlay.
pub static AXES: OverlaySpec = OverlaySpec {
    name: "axes",
    title: "Axes",
    about: "The axes of the file's coordinates at their origin: x red, y green, z blue",
    style: OverlayStyle {
        colour: [128; 3],
        opacity: 1.0,
        width_px: 2.0,
    },
    lines: &[
        LineSpec {
            colour: Some([230, 60, 70]),
            behind: Behind::Faint,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, 0))
        },
        LineSpec {
            colour: Some([90, 180, 50]),
            behind: Behind::Faint,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, 1))
        },
        LineSpec {
            colour: Some([60, 120, 240]),
            behind: Behind::Faint,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, 2))
        },
    ],
    labels,
    ..OverlaySpec::SWITCH
};

fn gather(input: &OverlayInput, axis: usize) -> Option<Gather> {
    ends(&input.scene, axis)?;
    let gather = Gather::new(axis, |scene, &axis| {
        let line = |[start, end]: [DVec3; 2]| Line::between(start.as_vec3(), end.as_vec3());
        ends(scene, axis).map(line).into_iter().collect()
    });
    Some(gather)
}

/// The origin and the tip of an axis; as long as the scene's radius, or 1 for a scene without one. `None` if the scene is so
/// far from the origin that 32-bit numbers don't reach it.
fn ends(scene: &Scene, axis: usize) -> Option<[DVec3; 2]> {
    let radius = scene.bounds_with_elements().radius();
    let length = if radius > 0.0 { radius } else { 1.0 };
    let origin = -scene.mesh().origin();
    let tip = origin + length * DVec3::AXES[axis];
    let is_near = origin.as_vec3().is_finite() && tip.as_vec3().is_finite();
    is_near.then_some([origin, tip])
}

/// The names of the axes at their tips.
fn labels(input: &OverlayInput) -> Vec<Label> {
    let of_axis = |axis: usize| {
        let [_, tip] = ends(&input.scene, axis)?;
        Some(Label::at(tip, ["x", "y", "z"][axis]))
    };
    (0..3).filter_map(of_axis).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use hitscope_core::TriangleMesh;
    use hitscope_core::scene::scene;

    #[test]
    fn axes_start_at_the_origin_of_the_file() {
        let corners = vec![Vec3::NEG_X, Vec3::X, Vec3::Y];
        let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]);
        let scene = scene(mesh.with_origin(DVec3::new(10.0, 0.0, 0.0)));
        let radius = scene.bounds().radius();
        let origin = DVec3::new(-10.0, 0.0, 0.0);
        for (axis, dir) in DVec3::AXES.into_iter().enumerate() {
            assert_eq!(ends(&scene, axis), Some([origin, origin + radius * dir]));
        }
    }
}

//! The picked primitive: the outline of a triangle, or the lines of another shape.

use super::gather::Gather;
use super::shapes::lines_of;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use super::wireframe::triangle_lines;

/// The overlay.
pub static PICKED: OverlaySpec = OverlaySpec {
    name: "picked",
    title: "Picked primitive",
    about: "The triangle or other shape that was picked",
    style: OverlayStyle {
        colour: [255, 140, 0],
        opacity: 1.0,
        width_px: 2.2,
    },
    lines: &[LineSpec {
        behind: Behind::Faint,
        ..LineSpec::new(|input, _| {
            let primitive = input.marks.picked?;
            let is_triangle = input.scene.is_triangle(primitive);
            let camera = (!is_triangle).then_some(input.lines_camera);
            let gather = Gather::new(
                (primitive, camera),
                |scene, (primitive, camera)| match camera {
                    Some(camera) => lines_of(scene, *primitive, camera),
                    None => triangle_lines(scene.mesh(), *primitive).to_vec(),
                },
            );
            Some(gather)
        })
    }],
    ..OverlaySpec::MARK
};

//! The picked primitive: the outline of a triangle, or the lines of another shape.

use super::gather::Gather;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use super::wireframe::primitive_lines;

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
            let gather = Gather::new(input.marks.picked?, |scene, &primitive| {
                primitive_lines(scene, primitive)
            });
            Some(gather)
        })
    }],
    ..OverlaySpec::MARK
};

//! The selected box of the picked ray's walk.

use super::bounding_box::edges_of;
use super::gather::Gather;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};

/// The overlay.
pub static WALK: OverlaySpec = OverlaySpec {
    name: "walk",
    title: "Walk",
    about: "A box of the tree that the picked ray opens",
    style: OverlayStyle {
        colour: [200, 120, 255],
        opacity: 1.0,
        width_px: 1.8,
    },
    lines: &[LineSpec {
        behind: Behind::Faint,
        ..LineSpec::new(|input, _| {
            let gather = Gather::new(input.marks.opened?, |_, bounds| edges_of(bounds));
            Some(gather)
        })
    }],
    ..OverlaySpec::MARK
};

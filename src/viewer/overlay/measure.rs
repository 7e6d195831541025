//! The numbers of the picked points, and the measurements between them.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::Label;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;

/// The overlay.
pub static MEASURE: OverlaySpec = OverlaySpec {
    name: "measure",
    title: "Measurements",
    about: "The numbers of the picks, and lengths, angles and circles between them",
    style: OverlayStyle {
        colour: [90, 210, 255],
        opacity: 1.0,
        width_px: 1.6,
    },
    lines: &[LineSpec {
        behind: Behind::Faint,
        ..LineSpec::new(|input, _| {
            let segments = &input.marks.measurements.lines;
            let gather = || {
                Gather::new(segments.clone(), |_, segments| {
                    let line = |[a, b]: &[glam::DVec3; 2]| Line::between(a.as_vec3(), b.as_vec3());
                    segments.iter().map(line).collect()
                })
            };
            (!segments.is_empty()).then(gather)
        })
    }],
    labels,
    ..OverlaySpec::MARK
};

fn labels(input: &OverlayInput) -> Vec<Label> {
    let marks = &input.marks;
    let texts = marks.picks.iter().chain(&marks.measurements.texts);
    texts.map(|(point, text)| Label::at(*point, text)).collect()
}

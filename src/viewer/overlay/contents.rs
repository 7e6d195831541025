//! The contents of an overlay: the lines of all rows that are on, which window and `render` draw alike.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::Label;
use super::spec::OverlaySpec;
use super::state::Overlays;
use crate::gpu::lines::{LineKind, StyleUniform};
use crate::gpu::view::ViewUniform;
use hitscope_core::Aabb;

/// The contents of an overlay.
pub struct Contents {
    /// The lines in the order of drawing.
    pub lines: Vec<WantedLines>,
    /// The style of the outlines of shapes other than meshes, if these are drawn.
    pub outline: Option<StyleUniform>,
    /// The view.
    pub view: ViewUniform,
}

/// Lines that are to be drawn.
pub struct WantedLines {
    /// The overlay.
    pub overlay: &'static OverlaySpec,
    /// The number of these lines among those of all rows.
    pub slot: usize,
    /// How they are gathered.
    pub gather: Gather,
    /// Their kinds and styles in the order of drawing.
    pub looks: Vec<(LineKind, StyleUniform)>,
}

impl Contents {
    /// The contents for overlays in these states.
    pub fn of(input: &OverlayInput, overlays: &Overlays) -> Self {
        let rows = overlays.iter().flat_map(|(overlay, state)| {
            overlay.lines.iter().map(move |spec| (overlay, state, spec))
        });
        let (mut lines, mut outline) = (Vec::new(), None);
        for (slot, (overlay, state, spec)) in rows.enumerate() {
            if !state.is_on {
                continue;
            }
            if let Some(gather) = (spec.gather)(input, state) {
                if spec.has_outlines {
                    outline = Some(spec.style(state, input.scale));
                }
                lines.push(WantedLines {
                    overlay,
                    slot,
                    gather,
                    looks: spec.looks(state, input.scale),
                });
            }
        }
        let reach = lines.iter().map(|lines| lines.gather.bounds());
        let reach = reach.fold(Aabb::EMPTY, Aabb::union);
        let bounds = input.scene.bounds_with_elements();
        Self {
            view: ViewUniform::with_lines(&input.camera, &bounds, &reach)
                .clipped(input.scene.clip()),
            lines,
            outline,
        }
    }
}

/// The texts of all overlays that are on.
pub fn labels(input: &OverlayInput, overlays: &Overlays) -> Vec<Label> {
    let shown = overlays.iter().filter(|(_, state)| state.is_on);
    shown
        .flat_map(|(overlay, _)| (overlay.labels)(input))
        .collect()
}

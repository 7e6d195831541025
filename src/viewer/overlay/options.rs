//! Contents and styles of the overlay.

use super::paths::PathLines;
use super::wireframe::WireframeEdges;
use crate::gpu::lines::StyleUniform;
use hitscope_core::mesh::Flaw;
use hitscope_core::scene::Shading;

/// Contents and styles of the overlay. Widths are in physical pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The mesh's edges.
    pub wireframe: Option<WireframeEdges>,
    /// sRGB of the edges.
    pub wire_colour: [u8; 3],
    /// Normals of faces (flat) or of vertices (smooth).
    pub normals: Option<Shading>,
    /// Length of the normals, as a fraction of the mesh's radius.
    pub normal_length: f32,
    /// The file's lines and points.
    pub elements: bool,
    /// The flaws of this kind.
    pub flaw: Option<Flaw>,
    /// The picked primitive.
    pub picked: Option<u32>,
    /// The path of a picked pixel.
    pub path: bool,
    /// Width of the wireframe's lines in pixels.
    pub line_width_px: f32,
}

impl Options {
    /// No lines at all.
    pub const NOTHING: Self = Self {
        wireframe: None,
        wire_colour: [0; 3],
        normals: None,
        normal_length: 0.0,
        elements: false,
        flaw: None,
        picked: None,
        path: false,
        line_width_px: 1.0,
    };

    pub(super) fn is_nothing(&self) -> bool {
        self.wireframe.is_none()
            && self.normals.is_none()
            && !self.elements
            && self.flaw.is_none()
            && self.picked.is_none()
            && !self.path
    }

    pub(crate) fn wire_style(&self) -> StyleUniform {
        let [r, g, b] = self.wire_colour.map(|c| f32::from(c) / 255.0);
        style([r, g, b, 0.85], self.line_width_px, 1.0)
    }

    /// The style of other shapes' lines, which consist of short pieces.
    pub(crate) fn shape_style(&self) -> StyleUniform {
        StyleUniform {
            fade: 2.0,
            ..self.wire_style()
        }
    }

    pub(crate) fn normal_style(&self) -> StyleUniform {
        StyleUniform {
            stretch: self.normal_length,
            ..style([0.16, 0.55, 0.95, 0.8], self.line_width_px, 1.0)
        }
    }

    pub(crate) fn element_style(&self) -> StyleUniform {
        style([0.10, 0.75, 0.62, 0.95], 1.6 * self.line_width_px, 0.0)
    }

    pub(super) fn flaw_style(&self, alpha: f32) -> StyleUniform {
        style([0.95, 0.15, 0.20, alpha], 2.6 * self.line_width_px, 0.0)
    }

    pub(super) fn picked_style(&self, alpha: f32) -> StyleUniform {
        style([1.0, 0.55, 0.0, alpha], 2.2 * self.line_width_px, 0.0)
    }

    /// Segments of a path are wider than its rays to lights.
    pub(super) fn path_style(&self, lines: PathLines, alpha: f32) -> StyleUniform {
        let ([r, g, b], width) = match lines {
            PathLines::Segments => ([1.0, 0.85, 0.2], 2.4),
            PathLines::Visible => ([0.45, 0.9, 0.5], 1.4),
            PathLines::Blocked => ([0.95, 0.3, 0.3], 1.4),
        };
        style([r, g, b, alpha], width * self.line_width_px, 0.0)
    }
}

fn style(colour: [f32; 4], width_px: f32, fade: f32) -> StyleUniform {
    StyleUniform {
        colour,
        half_width_px: 0.5 * width_px,
        stretch: 1.0,
        fade,
        padding: 0.0,
    }
}

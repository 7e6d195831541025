//! The types of the overlay table's rows.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::Label;
use super::state::OverlayState;
pub use crate::gpu::lines::Fade;
use crate::gpu::lines::{LineKind, LineOcclusion, StyleUniform};
use std::ops::RangeInclusive;

/// A row of the table: an overlay. Rows are made from [`SWITCH`](Self::SWITCH) or [`MARK`](Self::MARK).
pub struct OverlaySpec {
    /// Name in settings and on the command line. It never changes.
    pub name: &'static str,
    /// Title in the window.
    pub title: &'static str,
    /// Description for the window and the command line.
    pub about: &'static str,
    /// What shows the overlay.
    pub trigger: Trigger,
    /// The style at first.
    pub style: OverlayStyle,
    /// Its own options.
    pub options: &'static [&'static OverlayOption],
    /// Its lines; later ones are drawn over earlier ones.
    pub lines: &'static [LineSpec],
    /// Its texts.
    pub labels: fn(&OverlayInput) -> Vec<Label>,
}

/// What shows an overlay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// A switch of the user.
    Switch {
        /// Whether it is on at first.
        is_on: bool,
    },
    /// A pick or another selection: the overlay is drawn while there is something to mark.
    Mark,
}

/// A style of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlayStyle {
    /// sRGB.
    pub colour: [u8; 3],
    /// Opacity from 0 to 1.
    pub opacity: f32,
    /// Width in pixels, on a screen with one pixel per point.
    pub width_px: f32,
}

/// An option of one overlay.
pub struct OverlayOption {
    /// Name in settings. It never changes.
    pub name: &'static str,
    /// Title in the window.
    pub title: &'static str,
    /// What it sets.
    pub kind: OptionKind,
    /// The value at first.
    pub default: f32,
}

/// What an option sets.
pub enum OptionKind {
    /// A switch: 0 is off, any other number is on.
    Switch,
    /// A fraction in this range, shown in percent.
    Fraction(RangeInclusive<f32>),
}

/// Lines of an overlay that share a style.
pub struct LineSpec {
    /// How the lines are gathered; `None` if there are none to draw.
    pub gather: fn(&OverlayInput, &OverlayState) -> Option<Gather>,
    /// A colour that replaces the overlay's.
    pub colour: Option<[u8; 3]>,
    /// Factor of the overlay's width.
    pub width: f32,
    /// Factor of the overlay's opacity.
    pub opacity: f32,
    /// When lines fade.
    pub fade: Fade,
    /// The option that is the factor of the lines' length. Their starts stay in place.
    pub length: Option<&'static OverlayOption>,
    /// What surfaces do to lines behind them.
    pub behind: Behind,
    /// Whether the outlines of shapes other than meshes are drawn in this style, too.
    pub has_outlines: bool,
    /// Whether the clip cuts the lines, as it cuts the surfaces that they are on.
    pub is_cut: bool,
}

/// How lines behind a surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// Not at all.
    Hidden,
    /// Faintly.
    Faint,
    /// Clearly: for lines that mostly run inside or behind surfaces.
    Clear,
}

impl Behind {
    /// The factor of the opacity of lines behind a surface; `None` if they aren't drawn.
    fn opacity(self) -> Option<f32> {
        match self {
            Self::Hidden => None,
            Self::Faint => Some(0.3),
            Self::Clear => Some(0.7),
        }
    }
}

impl OverlaySpec {
    /// A row with a switch that is off at first, and nothing to draw.
    pub const SWITCH: Self = Self {
        name: "",
        title: "",
        about: "",
        trigger: Trigger::Switch { is_on: false },
        style: OverlayStyle {
            colour: [128; 3],
            opacity: 1.0,
            width_px: 1.0,
        },
        options: &[],
        lines: &[],
        labels: |_| Vec::new(),
    };

    /// A row that a selection shows, and nothing to draw.
    pub const MARK: Self = Self {
        trigger: Trigger::Mark,
        ..Self::SWITCH
    };

    /// Whether it has a switch.
    pub fn is_switch(&self) -> bool {
        matches!(self.trigger, Trigger::Switch { .. })
    }

    /// Whether any of its lines have the overlay's colour.
    pub fn has_colour(&self) -> bool {
        self.lines.iter().any(|lines| lines.colour.is_none())
    }
}

impl OverlayOption {
    /// The value, or the default if the control can't set it.
    pub(super) fn usable(&self, value: f32) -> f32 {
        let is_usable = match &self.kind {
            OptionKind::Switch => value.is_finite(),
            OptionKind::Fraction(range) => range.contains(&value),
        };
        if is_usable { value } else { self.default }
    }
}

impl LineSpec {
    /// Lines in the overlay's style, hidden behind surfaces, that don't fade.
    pub const fn new(gather: fn(&OverlayInput, &OverlayState) -> Option<Gather>) -> Self {
        Self {
            gather,
            colour: None,
            width: 1.0,
            opacity: 1.0,
            fade: Fade::Never,
            length: None,
            behind: Behind::Hidden,
            has_outlines: false,
            is_cut: true,
        }
    }

    /// The style for a state of the overlay; `scale` is the number of physical pixels per unit of width.
    pub(super) fn style(&self, state: &OverlayState, scale: f32) -> StyleUniform {
        let [r, g, b] = self
            .colour
            .unwrap_or(state.colour)
            .map(|c| f32::from(c) / 255.0);
        let colour = [r, g, b, self.opacity * state.opacity];
        let half_width_px = 0.5 * self.width * state.width_px * scale;
        let stretch = self.length.map_or(1.0, |length| state.value(length));
        StyleUniform::new(colour, half_width_px, stretch)
    }

    fn kind(&self, occlusion: LineOcclusion) -> LineKind {
        LineKind {
            occlusion,
            fade: self.fade,
            is_cut: self.is_cut,
        }
    }

    /// Kinds and styles of the lines in the order of drawing: first through surfaces, then in front of them.
    pub(super) fn looks(&self, state: &OverlayState, scale: f32) -> Vec<(LineKind, StyleUniform)> {
        let style = self.style(state, scale);
        let mut looks = Vec::new();
        if let Some(opacity) = self.behind.opacity() {
            let mut behind = style;
            behind.colour[3] *= opacity;
            looks.push((self.kind(LineOcclusion::Through), behind));
        }
        looks.push((self.kind(LineOcclusion::Hidden), style));
        looks
    }
}

//! The choices about a comparison as plain data, which is kept in sessions and undo steps.

use crate::settings::Settings;
use hitscope_core::group::kernel_named;
use hitscope_core::integrator::integrator;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The range of the factor by which differences are multiplied.
pub const GAINS: RangeInclusive<f32> = 1.0..=256.0;

/// A side of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The window's own picture.
    #[default]
    A,
    /// The other picture.
    B,
}

/// How a comparison is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Side A.
    A,
    /// Side B.
    B,
    /// A left of a divider, B right of it.
    #[default]
    Wipe,
    /// The differences of the colours of both sides.
    Difference,
    /// The distances from A's surface to B's.
    Distance,
}

impl Mode {
    /// All modes.
    pub const ALL: [Self; 5] = [
        Self::Wipe,
        Self::A,
        Self::B,
        Self::Difference,
        Self::Distance,
    ];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::A => "Side A",
            Self::B => "Side B",
            Self::Wipe => "Wipe",
            Self::Difference => "Difference",
            Self::Distance => "Distance map",
        }
    }

    /// The tooltip.
    pub fn about(self) -> &'static str {
        match self {
            Self::A => "Shows only the window's own picture",
            Self::B => "Shows only the other picture",
            Self::Wipe => "Shows side A left of a divider and side B right of it",
            Self::Difference => "Shows the differences of the colours of both sides",
            Self::Distance => "Colours the surface of side A by its distance to that of side B",
        }
    }
}

/// The source of side B.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The open scene, traced.
    #[default]
    Traced,
    /// The open scene, rasterized.
    Rasterized,
    /// The mesh or scene of another file, traced.
    Mesh,
    /// The open file before it was last reloaded, traced.
    Earlier,
    /// A picture in a file.
    Picture,
}

impl Source {
    /// All sources.
    pub const ALL: [Self; 5] = [
        Self::Traced,
        Self::Rasterized,
        Self::Mesh,
        Self::Earlier,
        Self::Picture,
    ];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Traced => "This scene, traced",
            Self::Rasterized => "This scene, rasterized",
            Self::Mesh => "Another file",
            Self::Earlier => "Earlier version",
            Self::Picture => "Reference picture",
        }
    }

    /// The tooltip.
    pub fn about(self) -> &'static str {
        match self {
            Self::Traced => "Side B is the open scene, traced with another view, kernel or shading",
            Self::Rasterized => {
                "Side B is the open scene, whose visible triangles the GPU's rasterizer finds"
            }
            Self::Mesh => "Side B is the mesh or scene of another file",
            Self::Earlier => "Side B is the open file before it was last reloaded",
            Self::Picture => "Side B is a PNG, EXR or HDR picture",
        }
    }

    /// Whether rays are traced for side B.
    pub fn is_traced(self) -> bool {
        matches!(self, Self::Traced | Self::Mesh | Self::Earlier)
    }

    /// Whether side B has another scene than side A.
    pub fn is_other_scene(self) -> bool {
        matches!(self, Self::Mesh | Self::Earlier)
    }
}

/// The choices about a comparison. View, kernel and shading of side B are those of side A where they are `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Comparison {
    /// Whether two sides are compared.
    pub is_on: bool,
    /// How it is shown.
    pub mode: Mode,
    /// The divider's position, from 0 at the left edge of the picture to 1 at its right edge.
    pub divider: f32,
    /// The factor by which differences are multiplied.
    pub gain: f32,
    /// Whether side A is rasterized instead of traced.
    pub is_a_rasterized: bool,
    /// The source of side B.
    pub source: Source,
    /// Name of side B's view.
    pub view: Option<String>,
    /// Name of side B's kernel.
    pub kernel: Option<String>,
    /// Whether side B's shading is smooth.
    pub is_smooth: Option<bool>,
    /// The file of [`Source::Mesh`].
    pub mesh_file: Option<PathBuf>,
    /// The file of [`Source::Picture`].
    pub picture_file: Option<PathBuf>,
}

impl Default for Comparison {
    fn default() -> Self {
        Self {
            is_on: false,
            mode: Mode::default(),
            divider: 0.5,
            gain: 8.0,
            is_a_rasterized: false,
            source: Source::default(),
            view: None,
            kernel: None,
            is_smooth: None,
            mesh_file: None,
            picture_file: None,
        }
    }
}

impl Comparison {
    /// The settings of side B; `of_a` are those of side A.
    pub fn settings(&self, of_a: &Settings) -> Settings {
        let mut settings = of_a.clone();
        if let Some(view) = &self.view {
            settings.keep_view(view);
        }
        if let Some(kernel) = &self.kernel {
            settings.keep_kernel(kernel);
        }
        settings.is_smooth = self.is_smooth.unwrap_or(of_a.is_smooth);
        // Only traced pictures have noise.
        settings.shows_noise &= self.source.is_traced();
        settings
    }

    /// Exchanges view, kernel and shading of both sides, and whether they are rasterized. Both show the open scene.
    pub fn swap(&mut self, of_a: &mut Settings) {
        let of_b = self.settings(of_a);
        let is_b_rasterized = self.source == Source::Rasterized;
        self.source = if self.is_a_rasterized {
            Source::Rasterized
        } else {
            Source::Traced
        };
        self.is_a_rasterized = is_b_rasterized;
        self.view = Some(of_a.view().name.to_owned());
        self.kernel = Some(of_a.kernel().info.name.to_owned());
        self.is_smooth = Some(of_a.is_smooth);
        of_a.keep_view(of_b.view().name);
        of_a.keep_kernel(of_b.kernel().info.name);
        of_a.is_smooth = of_b.is_smooth;
    }

    /// Whether a side is rasterized.
    pub fn has_rasterized(&self) -> bool {
        self.is_a_rasterized || self.source == Source::Rasterized
    }

    /// Shows side B alone, or side A alone if side B already is.
    pub fn switch(&mut self) {
        self.mode = match self.mode {
            Mode::B => Mode::A,
            _ => Mode::B,
        };
    }

    /// Moves the divider by a fraction of the picture's width.
    pub fn move_divider(&mut self, by: f32) {
        self.divider = (self.divider + by).clamp(0.0, 1.0);
    }

    /// Replaces values that no control can set with the defaults.
    #[must_use]
    pub fn usable(self) -> Self {
        let default = Self::default();
        let is_part = (0.0..=1.0).contains(&self.divider);
        let is_gain = GAINS.contains(&self.gain);
        Self {
            divider: if is_part {
                self.divider
            } else {
                default.divider
            },
            gain: if is_gain { self.gain } else { default.gain },
            view: self.view.filter(|name| integrator(name).is_some()),
            kernel: self.kernel.filter(|name| kernel_named(name).is_some()),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn side_b_follows_side_a_where_nothing_else_is_chosen() {
        let mut of_a = Settings::default();
        let mut comparison = Comparison {
            view: Some("normal".to_owned()),
            ..Comparison::default()
        };
        of_a.keep_kernel("exact");
        of_a.is_smooth = true;
        let of_b = comparison.settings(&of_a);
        assert_eq!(of_b.view().name, "normal");
        assert_eq!(of_b.kernel().info.name, "exact");
        assert!(of_b.is_smooth);
        comparison.is_smooth = Some(false);
        assert!(!comparison.settings(&of_a).is_smooth);
    }

    #[test]
    fn swapping_twice_shows_the_same_sides_again() {
        let mut of_a = Settings::default();
        let mut comparison = Comparison {
            view: Some("depth".to_owned()),
            kernel: Some("exact".to_owned()),
            is_smooth: Some(true),
            is_a_rasterized: true,
            ..Comparison::default()
        };
        let before = (of_a.clone(), comparison.settings(&of_a));
        let of_before = comparison.clone();
        comparison.swap(&mut of_a);
        assert_eq!(of_a.view().name, "depth");
        assert_eq!(comparison.settings(&of_a).view().name, before.0.view().name);
        assert_eq!(comparison.source, Source::Rasterized);
        assert!(!comparison.is_a_rasterized);
        comparison.swap(&mut of_a);
        assert_eq!((of_a.clone(), comparison.settings(&of_a)), before);
        assert_eq!(comparison.source, of_before.source);
        assert!(comparison.is_a_rasterized);
    }

    #[test]
    fn numbers_and_names_that_no_control_can_set_are_replaced() {
        let odd = Comparison {
            divider: -3.0,
            gain: f32::NAN,
            view: Some("of another version".to_owned()),
            kernel: Some("exact".to_owned()),
            ..Comparison::default()
        };
        let expected = Comparison {
            kernel: Some("exact".to_owned()),
            ..Comparison::default()
        };
        assert_eq!(odd.usable(), expected);
    }
}

//! The preferences of the window, kept between runs: all that doesn't change what the picture shows.

use crate::bindings::NavigationSettings;
use crate::recent::RecentFiles;
use crate::tab::Tab;
use egui::ThemePreference;
use hitscope_core::intersector::Packing;
use hitscope_core::scene::{FirstTree, SceneOptions};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Allowed widths of the side panel, in points.
pub const PANEL_WIDTHS: RangeInclusive<f32> = 240.0..=460.0;

/// The preferences of the window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Whether the file is reloaded when it changes.
    pub watches: bool,
    /// Whether triangles are packed for memory rather than for speed.
    pub is_compact: bool,
    /// Whether the side panel is shown.
    pub shows_panel: bool,
    /// The tab of the side panel.
    pub tab: Tab,
    /// Width of the side panel in points.
    pub panel_width: f32,
    /// Scale of the user interface, which excludes the picture.
    pub zoom: f32,
    /// Dark, light, or the system's theme.
    pub theme: ThemePreference,
    /// What the pointer does, and how the camera moves.
    pub navigation: NavigationSettings,
    /// The files that were opened last.
    pub recent: RecentFiles,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            watches: false,
            is_compact: false,
            shows_panel: true,
            tab: Tab::Display,
            panel_width: 385.0,
            zoom: 1.0,
            theme: ThemePreference::Dark,
            navigation: NavigationSettings::default(),
            recent: RecentFiles::default(),
        }
    }
}

impl Preferences {
    /// Options for building a scene: quick first tree, packed for speed or for memory.
    pub fn scene_options(&self) -> SceneOptions {
        SceneOptions {
            first_tree: FirstTree::Quick,
            packing: if self.is_compact {
                Packing::Compact
            } else {
                Packing::Full
            },
        }
    }
}

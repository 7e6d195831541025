//! What the user chose about how things are shown. Kept between runs.

use egui::ThemePreference;
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::{INTEGRATORS, Integrator, integrator};
use hitscope_core::intersector::Packing;
use hitscope_core::kernel::{
    TriangleKernel, default_triangle_kernel, exact_triangle_kernel, triangle_kernel,
};
use hitscope_core::mesh::Crease;
use hitscope_core::scene::{FirstTree, SceneOptions, Shading};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// A tab of the side panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tab {
    /// The picked pixel.
    Inspect,
    /// How the mesh is seen.
    View,
    /// What is in the file.
    Mesh,
    /// What speed costs in accuracy here.
    Trade,
}

/// How wide the side panel may be, in points.
pub const PANEL_WIDTHS: RangeInclusive<f32> = 240.0..=460.0;

/// See the [module](self). Names that a later version doesn't know fall back to the default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Name of the view.
    pub view: String,
    /// Name of the kernel.
    pub kernel: String,
    /// Name of the kernel that the chosen one is held against.
    pub against: String,
    /// Interpolated normals.
    pub is_smooth: bool,
    /// Edges over the picture.
    pub shows_wireframe: bool,
    /// Edges of all triangles, not only of the file's polygons.
    pub shows_diagonals: bool,
    /// sRGB of the edges.
    pub wire_colour: [u8; 3],
    /// Normals over the picture.
    pub shows_normals: bool,
    /// As a part of the mesh's radius.
    pub normal_length: f32,
    /// Samples a pixel in the end; a power of two.
    pub samples: u32,
    /// Whether the mesh's z axis points up. A matter of the file, so it isn't kept.
    #[serde(skip)]
    pub is_z_up: bool,
    /// Whether smooth shading has edges by angle, and not where the file says.
    pub has_crease: bool,
    /// From which angle on.
    pub crease_degrees: f32,
    /// Whether the file is loaded again when it changes.
    pub watches: bool,
    /// Whether files are loaded for memory rather than for speed.
    pub is_compact: bool,
    /// The side panel.
    pub shows_panel: bool,
    /// Its tab.
    pub tab: Tab,
    /// Its width in points.
    pub panel_width: f32,
    /// Scale of everything but the picture.
    pub zoom: f32,
    /// Dark, light, or as the system has it.
    pub theme: ThemePreference,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            view: INTEGRATORS[0].name.to_owned(),
            kernel: default_triangle_kernel().info.name.to_owned(),
            against: exact_triangle_kernel().info.name.to_owned(),
            is_smooth: false,
            shows_wireframe: false,
            shows_diagonals: false,
            wire_colour: [12, 14, 18],
            shows_normals: false,
            normal_length: 0.03,
            samples: 64,
            is_z_up: false,
            has_crease: false,
            // What modelling programs begin with.
            crease_degrees: 30.0,
            watches: false,
            is_compact: false,
            shows_panel: true,
            tab: Tab::View,
            panel_width: 385.0,
            zoom: 1.0,
            theme: ThemePreference::Dark,
        }
    }
}

impl Settings {
    /// The view.
    pub fn integrator(&self) -> &'static Integrator {
        integrator(&self.view).unwrap_or(&INTEGRATORS[0])
    }

    /// The kernel.
    pub fn kernel(&self) -> &'static TriangleKernel {
        triangle_kernel(&self.kernel).unwrap_or_else(default_triangle_kernel)
    }

    /// What a scene is made with: its first picture soon, for speed or for memory.
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

    /// The kernel that the view holds the chosen one against, if it compares.
    pub fn second_kernel(&self) -> Option<&'static TriangleKernel> {
        let chosen = triangle_kernel(&self.against).unwrap_or_else(exact_triangle_kernel);
        self.integrator().against.kernel(chosen)
    }

    /// Flat or smooth.
    pub fn shading(&self) -> Shading {
        if self.is_smooth {
            Shading::Smooth
        } else {
            Shading::Flat
        }
    }

    /// Where smooth shading has edges.
    pub fn crease(&self) -> Crease {
        if self.has_crease {
            Crease::Above(self.crease_degrees.to_radians())
        } else {
            Crease::FromFile
        }
    }

    /// Which axis points up.
    pub fn up_axis(&self) -> UpAxis {
        if self.is_z_up { UpAxis::Z } else { UpAxis::Y }
    }
}

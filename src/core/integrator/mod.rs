//! Views: functions from a ray to a colour.
//!
//! Each view is a row of [`INTEGRATORS`]. Colours are linear RGB.

mod compare;
mod interpolation;
mod legend;
pub mod palette;
mod shaded;
mod views;

use crate::camera::Camera;
use crate::intersector::Intersector;
use crate::kernel::{KernelChoice, exact_triangle_kernel};
use crate::ray::{Hit, Ray};
use crate::scene::{Scene, Shading};
use glam::Vec3;
use std::sync::Arc;

/// Everything that a colour depends on besides the ray.
#[derive(Clone)]
pub struct Context {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The intersector of the chosen kernel.
    pub intersector: Arc<dyn Intersector>,
    /// The intersector that comparing views compare with; any one for the others.
    pub second: Arc<dyn Intersector>,
    /// The camera.
    pub camera: Camera,
    /// Flat or smooth shading.
    pub shading: Shading,
    /// The colour of rays that hit nothing.
    pub background: Vec3,
}

/// A view: how a ray gets its colour.
pub struct Integrator {
    /// The name, as in `--view`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// The meaning of the colours, in one sentence.
    pub about: &'static str,
    /// The kernel that the view compares the chosen one with.
    pub against: Comparison,
    /// The legend.
    pub legend: fn() -> Legend,
    /// Whether the view depends on the tree, as the cost of rays does. Hits don't.
    pub depends_on_tree: bool,
    colour: fn(&Context, &Ray, Option<Hit>) -> Vec3,
}

/// The kernel that a view compares the chosen one with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// None: the view uses one kernel.
    Nothing,
    /// The exact kernel.
    Exact,
    /// A second kernel that the user chooses.
    Second,
}

impl Comparison {
    /// The kernel to compare with, where the user's second kernel is `chosen`.
    pub fn kernel(self, chosen: KernelChoice) -> Option<KernelChoice> {
        match self {
            Self::Nothing => None,
            Self::Exact => Some(exact_triangle_kernel().into()),
            Self::Second => Some(chosen),
        }
    }
}

/// Colours in linear RGB and their meaning, line by line.
pub type Legend = Vec<Vec<(Vec3, String)>>;

impl Integrator {
    /// The intersector to compare `first` with; `first` itself if the view doesn't compare.
    pub fn second(
        &self,
        scene: &Scene,
        first: &Arc<dyn Intersector>,
        chosen: KernelChoice,
    ) -> Arc<dyn Intersector> {
        let second = self.against.kernel(chosen);
        second.map_or_else(
            || Arc::clone(first),
            |kernel| Arc::from(scene.intersector(kernel)),
        )
    }

    /// The colour of a ray in linear RGB, given the first hit of [`Context::intersector`].
    pub fn radiance(&self, context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
        (self.colour)(context, ray, hit)
    }
}

/// All views, in the order of the menu.
pub static INTEGRATORS: &[Integrator] = &[
    Integrator {
        name: "shaded",
        title: "Shaded",
        about: "Lit by a studio light that moves with the camera.",
        against: Comparison::Nothing,
        legend: legend::none,
        depends_on_tree: false,
        colour: shaded::radiance,
    },
    Integrator {
        name: "normal",
        title: "Normal",
        about: "The shading normal: x, y, z from −1 to 1 as red, green, blue.",
        against: Comparison::Nothing,
        legend: legend::none,
        depends_on_tree: false,
        colour: views::normal,
    },
    Integrator {
        name: "barycentric",
        title: "Barycentric",
        about: "The barycentric coordinates of a triangle's corners as red, green, blue. On other shapes, the surface coordinates u and v, modulo 1, as red and green.",
        against: Comparison::Nothing,
        legend: legend::barycentric,
        depends_on_tree: false,
        colour: views::barycentric,
    },
    Integrator {
        name: "depth",
        title: "Depth",
        about: "Distance from the eye: white at the near side of the scene's bounding sphere, dark at the far side.",
        against: Comparison::Nothing,
        legend: legend::none,
        depends_on_tree: false,
        colour: views::depth,
    },
    Integrator {
        name: "triangle",
        title: "Triangle",
        about: "A colour for each triangle or other primitive.",
        against: Comparison::Nothing,
        legend: legend::none,
        depends_on_tree: false,
        colour: views::triangle,
    },
    Integrator {
        name: "cost",
        title: "Cost",
        about: "Boxes and primitives tested for the ray, on a logarithmic scale.",
        against: Comparison::Nothing,
        legend: legend::cost,
        depends_on_tree: true,
        colour: views::cost,
    },
    Integrator {
        name: "error-t",
        title: "Error of t",
        about: "Error of t of the chosen kernel, in f32 ulps, on a logarithmic scale.",
        against: Comparison::Exact,
        legend: legend::error_t,
        depends_on_tree: false,
        colour: compare::error_t,
    },
    Integrator {
        name: "error-barycentric",
        title: "Barycentric error",
        about: "Largest error of a barycentric coordinate of the chosen kernel, on a logarithmic scale. Shapes other than triangles have no barycentric coordinates and are grey.",
        against: Comparison::Exact,
        legend: legend::error_barycentric,
        depends_on_tree: false,
        colour: compare::error_barycentric,
    },
    Integrator {
        name: "interpolation",
        title: "Interpolation",
        about: "Angle between the linearly and the spherically interpolated vertex normal, on a logarithmic scale; grey below 0.001°.",
        against: Comparison::Nothing,
        legend: interpolation::legend,
        depends_on_tree: false,
        colour: interpolation::angle,
    },
    Integrator {
        name: "disagreement",
        title: "Disagreement",
        about: "Where the chosen kernel and a second one hit different primitives, or only one of them hits.",
        against: Comparison::Second,
        legend: legend::decisions,
        depends_on_tree: false,
        colour: compare::disagreement,
    },
];

/// The view of this name.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    INTEGRATORS.iter().find(|view| view.name == name)
}

//! Which colour does a ray bring back?
//!
//! One function a view; the table is [`INTEGRATORS`]. Colours are linear RGB.

mod compare;
mod legend;
pub mod palette;
mod shaded;
mod views;

use crate::camera::Camera;
use crate::intersector::Intersector;
use crate::kernel::{TriangleKernel, exact_triangle_kernel};
use crate::ray::Ray;
use crate::scene::{Scene, Shading};
use glam::Vec3;
use std::sync::Arc;

/// What is looked at, and how: all that a colour depends on besides the ray.
#[derive(Clone)]
pub struct Context {
    /// The triangles.
    pub scene: Arc<Scene>,
    /// Answers the rays.
    pub intersector: Arc<dyn Intersector>,
    /// What it is held against by views that compare; for others any will do.
    pub second: Arc<dyn Intersector>,
    /// From where.
    pub camera: Camera,
    /// Flat or smooth.
    pub shading: Shading,
    /// What a ray that hits nothing brings back.
    pub background: Vec3,
}

/// A way to see a scene.
pub struct Integrator {
    /// As `--view` takes it.
    pub name: &'static str,
    /// For menus.
    pub title: &'static str,
    /// What the colours mean, in a sentence.
    pub about: &'static str,
    /// What it holds the chosen kernel against.
    pub against: Against,
    /// What single colours mean.
    pub legend: fn() -> Legend,
    radiance: fn(&Context, &Ray) -> Vec3,
}

/// What a view holds the chosen kernel against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Nothing: there is one kernel.
    Nothing,
    /// The exact kernel.
    Exact,
    /// A second kernel of the user's choice.
    Second,
}

impl Against {
    /// The second kernel of a view, where the user's choice is `chosen`.
    pub fn kernel(self, chosen: &'static TriangleKernel) -> Option<&'static TriangleKernel> {
        match self {
            Self::Nothing => None,
            Self::Exact => Some(exact_triangle_kernel()),
            Self::Second => Some(chosen),
        }
    }
}

/// Colours, in linear RGB, and what they mean; line by line.
pub type Legend = Vec<Vec<(Vec3, String)>>;

impl Integrator {
    /// What the view holds `first` against; `first` itself where it holds it against nothing.
    pub fn second(
        &self,
        scene: &Scene,
        first: &Arc<dyn Intersector>,
        chosen: &'static TriangleKernel,
    ) -> Arc<dyn Intersector> {
        let second = self.against.kernel(chosen);
        second.map_or_else(
            || Arc::clone(first),
            |kernel| Arc::from(scene.intersector(kernel)),
        )
    }

    /// The colour that a ray brings back, in linear RGB.
    pub fn radiance(&self, context: &Context, ray: &Ray) -> Vec3 {
        (self.radiance)(context, ray)
    }
}

/// Every view, in the menu's order.
pub static INTEGRATORS: &[Integrator] = &[
    Integrator {
        name: "shaded",
        title: "Shaded",
        about: "Lit by a studio light that moves with the camera.",
        against: Against::Nothing,
        legend: legend::none,
        radiance: shaded::radiance,
    },
    Integrator {
        name: "normal",
        title: "Normal",
        about: "The shading normal: x, y, z from −1 to 1 as red, green, blue.",
        against: Against::Nothing,
        legend: legend::none,
        radiance: views::normal,
    },
    Integrator {
        name: "barycentric",
        title: "Barycentric",
        about: "The weights of the three corners as red, green, blue.",
        against: Against::Nothing,
        legend: legend::none,
        radiance: views::barycentric,
    },
    Integrator {
        name: "depth",
        title: "Depth",
        about: "Distance from the eye, white at the nearest place of the scene's sphere, dark at the farthest.",
        against: Against::Nothing,
        legend: legend::none,
        radiance: views::depth,
    },
    Integrator {
        name: "triangle",
        title: "Triangle",
        about: "A colour for each triangle.",
        against: Against::Nothing,
        legend: legend::none,
        radiance: views::triangle,
    },
    Integrator {
        name: "cost",
        title: "Cost",
        about: "Boxes and triangles tested for the ray, on a logarithmic scale.",
        against: Against::Nothing,
        legend: legend::cost,
        radiance: views::cost,
    },
    Integrator {
        name: "error-t",
        title: "Error of t",
        about: "By how many ulps of f32 the chosen kernel's t errs, on a logarithmic scale.",
        against: Against::Exact,
        legend: legend::error_t,
        radiance: compare::error_t,
    },
    Integrator {
        name: "error-barycentric",
        title: "Error of weights",
        about: "By how much the chosen kernel's worst weight errs, on a logarithmic scale.",
        against: Against::Exact,
        legend: legend::error_barycentric,
        radiance: compare::error_barycentric,
    },
    Integrator {
        name: "disagreement",
        title: "Disagreement",
        about: "Where the chosen kernel and a second one differ about what is hit.",
        against: Against::Second,
        legend: legend::decisions,
        radiance: compare::disagreement,
    },
];

/// The view of this name.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    INTEGRATORS.iter().find(|view| view.name == name)
}

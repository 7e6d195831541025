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
use crate::ray::{Hit, Ray};
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
    pub against: Comparison,
    /// What single colours mean.
    pub legend: fn() -> Legend,
    colour: Colour,
}

/// What a view makes a ray's colour of.
enum Colour {
    /// Of what the chosen kernel says that it hits first.
    OfHit(fn(&Context, &Ray, Option<Hit>) -> Vec3),
    /// Of what the ray costs, which the view finds out by itself.
    OfRay(fn(&Context, &Ray) -> Vec3),
}

/// What a view holds the chosen kernel against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Nothing: there is one kernel.
    Nothing,
    /// The exact kernel.
    Exact,
    /// A second kernel of the user's choice.
    Second,
}

impl Comparison {
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

    /// Whether it shows what rays cost, which another tree changes; what they hit it doesn't.
    pub fn depends_on_tree(&self) -> bool {
        matches!(self.colour, Colour::OfRay(_))
    }

    /// What the view needs to know of rays before it makes colours of them: what they hit first. Quickest for
    /// rays that go together.
    pub fn first_hits(&self, context: &Context, rays: &[Ray], hits: &mut [Option<Hit>]) {
        match self.colour {
            Colour::OfHit(_) => context.intersector.coherent_hits(rays, hits),
            Colour::OfRay(_) => {}
        }
    }

    /// The colour that a ray brings back, in linear RGB, by what [`first_hits`](Self::first_hits) found.
    pub fn radiance(&self, context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
        match self.colour {
            Colour::OfHit(colour) => colour(context, ray, hit),
            Colour::OfRay(colour) => colour(context, ray),
        }
    }
}

/// Every view, in the menu's order.
pub static INTEGRATORS: &[Integrator] = &[
    Integrator {
        name: "shaded",
        title: "Shaded",
        about: "Lit by a studio light that moves with the camera.",
        against: Comparison::Nothing,
        legend: legend::none,
        colour: Colour::OfHit(shaded::radiance),
    },
    Integrator {
        name: "normal",
        title: "Normal",
        about: "The shading normal: x, y, z from −1 to 1 as red, green, blue.",
        against: Comparison::Nothing,
        legend: legend::none,
        colour: Colour::OfHit(views::normal),
    },
    Integrator {
        name: "barycentric",
        title: "Barycentric",
        about: "The weights of the three corners as red, green, blue.",
        against: Comparison::Nothing,
        legend: legend::none,
        colour: Colour::OfHit(views::barycentric),
    },
    Integrator {
        name: "depth",
        title: "Depth",
        about: "Distance from the eye, white at the nearest place of the scene's sphere, dark at the farthest.",
        against: Comparison::Nothing,
        legend: legend::none,
        colour: Colour::OfHit(views::depth),
    },
    Integrator {
        name: "triangle",
        title: "Triangle",
        about: "A colour for each triangle.",
        against: Comparison::Nothing,
        legend: legend::none,
        colour: Colour::OfHit(views::triangle),
    },
    Integrator {
        name: "cost",
        title: "Cost",
        about: "Boxes and triangles tested for the ray, on a logarithmic scale.",
        against: Comparison::Nothing,
        legend: legend::cost,
        colour: Colour::OfRay(views::cost),
    },
    Integrator {
        name: "error-t",
        title: "Error of t",
        about: "By how many ulps of f32 the chosen kernel's t errs, on a logarithmic scale.",
        against: Comparison::Exact,
        legend: legend::error_t,
        colour: Colour::OfHit(compare::error_t),
    },
    Integrator {
        name: "error-barycentric",
        title: "Error of weights",
        about: "By how much the chosen kernel's worst weight errs, on a logarithmic scale.",
        against: Comparison::Exact,
        legend: legend::error_barycentric,
        colour: Colour::OfHit(compare::error_barycentric),
    },
    Integrator {
        name: "disagreement",
        title: "Disagreement",
        about: "Where the chosen kernel and a second one differ about what is hit.",
        against: Comparison::Second,
        legend: legend::decisions,
        colour: Colour::OfHit(compare::disagreement),
    },
];

/// The view of this name.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    INTEGRATORS.iter().find(|view| view.name == name)
}

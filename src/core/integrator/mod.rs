//! Which colour does a ray bring back?
//!
//! One function a view; the table is [`INTEGRATORS`]. Colours are linear RGB.

pub mod palette;
mod shaded;
mod views;

use crate::camera::Camera;
use crate::intersector::Intersector;
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
    radiance: fn(&Context, &Ray) -> Vec3,
}

impl Integrator {
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
        radiance: shaded::radiance,
    },
    Integrator {
        name: "normal",
        title: "Normal",
        about: "The shading normal: x, y, z from −1 to 1 as red, green, blue.",
        radiance: views::normal,
    },
    Integrator {
        name: "barycentric",
        title: "Barycentric",
        about: "The weights of the three corners as red, green, blue.",
        radiance: views::barycentric,
    },
    Integrator {
        name: "depth",
        title: "Depth",
        about: "Distance from the eye, white at the nearest place of the scene's sphere, dark at the farthest.",
        radiance: views::depth,
    },
    Integrator {
        name: "triangle",
        title: "Triangle",
        about: "A colour for each triangle.",
        radiance: views::triangle,
    },
    Integrator {
        name: "cost",
        title: "Cost",
        about: "Boxes and triangles tested for the ray, on a logarithmic scale.",
        radiance: views::cost,
    },
];

/// The view of this name.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    INTEGRATORS.iter().find(|view| view.name == name)
}

//! Surfaces that absorb all light.

use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A surface that absorbs all light, such as the back of a material with one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Black;

pub(super) static BLACK: Model = Model {
    name: "black",
    source: "",
    transmits: false,
    is_specular: true,
    is_reciprocal: true,
    uses_point: false,
    uses_choice: false,
    examples: || vec![Bsdf::Black(Black)],
};

impl Scatter for Black {
    fn model(&self) -> &'static Model {
        &BLACK
    }

    fn colour(&self) -> Vec3 {
        Vec3::ZERO
    }

    fn evaluate(&self, _: Vec3, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    fn sample(&self, _: Vec3, _: Vec2, _: f32) -> Option<Scattered> {
        None
    }

    fn density(&self, _: Vec3, _: Vec3) -> f32 {
        0.0
    }
}

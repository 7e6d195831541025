//! How surfaces scatter light: one file a model.
//!
//! Directions are unit vectors in the frame of the shading normal, its z axis; both point away from the surface. To add
//! a model, write its file, and add it to [`Bsdf`] and an example of it to [`MODELS`], with which one suite of tests
//! checks reciprocity, energy and sampling.

mod diffuse;
mod frame;

pub use diffuse::Diffuse;
pub(crate) use diffuse::cosine_direction;
pub use frame::Frame;

use glam::{Vec2, Vec3};

/// A way to scatter light.
pub trait Scatter {
    /// The BSDF times |cos θ| of the incoming direction, for light that comes from `incoming` and leaves to `outgoing`.
    /// Zero where the model scatters into single directions only.
    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3;

    /// An incoming direction for the given outgoing one; `None` if the light ends here. `at` and `choice` are uniform
    /// numbers in [0, 1).
    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered>;

    /// The probability density of [`sample`](Self::sample) per solid angle, 0 for single directions.
    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32;
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The direction that the light comes from.
    pub incoming: Vec3,
    /// The BSDF times |cos θ|, divided by the density.
    pub weight: Vec3,
    /// The probability density per solid angle; `None` for a single direction, as of a mirror.
    pub density: Option<f32>,
}

/// Any model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Lambert's.
    Diffuse(Diffuse),
    /// Absorbs all light.
    Black,
}

impl Scatter for Bsdf {
    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        match self {
            Self::Diffuse(model) => model.evaluate(outgoing, incoming),
            Self::Black => Vec3::ZERO,
        }
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        match self {
            Self::Diffuse(model) => model.sample(outgoing, at, choice),
            Self::Black => None,
        }
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        match self {
            Self::Diffuse(model) => model.density(outgoing, incoming),
            Self::Black => 0.0,
        }
    }
}

/// A model of the table.
pub struct Model {
    /// The name.
    pub name: &'static str,
    /// Author, title, year.
    pub source: &'static str,
    /// Whether light passes through.
    pub transmits: bool,
    /// Whether exchanging both directions gives the same BSDF. Refraction scales it by the square of the index.
    pub is_reciprocal: bool,
    /// Examples, ordinary and extreme.
    pub examples: fn() -> Vec<Bsdf>,
}

/// All models.
pub static MODELS: &[&Model] = &[&diffuse::DIFFUSE];

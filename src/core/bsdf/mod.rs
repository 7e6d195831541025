//! How surfaces scatter light: one file per model.
//!
//! Directions are unit vectors in the frame of the shading normal, its z axis; both point away from the surface. To add
//! a model, write its file with its row, and add it to [`Bsdf`] and to [`MODELS`], with whose examples one suite of tests
//! checks reciprocity, energy and sampling.

mod black;
mod coat;
mod conductor;
mod dielectric;
mod diffuse;
mod frame;
mod metal_rough;
mod microfacets;
mod optics;
mod phong;
mod plastic;
mod polished;
mod rough_conductor;
mod rough_dielectric;
mod rough_plastic;
mod textured;
mod thin_dielectric;

pub use black::Black;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub(crate) use diffuse::cosine_direction;
pub use frame::Frame;
pub use metal_rough::MetalRough;
pub use microfacets::{Law, Microfacets};
pub use phong::Phong;
pub use plastic::Plastic;
pub use polished::{Gain, Polished};
pub use rough_conductor::RoughConductor;
pub use rough_dielectric::RoughDielectric;
pub use rough_plastic::RoughPlastic;
pub use textured::Slot;
pub use thin_dielectric::ThinDielectric;

use glam::{Vec2, Vec3};

/// A way to scatter light.
pub trait Scatter {
    /// The model's row of the table.
    fn model(&self) -> &'static Model;

    /// A colour for views without global light: about the part of light from everywhere that the surface reflects or lets
    /// pass.
    fn colour(&self) -> Vec3;

    /// The BSDF times |cos θ| of the incoming direction, for light that comes from `incoming` and leaves to `outgoing`.
    /// Zero where the model scatters into single directions only.
    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3;

    /// An incoming direction for the given outgoing one; `None` if the light ends here. `at` and `choice` are uniform
    /// numbers in [0, 1).
    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered>;

    /// The probability density of [`sample`](Self::sample) per solid angle, 0 for single directions.
    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32;

    /// [`evaluate`](Self::evaluate) and [`density`](Self::density), which have much in common.
    fn evaluate_with_density(&self, outgoing: Vec3, incoming: Vec3) -> (Vec3, f32) {
        let value = self.evaluate(outgoing, incoming);
        (value, self.density(outgoing, incoming))
    }

    /// The single directions that the light may come from, as by a mirror, each with the part of light that it scatters.
    /// [`sample`](Self::sample) chooses among them and the other directions.
    fn single_directions(&self, _outgoing: Vec3) -> [Option<Scattered>; 2] {
        [None, None]
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The direction that the light comes from.
    pub incoming: Vec3,
    /// The BSDF times |cos θ|, divided by the density. Light that is refracted is scaled by 1/`eta`².
    pub weight: Vec3,
    /// The probability density per solid angle; `None` for a single direction, as of a mirror.
    pub density: Option<f32>,
    /// The index of refraction where the light comes from, relative to where it leaves to; 1 unless it is refracted.
    pub eta: f32,
}

impl Scattered {
    /// A direction without refraction.
    fn reflected(incoming: Vec3, weight: Vec3, density: Option<f32>) -> Self {
        Self {
            incoming,
            weight,
            density,
            eta: 1.0,
        }
    }

    /// The same direction with a part of the light.
    fn scaled(self, part: f32) -> Self {
        Self {
            weight: part * self.weight,
            ..self
        }
    }

    /// A direction without refraction that one of several lobes sampled; `None` if its density is 0.
    fn by_density(model: &impl Scatter, outgoing: Vec3, incoming: Vec3) -> Option<Self> {
        let density = model.density(outgoing, incoming);
        (density > 0.0).then(|| {
            let weight = model.evaluate(outgoing, incoming) / density;
            Self::reflected(incoming, weight, Some(density))
        })
    }
}

/// Any model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Absorbs all light.
    Black(Black),
    /// Lambert's.
    Diffuse(Diffuse),
    /// A smooth metal or a mirror.
    Conductor(Conductor),
    /// A rough metal.
    RoughConductor(RoughConductor),
    /// The surface of a transparent medium.
    Dielectric(Dielectric),
    /// The rough surface of a transparent medium.
    RoughDielectric(RoughDielectric),
    /// A thin pane.
    ThinDielectric(ThinDielectric),
    /// Smooth plastic.
    Plastic(Plastic),
    /// Rough plastic.
    RoughPlastic(RoughPlastic),
    /// Diffuse with a glossy highlight.
    Phong(Phong),
    /// Diffuse with a mirror.
    Polished(Polished),
    /// By base colour, metalness and roughness.
    MetalRough(MetalRough),
}

/// Calls a method of the model.
macro_rules! of_model {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Bsdf::Black($model) => $call,
            Bsdf::Diffuse($model) => $call,
            Bsdf::Conductor($model) => $call,
            Bsdf::RoughConductor($model) => $call,
            Bsdf::Dielectric($model) => $call,
            Bsdf::RoughDielectric($model) => $call,
            Bsdf::ThinDielectric($model) => $call,
            Bsdf::Plastic($model) => $call,
            Bsdf::RoughPlastic($model) => $call,
            Bsdf::Phong($model) => $call,
            Bsdf::Polished($model) => $call,
            Bsdf::MetalRough($model) => $call,
        }
    };
}

impl Scatter for Bsdf {
    #[inline]
    fn model(&self) -> &'static Model {
        of_model!(self, model => model.model())
    }

    fn colour(&self) -> Vec3 {
        of_model!(self, model => model.colour())
    }

    #[inline]
    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        of_model!(self, model => model.evaluate(outgoing, incoming))
    }

    #[inline]
    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        of_model!(self, model => model.sample(outgoing, at, choice))
    }

    #[inline]
    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        of_model!(self, model => model.density(outgoing, incoming))
    }

    #[inline]
    fn evaluate_with_density(&self, outgoing: Vec3, incoming: Vec3) -> (Vec3, f32) {
        of_model!(self, model => model.evaluate_with_density(outgoing, incoming))
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        of_model!(self, model => model.single_directions(outgoing))
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
    /// Whether all light is scattered into single directions or absorbed, so that no light can be aimed at.
    pub is_specular: bool,
    /// Whether exchanging both directions gives the same BSDF. Refraction scales it by the square of the index.
    pub is_reciprocal: bool,
    /// Whether [`Scatter::sample`] uses its point `at`.
    pub uses_point: bool,
    /// Whether it uses the number `choice`.
    pub uses_choice: bool,
    /// Examples, ordinary and extreme.
    pub examples: fn() -> Vec<Bsdf>,
}

/// All models.
pub static MODELS: &[&Model] = &[
    &black::BLACK,
    &diffuse::DIFFUSE,
    &conductor::CONDUCTOR,
    &rough_conductor::ROUGH_CONDUCTOR,
    &dielectric::DIELECTRIC,
    &rough_dielectric::ROUGH_DIELECTRIC,
    &thin_dielectric::THIN_DIELECTRIC,
    &plastic::PLASTIC,
    &rough_plastic::ROUGH_PLASTIC,
    &phong::PHONG,
    &polished::POLISHED,
    &metal_rough::METAL_ROUGH,
];

#[cfg(test)]
mod tests;

//! Smooth plastic: a diffuse base below a smooth, transparent coat.
//!
//! Light that enters the coat is reflected between base and coat any number of times before it leaves.
//!
//! Source: Wolff, "Diffuse-reflectance model for smooth dielectric surfaces", JOSA A 11(11), 1994; the documentation of
//! Mitsuba's `plastic`.

use super::coat::{below_coat, probability};
use super::diffuse::{cosine_density, cosine_direction};
use super::optics::{Interface, diffuse_reflectance, mirrored};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// Smooth plastic. Its back is black.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// The reflectance of the base; at most 1.
    pub diffuse: Vec3,
    /// Multiplies the light that the coat reflects; at most 1.
    pub specular: Vec3,
    /// The index of refraction of the coat, relative to that in front of it.
    eta: f32,
    /// The part of the light from the base that the coat reflects back.
    inner_reflectance: f32,
    /// Whether light gains colour each time that the base reflects it.
    is_nonlinear: bool,
}

impl Plastic {
    /// Plastic with a coat of a relative index of refraction. If `is_nonlinear`, light gains colour each time that the
    /// base reflects it.
    pub fn new(diffuse: Vec3, specular: Vec3, eta: f32, is_nonlinear: bool) -> Self {
        Self {
            diffuse,
            specular,
            eta,
            inner_reflectance: diffuse_reflectance(1.0 / eta),
            is_nonlinear,
        }
    }

    fn coat(&self, cos: f32) -> f32 {
        Interface::at(cos, self.eta).reflectance
    }

    /// The probability of sampling the coat.
    fn coat_probability(&self, outgoing: Vec3) -> f32 {
        let coat = self.coat(outgoing.z);
        probability(coat * self.specular, (1.0 - coat) * self.diffuse)
    }
}

pub(super) static PLASTIC: Model = Model {
    name: "plastic",
    source: "Wolff, Diffuse-reflectance model for smooth dielectric surfaces, 1994",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: true,
    examples: || {
        let red = Vec3::new(0.7, 0.2, 0.1);
        vec![
            Bsdf::Plastic(Plastic::new(red, Vec3::ONE, 1.49, false)),
            Bsdf::Plastic(Plastic::new(red, Vec3::ONE, 1.9, true)),
            Bsdf::Plastic(Plastic::new(Vec3::ONE, Vec3::ONE, 1.5, true)),
        ]
    },
};

impl Scatter for Plastic {
    fn model(&self) -> &'static Model {
        &PLASTIC
    }

    fn colour(&self) -> Vec3 {
        self.diffuse
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        let cosine = cosine_density(outgoing, incoming);
        if cosine == 0.0 {
            return Vec3::ZERO;
        }
        let entering = (1.0 - self.coat(outgoing.z)) * (1.0 - self.coat(incoming.z));
        let base = below_coat(
            self.diffuse,
            self.inner_reflectance,
            self.eta,
            self.is_nonlinear,
        );
        entering * cosine * base
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        if outgoing.z <= 0.0 {
            return None;
        }
        let probability = self.coat_probability(outgoing);
        if choice < probability {
            let weight = self.coat(outgoing.z) * self.specular / probability;
            return Some(Scattered::reflected(mirrored(outgoing), weight, None));
        }
        let incoming = cosine_direction(at);
        Scattered::by_density(self, outgoing, incoming)
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let cosine = cosine_density(outgoing, incoming);
        if cosine == 0.0 {
            return 0.0;
        }
        (1.0 - self.coat_probability(outgoing)) * cosine
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        let mirrored = (outgoing.z > 0.0).then(|| {
            let weight = self.coat(outgoing.z) * self.specular;
            Scattered::reflected(mirrored(outgoing), weight, None)
        });
        [mirrored, None]
    }
}

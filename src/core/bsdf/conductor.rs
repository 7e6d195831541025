//! Smooth metals and mirrors.
//!
//! Source: Fresnel's equations for a complex index; see `optics`.

use super::optics::{mirrored, of_metal};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A smooth metal. Its back is black.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// The real part of the index of refraction, relative to the medium around the metal, for red, green and blue.
    pub eta: Vec3,
    /// The imaginary part, the extinction coefficient.
    pub k: Vec3,
    /// Multiplies the reflected light; at most 1.
    pub reflectance: Vec3,
}

impl Conductor {
    /// A mirror that reflects this part of the light at all angles.
    pub fn mirror(reflectance: Vec3) -> Self {
        Self {
            eta: Vec3::ZERO,
            k: Vec3::ONE,
            reflectance,
        }
    }

    /// The part of light that is reflected at an angle with this cosine.
    pub(super) fn reflected_part(&self, cos: f32) -> Vec3 {
        self.reflectance * of_metal(cos, self.eta, self.k)
    }
}

pub(super) static CONDUCTOR: Model = Model {
    name: "conductor",
    source: "Fresnel's equations; Born, Wolf, Principles of Optics, 1999",
    transmits: false,
    is_specular: true,
    is_reciprocal: true,
    uses_point: false,
    uses_choice: false,
    examples: || {
        let metal = Conductor {
            eta: Vec3::new(0.2, 0.92, 1.1),
            k: Vec3::new(3.91, 2.45, 2.14),
            reflectance: Vec3::ONE,
        };
        [metal, Conductor::mirror(Vec3::ONE)]
            .map(Bsdf::Conductor)
            .to_vec()
    },
};

impl Scatter for Conductor {
    fn model(&self) -> &'static Model {
        &CONDUCTOR
    }

    fn colour(&self) -> Vec3 {
        self.reflected_part(1.0)
    }

    fn evaluate(&self, _: Vec3, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    fn sample(&self, outgoing: Vec3, _: Vec2, _: f32) -> Option<Scattered> {
        self.single_directions(outgoing)[0]
    }

    fn density(&self, _: Vec3, _: Vec3) -> f32 {
        0.0
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        let mirrored = (outgoing.z > 0.0).then(|| {
            let weight = self.reflected_part(outgoing.z);
            Scattered::reflected(mirrored(outgoing), weight, None)
        });
        [mirrored, None]
    }
}

//! Smooth interfaces of transparent media, such as glass and air.
//!
//! Source: Snell's law and Fresnel's equations; see `optics`. The scale of refracted light: Veach, "Robust Monte Carlo
//! Methods for Light Transport Simulation", 1997, 5.2.

use super::optics::{Interface, mirrored};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A smooth interface to a transparent medium behind the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// The index of refraction behind the surface, relative to that in front of it; positive.
    pub eta: f32,
    /// Multiplies reflected light; at most 1.
    pub reflectance: Vec3,
    /// Multiplies refracted light; at most 1.
    pub transmittance: Vec3,
}

pub(super) static DIELECTRIC: Model = Model {
    name: "dielectric",
    source: "Snell's law and Fresnel's equations; Born, Wolf, Principles of Optics, 1999",
    transmits: true,
    is_specular: true,
    is_reciprocal: true,
    uses_point: false,
    uses_choice: true,
    examples: || {
        let of_index = |eta| Dielectric {
            eta,
            reflectance: Vec3::ONE,
            transmittance: Vec3::ONE,
        };
        [of_index(1.5), of_index(0.75), of_index(1.0)]
            .map(Bsdf::Dielectric)
            .to_vec()
    },
};

/// The index beyond the surface relative to that on the side of a direction.
pub(super) fn index_beyond(eta: f32, outgoing: Vec3) -> f32 {
    if outgoing.z > 0.0 { eta } else { 1.0 / eta }
}

impl Dielectric {
    fn reflection(&self, outgoing: Vec3) -> Scattered {
        Scattered::reflected(mirrored(outgoing), self.reflectance, None)
    }

    /// Refracted radiance grows with the square of the index of its medium, as it is compressed into a smaller solid angle.
    fn refraction(&self, outgoing: Vec3, interface: Interface, eta: f32) -> Scattered {
        let z = -interface.cos_beyond.copysign(outgoing.z);
        Scattered {
            incoming: Vec3::new(-outgoing.x / eta, -outgoing.y / eta, z),
            weight: self.transmittance / (eta * eta),
            density: None,
            eta,
        }
    }
}

impl Scatter for Dielectric {
    fn model(&self) -> &'static Model {
        &DIELECTRIC
    }

    fn colour(&self) -> Vec3 {
        self.transmittance
    }

    fn evaluate(&self, _: Vec3, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    fn sample(&self, outgoing: Vec3, _: Vec2, choice: f32) -> Option<Scattered> {
        let eta = index_beyond(self.eta, outgoing);
        let interface = Interface::at(outgoing.z.abs(), eta);
        Some(if choice < interface.reflectance {
            self.reflection(outgoing)
        } else {
            self.refraction(outgoing, interface, eta)
        })
    }

    fn density(&self, _: Vec3, _: Vec3) -> f32 {
        0.0
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        let eta = index_beyond(self.eta, outgoing);
        let interface = Interface::at(outgoing.z.abs(), eta);
        let reflected = self.reflection(outgoing).scaled(interface.reflectance);
        let refracted = (interface.reflectance < 1.0).then(|| {
            let refracted = self.refraction(outgoing, interface, eta);
            refracted.scaled(1.0 - interface.reflectance)
        });
        [Some(reflected), refracted]
    }
}

//! Thin panes of glass: light passes straight on.
//!
//! Source: Stokes, "On the Intensity of the Light Reflected from or Transmitted through a Pile of Plates", 1862: the sum
//! over all reflections between both faces of a pane.

use super::optics::{Interface, mirrored};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A pane that is thin compared to everything else, with the same medium on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    /// The index of refraction of the pane, relative to that of the medium around it; positive.
    pub eta: f32,
    /// Multiplies reflected light; at most 1.
    pub reflectance: Vec3,
    /// Multiplies light that passes; at most 1.
    pub transmittance: Vec3,
}

pub(super) static THIN_DIELECTRIC: Model = Model {
    name: "thin dielectric",
    source: "Stokes, On the Intensity of the Light Reflected from or Transmitted through a Pile of Plates, 1862",
    transmits: true,
    is_specular: true,
    is_reciprocal: true,
    uses_point: false,
    uses_choice: true,
    examples: || {
        let of_index = |eta| ThinDielectric {
            eta,
            reflectance: Vec3::ONE,
            transmittance: Vec3::ONE,
        };
        [of_index(1.5), of_index(0.75)]
            .map(Bsdf::ThinDielectric)
            .to_vec()
    },
};

impl ThinDielectric {
    /// The part of light that the pane reflects. Of the light that enters, the second face reflects r, the first one r of
    /// that, and so on.
    fn reflected_part(&self, outgoing: Vec3) -> f32 {
        let r = Interface::at(outgoing.z.abs(), self.eta).reflectance;
        2.0 * r / (1.0 + r)
    }

    fn reflection(&self, outgoing: Vec3) -> Scattered {
        Scattered::reflected(mirrored(outgoing), self.reflectance, None)
    }

    fn passage(&self, outgoing: Vec3) -> Scattered {
        Scattered::reflected(-outgoing, self.transmittance, None)
    }
}

impl Scatter for ThinDielectric {
    fn model(&self) -> &'static Model {
        &THIN_DIELECTRIC
    }

    fn colour(&self) -> Vec3 {
        self.transmittance
    }

    fn evaluate(&self, _: Vec3, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    fn sample(&self, outgoing: Vec3, _: Vec2, choice: f32) -> Option<Scattered> {
        Some(if choice < self.reflected_part(outgoing) {
            self.reflection(outgoing)
        } else {
            self.passage(outgoing)
        })
    }

    fn density(&self, _: Vec3, _: Vec3) -> f32 {
        0.0
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        let reflected = self.reflected_part(outgoing);
        [
            Some(self.reflection(outgoing).scaled(reflected)),
            Some(self.passage(outgoing).scaled(1.0 - reflected)),
        ]
    }
}

//! Diffuse surfaces that also reflect as a mirror: the MTL format's `illum` 3 and 5.
//!
//! Source: Alias|Wavefront, "MTL material format", Appendix B1 of the Advanced Visualizer Manual, 1995; Whitted, "An
//! Improved Illumination Model for Shaded Display", CACM 23(6), 1980.

use super::coat::probability;
use super::diffuse::{cosine_density, cosine_direction};
use super::optics::{mirrored, schlick};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A diffuse part and a mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polished {
    diffuse: Vec3,
    specular: Vec3,
    gain: Gain,
}

/// How the reflectance of the mirror depends on the angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gain {
    /// Not at all.
    Constant,
    /// It grows to 1 at grazing angles; the diffuse part shrinks.
    Fresnel,
}

impl Polished {
    /// Both reflectances are scaled down if they reflect more light than arrives.
    pub fn new(diffuse: Vec3, specular: Vec3, gain: Gain) -> Self {
        let sum = match gain {
            Gain::Constant => diffuse + specular,
            Gain::Fresnel => diffuse.max(specular),
        };
        let scale = sum.max_element().max(1.0);
        Self {
            diffuse: diffuse / scale,
            specular: specular / scale,
            gain,
        }
    }

    fn mirror(&self, cos: f32) -> Vec3 {
        match self.gain {
            Gain::Constant => self.specular,
            Gain::Fresnel => schlick(cos, self.specular),
        }
    }

    /// The part of light that reaches the diffuse surface, or leaves it.
    fn passing(&self, cos: f32) -> Vec3 {
        match self.gain {
            Gain::Constant => Vec3::ONE,
            Gain::Fresnel => 1.0 - self.mirror(cos),
        }
    }

    fn mirror_probability(&self, cos: f32) -> f32 {
        probability(self.mirror(cos), self.passing(cos) * self.diffuse)
    }
}

pub(super) static POLISHED: Model = Model {
    name: "polished",
    source: "Whitted, An Improved Illumination Model for Shaded Display, 1980",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: true,
    examples: || {
        let of = |kd, ks, gain| {
            Bsdf::Polished(Polished::new(
                Vec3::new(kd, 0.2, 0.1),
                Vec3::splat(ks),
                gain,
            ))
        };
        vec![
            of(0.5, 0.3, Gain::Constant),
            of(0.9, 0.9, Gain::Constant),
            of(1.0, 0.05, Gain::Fresnel),
            of(0.0, 1.0, Gain::Fresnel),
        ]
    },
};

impl Scatter for Polished {
    fn model(&self) -> &'static Model {
        &POLISHED
    }

    fn colour(&self) -> Vec3 {
        self.passing(1.0) * self.diffuse + self.specular
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        let cosine = cosine_density(outgoing, incoming);
        if cosine == 0.0 {
            return Vec3::ZERO;
        }
        self.diffuse * cosine * self.passing(outgoing.z) * self.passing(incoming.z)
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        if outgoing.z <= 0.0 {
            return None;
        }
        let probability = self.mirror_probability(outgoing.z);
        if choice < probability {
            let weight = self.mirror(outgoing.z) / probability;
            return Some(Scattered::reflected(mirrored(outgoing), weight, None));
        }
        Scattered::by_density(self, outgoing, cosine_direction(at))
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let cosine = cosine_density(outgoing, incoming);
        if cosine == 0.0 {
            return 0.0;
        }
        (1.0 - self.mirror_probability(outgoing.z)) * cosine
    }

    fn single_directions(&self, outgoing: Vec3) -> [Option<Scattered>; 2] {
        let mirrored = (outgoing.z > 0.0).then(|| {
            let weight = self.mirror(outgoing.z);
            Scattered::reflected(mirrored(outgoing), weight, None)
        });
        [mirrored, None]
    }
}

//! Surfaces by base colour, metalness and roughness: the MTL format's `Kd`, `Pm` and `Pr`.
//!
//! Sources: Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course; Khronos, glTF 2.0, appendix B. Differs from
//! them: light is lost to the highlight both when it enters the diffuse part and when it leaves, so that no more is
//! reflected than arrives.

use super::coat::{self, probability};
use super::diffuse::cosine_density;
use super::microfacets::{Law, Microfacets};
use super::optics::schlick;
use super::rough_conductor::{facet_reflection, reflecting};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A mixture of a metal and a diffuse surface with a colourless highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetalRough {
    /// The reflectance of the diffuse part.
    diffuse: Vec3,
    /// The reflectance of facets along their normals.
    normal: Vec3,
    facets: Microfacets,
}

/// What surfaces other than metals reflect along the normal: an index of refraction of 1.5.
const OF_INSULATORS: f32 = 0.04;

impl MetalRough {
    /// A surface of a colour. Metalness and roughness are clamped to 0…1.
    pub fn new(colour: Vec3, metalness: f32, roughness: f32) -> Self {
        let metalness = metalness.clamp(0.0, 1.0);
        let roughness = roughness.clamp(0.0, 1.0);
        Self {
            diffuse: (1.0 - metalness) * colour,
            normal: Vec3::splat(OF_INSULATORS).lerp(colour, metalness),
            facets: Microfacets::new(Law::Ggx, roughness * roughness),
        }
    }

    fn passing(&self, cos: f32) -> Vec3 {
        1.0 - schlick(cos, self.normal)
    }

    fn highlight_probability(&self, outgoing: Vec3) -> f32 {
        let highlight = schlick(outgoing.z, self.normal);
        probability(highlight, (1.0 - highlight) * self.diffuse)
    }
}

pub(super) static METAL_ROUGH: Model = Model {
    name: "metal-rough",
    source: "Burley, Physically Based Shading at Disney, 2012",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: true,
    examples: || {
        let of = |colour, metalness, roughness| {
            Bsdf::MetalRough(MetalRough::new(colour, metalness, roughness))
        };
        let gold = Vec3::new(1.0, 0.77, 0.34);
        vec![
            of(gold, 1.0, 0.3),
            of(gold, 0.5, 0.5),
            of(Vec3::ONE, 0.0, 1.0),
            of(Vec3::ONE, 0.0, 0.3),
        ]
    },
};

impl Scatter for MetalRough {
    fn model(&self) -> &'static Model {
        &METAL_ROUGH
    }

    fn colour(&self) -> Vec3 {
        self.diffuse + self.normal
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        let Some(m) = reflecting(outgoing, incoming) else {
            return Vec3::ZERO;
        };
        let highlight = schlick(outgoing.dot(m), self.normal);
        let passing = self.passing(outgoing.z) * self.passing(incoming.z);
        facet_reflection(&self.facets, outgoing, incoming, m) * highlight
            + cosine_density(outgoing, incoming) * passing * self.diffuse
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        let is_reflected = choice < self.highlight_probability(outgoing);
        let incoming = coat::sample_direction(&self.facets, outgoing, at, is_reflected)?;
        Scattered::by_density(self, outgoing, incoming)
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let probability = self.highlight_probability(outgoing);
        coat::density(&self.facets, outgoing, incoming, probability)
    }
}

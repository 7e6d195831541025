//! Rough plastic: a diffuse base below a rough, transparent coat.
//!
//! Source: the documentation of Mitsuba's `roughplastic`; the base is that of `plastic`, the coat is made of microfacets
//! as in Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007.

use super::coat;
use super::diffuse::cosine_density;
use super::microfacets::{Law, Microfacets};
use super::optics::{Interface, reflected};
use super::plastic::{below_coat, probability};
use super::rough_conductor::{facet_reflection, reflecting};
use super::{Bsdf, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// Rough plastic. Its back is black.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughPlastic {
    /// The reflectance of the base; at most 1.
    pub diffuse: Vec3,
    /// Multiplies the light that the coat reflects; at most 1.
    pub specular: Vec3,
    /// The index of refraction of the coat, relative to that in front of it.
    eta: f32,
    facets: Microfacets,
    /// The part of light that the coat lets in, by the square root of the cosine.
    transmittance: [f32; KNOTS],
    /// The part of the light from the base that the coat reflects back.
    inner_reflectance: f32,
    /// Whether light gains colour each time that the base reflects it.
    is_nonlinear: bool,
}

/// Straight lines between as many differ from the transmittance by at most 0.004 for roughnesses from 0.05; for smaller
/// ones by at most 0.04, below cosines of 0.02.
const KNOTS: usize = 24;

impl RoughPlastic {
    /// Plastic with a coat of a relative index of refraction. If `is_nonlinear`, light gains colour each time that the
    /// base reflects it. Integrates numerically, which takes up to 0.1 seconds.
    pub fn new(
        diffuse: Vec3,
        specular: Vec3,
        eta: f32,
        facets: Microfacets,
        is_nonlinear: bool,
    ) -> Self {
        let transmittance = std::array::from_fn(|k| {
            let root = k as f32 / (KNOTS - 1) as f32;
            1.0 - coat_reflectance(&facets, (root * root).max(1e-6), eta)
        });
        Self {
            diffuse,
            specular,
            eta,
            facets,
            transmittance,
            inner_reflectance: inner_reflectance(&facets, eta),
            is_nonlinear,
        }
    }

    fn transmittance(&self, cos: f32) -> f32 {
        let at = cos.clamp(0.0, 1.0).sqrt() * (KNOTS - 1) as f32;
        let k = (at as usize).min(KNOTS - 2);
        let part = at - k as f32;
        (1.0 - part) * self.transmittance[k] + part * self.transmittance[k + 1]
    }

    /// The probability of sampling the coat.
    fn coat_probability(&self, outgoing: Vec3) -> f32 {
        let entering = self.transmittance(outgoing.z);
        probability((1.0 - entering) * self.specular, entering * self.diffuse)
    }
}

/// The part of light at an angle with this cosine that facets reflect back to their side.
fn coat_reflectance(facets: &Microfacets, cos: f32, eta: f32) -> f32 {
    const N: usize = 32;
    let v = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let centre = |k: usize| (k as f32 + 0.5) / N as f32;
    let part = |k: usize| {
        let m = facets.sample_visible(v, Vec2::new(centre(k % N), centre(k / N)));
        let incoming = reflected(v, m);
        if incoming.z <= 0.0 {
            return 0.0;
        }
        let reflectance = Interface::at(v.dot(m).clamp(0.0, 1.0), eta).reflectance;
        f64::from(reflectance * facets.visible_part(incoming, m))
    };
    ((0..N * N).map(part).sum::<f64>() / (N * N) as f64) as f32
}

/// The part of diffuse light from below that facets reflect back.
fn inner_reflectance(facets: &Microfacets, eta: f32) -> f32 {
    const N: usize = 32;
    let part = |k: usize| {
        let cos = (k as f32 + 0.5) / N as f32;
        2.0 * cos * coat_reflectance(facets, cos, 1.0 / eta)
    };
    (0..N).map(part).sum::<f32>() / N as f32
}

pub(super) static ROUGH_PLASTIC: Model = Model {
    name: "rough plastic",
    source: "Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    examples: || {
        let of = |diffuse, eta, law, alpha, is_nonlinear| {
            let facets = Microfacets::new(law, alpha);
            let model = RoughPlastic::new(diffuse, Vec3::ONE, eta, facets, is_nonlinear);
            Bsdf::RoughPlastic(model)
        };
        let red = Vec3::new(0.7, 0.2, 0.1);
        vec![
            of(red, 1.49, Law::Beckmann, 0.1, false),
            of(Vec3::ONE, 1.49, Law::Ggx, 0.2, true),
            of(red, 1.9, Law::Ggx, 0.7, true),
        ]
    },
};

impl Scatter for RoughPlastic {
    fn model(&self) -> &'static Model {
        &ROUGH_PLASTIC
    }

    fn colour(&self) -> Vec3 {
        self.diffuse
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        let Some(m) = reflecting(outgoing, incoming) else {
            return Vec3::ZERO;
        };
        let reflectance = Interface::at(outgoing.dot(m).clamp(0.0, 1.0), self.eta).reflectance;
        let coat = reflectance * facet_reflection(&self.facets, outgoing, incoming, m);
        let entering = self.transmittance(outgoing.z) * self.transmittance(incoming.z);
        let base = below_coat(
            self.diffuse,
            self.inner_reflectance,
            self.eta,
            self.is_nonlinear,
        );
        coat * self.specular + entering * cosine_density(outgoing, incoming) * base
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        let is_reflected = choice < self.coat_probability(outgoing);
        let incoming = coat::sample_direction(&self.facets, outgoing, at, is_reflected)?;
        Scattered::by_density(self, outgoing, incoming)
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let probability = self.coat_probability(outgoing);
        coat::density(&self.facets, outgoing, incoming, probability)
    }
}

//! Rough plastic: a diffuse base below a rough, transparent coat.
//!
//! Sources: the documentation of Mitsuba's `roughplastic`; the base is that of `plastic`, the coat is made of microfacets
//! as in Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007.
//! Light that one facet sends to another is lost, both when it is reflected and when it is refracted.
//!
//! Scene files need the pictures of Mitsuba 3.9.1, so its approximations are kept: the transmittance is a table of 64
//! cosines, between which it is linear, and the light that the coat reflects back is a mean over the same cosines, about
//! 1.5 % below the integral. With Beckmann's law, pictures differ by up to 0.5 %: there, Mitsuba approximates the visible
//! part of facets by a fraction.

use super::coat::{self, below_coat, probability};
use super::diffuse::cosine_density;
use super::microfacets::{Law, Microfacets};
use super::optics::{Interface, reflected, refracted};
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
    /// The part of light that the coat lets in, for cosines from 0 to 1 in equal steps; in units of 1/65535, as each hit
    /// copies the model.
    transmittance: [u16; KNOTS],
    /// The part of the light from the base that the coat reflects back.
    inner_reflectance: f32,
    /// Whether light gains colour each time that the base reflects it.
    is_nonlinear: bool,
}

/// As many as in Mitsuba.
const KNOTS: usize = 64;
/// What stands for 1 in the table.
const UNIT: f32 = 65535.0;

/// The cosine of a knot; positive.
fn cosine(knot: usize) -> f32 {
    (knot as f32 / (KNOTS - 1) as f32).max(1e-6)
}

impl RoughPlastic {
    /// Plastic with a coat of a relative index of refraction. If `is_nonlinear`, light gains colour each time that the
    /// base reflects it. Integrates numerically, which takes about 0.02 seconds.
    pub fn new(
        diffuse: Vec3,
        specular: Vec3,
        eta: f32,
        facets: Microfacets,
        is_nonlinear: bool,
    ) -> Self {
        Self {
            diffuse,
            specular,
            eta,
            facets,
            transmittance: std::array::from_fn(|k| {
                (UNIT * coat_transmittance(&facets, cosine(k), eta)).round() as u16
            }),
            inner_reflectance: inner_reflectance(&facets, eta),
            is_nonlinear,
        }
    }

    fn transmittance(&self, cos: f32) -> f32 {
        let at = cos.clamp(0.0, 1.0) * (KNOTS - 1) as f32;
        let k = (at as usize).min(KNOTS - 2);
        let part = at - k as f32;
        let [low, high] = [k, k + 1].map(|k| f32::from(self.transmittance[k]) / UNIT);
        (1.0 - part) * low + part * high
    }

    /// The probability of sampling the coat.
    fn coat_probability(&self, outgoing: Vec3) -> f32 {
        let entering = self.transmittance(outgoing.z);
        probability((1.0 - entering) * self.specular, entering * self.diffuse)
    }
}

/// A direction at an angle with this cosine to the normal.
fn inclined(cos: f32) -> Vec3 {
    Vec3::new(((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt(), 0.0, cos)
}

/// The part of light at an angle with this cosine that facets refract to the other side.
fn coat_transmittance(facets: &Microfacets, cos: f32, eta: f32) -> f32 {
    let v = inclined(cos);
    facets.visible_mean(v, |m| {
        let interface = Interface::at(v.dot(m).clamp(0.0, 1.0), eta);
        let beyond = refracted(v, m, interface, eta);
        if beyond.z >= 0.0 {
            return 0.0;
        }
        (1.0 - interface.reflectance) * facets.visible_part(beyond, m)
    })
}

/// The part of light at an angle with this cosine that facets reflect back to their side.
fn coat_reflectance(facets: &Microfacets, cos: f32, eta: f32) -> f32 {
    let v = inclined(cos);
    facets.visible_mean(v, |m| {
        let back = reflected(v, m);
        if back.z <= 0.0 {
            return 0.0;
        }
        let reflectance = Interface::at(v.dot(m).clamp(0.0, 1.0), eta).reflectance;
        reflectance * facets.visible_part(back, m)
    })
}

/// The part of diffuse light from below that facets reflect back, as a mean over the knots.
fn inner_reflectance(facets: &Microfacets, eta: f32) -> f32 {
    let part = |k| 2.0 * cosine(k) * coat_reflectance(facets, cosine(k), 1.0 / eta);
    (0..KNOTS).map(part).sum::<f32>() / KNOTS as f32
}

pub(super) static ROUGH_PLASTIC: Model = Model {
    name: "rough plastic",
    source: "Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: true,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_plastic_reflects_what_mitsubas_does() {
        // `eval` of Mitsuba 3.9.1's `roughplastic` with `diffuse_reflectance` 0.5, for the cosines 0.95 and 0.9, 0.5 and
        // 0.7, 0.1 and 0.3, with 2.5 radians between the azimuths.
        use Law::{Beckmann, Ggx};
        let expected = [
            (Ggx, 0.05, false, [0.154837, 0.101809, 0.021041]),
            (Ggx, 0.05, true, [0.099673, 0.061589, 0.012885]),
            (Ggx, 0.2, false, [0.150806, 0.090816, 0.029461]),
            (Ggx, 0.2, true, [0.114961, 0.065033, 0.021841]),
            (Ggx, 0.6, false, [0.080181, 0.057526, 0.023024]),
            (Ggx, 0.6, true, [0.070542, 0.051312, 0.021527]),
            (Beckmann, 0.05, false, [0.142187, 0.103534, 0.018567]),
            (Beckmann, 0.2, false, [0.184971, 0.099774, 0.025449]),
            (Beckmann, 0.6, true, [0.081731, 0.072261, 0.020726]),
        ];
        for (law, alpha, is_nonlinear, expected) in expected {
            let (diffuse, facets) = (Vec3::splat(0.5), Microfacets::new(law, alpha));
            let eta = 1.49 / 1.000277;
            let plastic = RoughPlastic::new(diffuse, Vec3::ONE, eta, facets, is_nonlinear);
            let angles = [(0.95, 0.9), (0.5, 0.7), (0.1, 0.3)];
            for ((cos, other_cos), expected) in angles.into_iter().zip(expected) {
                let (sin, cos_phi) = libm::sincosf(2.5);
                let other = inclined(other_cos);
                let incoming = Vec3::new(other.x * cos_phi, other.x * sin, other.z);
                let found = plastic.evaluate(inclined(cos), incoming).x;
                // The integrals on both sides are exact to 1e-3, and occur three times; with Beckmann's law, Mitsuba's
                // visible part of facets is exact to 0.35 %, and occurs twice.
                let bound = if law == Ggx { 3e-3 } else { 1e-2 };
                let error = (found / expected - 1.0).abs();
                assert!(error < bound, "{law:?} {alpha} {cos}: {found} {expected}");
            }
        }
    }
}

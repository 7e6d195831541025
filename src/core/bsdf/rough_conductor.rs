//! Rough metals and mirrors.
//!
//! Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Cook, Torrance, "A
//! Reflectance Model for Computer Graphics", SIGGRAPH 1981. Light that one facet sends to another is lost.

use super::microfacets::{Law, Microfacets};
use super::optics::reflected;
use super::{Bsdf, Conductor, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A rough metal. Its back is black.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    /// What the facets are made of.
    pub metal: Conductor,
    /// How they are inclined.
    pub facets: Microfacets,
}

pub(super) static ROUGH_CONDUCTOR: Model = Model {
    name: "rough conductor",
    source: "Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: false,
    examples: || {
        let gold = Conductor {
            eta: Vec3::new(0.14, 0.38, 1.44),
            k: Vec3::new(3.98, 2.39, 1.6),
            reflectance: Vec3::ONE,
        };
        let of = |metal, law, alpha| {
            let facets = Microfacets::new(law, alpha);
            Bsdf::RoughConductor(RoughConductor { metal, facets })
        };
        let mirror = Conductor::mirror(Vec3::ONE);
        vec![
            of(gold, Law::Ggx, 0.1),
            of(mirror, Law::Ggx, 0.4),
            of(mirror, Law::Ggx, 1.0),
            of(gold, Law::Beckmann, 0.1),
            of(mirror, Law::Beckmann, 0.5),
        ]
    },
};

/// The normal that reflects each of two directions into the other; on the front.
pub(super) fn halfway(outgoing: Vec3, incoming: Vec3) -> Option<Vec3> {
    let m = (outgoing + incoming).try_normalize()?;
    Some(if m.z < 0.0 { -m } else { m })
}

/// The part of light that facets reflect between two directions on the front, without what they absorb, times the
/// cosine of the incoming direction.
pub(super) fn facet_reflection(
    facets: &Microfacets,
    outgoing: Vec3,
    incoming: Vec3,
    m: Vec3,
) -> f32 {
    let visible = facets.visible_part(outgoing, m) * facets.visible_part(incoming, m);
    facets.area(m) * visible / (4.0 * outgoing.z)
}

/// The density of a direction that a visible facet reflects.
pub(super) fn reflection_density(facets: &Microfacets, outgoing: Vec3, m: Vec3) -> f32 {
    facets.area(m) * facets.visible_part(outgoing, m) / (4.0 * outgoing.z)
}

/// The normal of the facet that reflects between two directions on the front, if both are there.
pub(super) fn reflecting(outgoing: Vec3, incoming: Vec3) -> Option<Vec3> {
    if outgoing.z > 0.0 && incoming.z > 0.0 {
        halfway(outgoing, incoming)
    } else {
        None
    }
}

impl Scatter for RoughConductor {
    fn model(&self) -> &'static Model {
        &ROUGH_CONDUCTOR
    }

    fn colour(&self) -> Vec3 {
        self.metal.colour()
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        let Some(m) = reflecting(outgoing, incoming) else {
            return Vec3::ZERO;
        };
        let geometry = facet_reflection(&self.facets, outgoing, incoming, m);
        geometry * self.metal.reflected_part(outgoing.dot(m))
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, _: f32) -> Option<Scattered> {
        if outgoing.z <= 0.0 {
            return None;
        }
        let m = self.facets.sample_visible(outgoing, at);
        let incoming = reflected(outgoing, m);
        if incoming.z <= 0.0 {
            return None;
        }
        let density = reflection_density(&self.facets, outgoing, m);
        let weight =
            self.facets.visible_part(incoming, m) * self.metal.reflected_part(outgoing.dot(m));
        (density > 0.0).then(|| Scattered::reflected(incoming, weight, Some(density)))
    }

    fn evaluate_with_density(&self, outgoing: Vec3, incoming: Vec3) -> (Vec3, f32) {
        let Some(m) = reflecting(outgoing, incoming) else {
            return (Vec3::ZERO, 0.0);
        };
        let density = reflection_density(&self.facets, outgoing, m);
        let geometry = density * self.facets.visible_part(incoming, m);
        (
            geometry * self.metal.reflected_part(outgoing.dot(m)),
            density,
        )
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let m = reflecting(outgoing, incoming);
        m.map_or(0.0, |m| reflection_density(&self.facets, outgoing, m))
    }
}

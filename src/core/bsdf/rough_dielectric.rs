//! Rough interfaces of transparent media, such as frosted glass.
//!
//! Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007. Light that one facet sends
//! to another is lost.

use super::dielectric::index_beyond;
use super::microfacets::{Law, Microfacets};
use super::optics::{Interface, reflected, refracted};
use super::rough_conductor::halfway;
use super::{Bsdf, Dielectric, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};

/// A rough interface to a transparent medium behind the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    /// What the facets separate.
    pub media: Dielectric,
    /// How they are inclined.
    pub facets: Microfacets,
}

pub(super) static ROUGH_DIELECTRIC: Model = Model {
    name: "rough dielectric",
    source: "Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007",
    transmits: true,
    is_specular: false,
    is_reciprocal: false,
    uses_point: true,
    uses_choice: true,
    examples: || {
        let of = |eta, law, alpha| {
            let media = Dielectric {
                eta,
                reflectance: Vec3::ONE,
                transmittance: Vec3::ONE,
            };
            let facets = Microfacets::new(law, alpha);
            Bsdf::RoughDielectric(RoughDielectric { media, facets })
        };
        vec![
            of(1.5, Law::Ggx, 0.1),
            of(1.5, Law::Ggx, 0.6),
            of(0.75, Law::Ggx, 0.3),
            of(1.5, Law::Beckmann, 0.2),
        ]
    },
};

/// A facet that scatters light between two directions.
struct Facet {
    /// Its normal, on the front.
    m: Vec3,
    /// The part of light that it reflects.
    reflectance: f32,
    /// The index of refraction beyond, relative to that on the side of the outgoing direction.
    eta: f32,
    reflects: bool,
}

impl RoughDielectric {
    fn facet(&self, outgoing: Vec3, incoming: Vec3) -> Option<Facet> {
        let eta = index_beyond(self.media.eta, outgoing);
        let reflects = outgoing.z * incoming.z > 0.0;
        let m = if reflects {
            halfway(outgoing, incoming)?
        } else {
            halfway(outgoing, eta * incoming)?
        };
        let cos = outgoing.dot(m);
        // The facet faces the same sides as the surface does.
        let faces = |dir: Vec3| dir.dot(m) * dir.z > 0.0;
        (faces(outgoing) && faces(incoming)).then(|| Facet {
            m,
            reflectance: Interface::at(cos.abs().min(1.0), eta).reflectance,
            eta,
            reflects,
        })
    }

    /// The density of normals times this is the density of directions that the facet reflects or refracts to, for a normal
    /// seen under |outgoing·m|.
    fn directions_per_normal(facet: &Facet, outgoing: Vec3, incoming: Vec3) -> f32 {
        if facet.reflects {
            return 1.0 / (4.0 * outgoing.dot(facet.m).abs());
        }
        let across = outgoing.dot(facet.m) + facet.eta * incoming.dot(facet.m);
        facet.eta * facet.eta * incoming.dot(facet.m).abs() / (across * across)
    }

    fn density_of(&self, facet: &Facet, outgoing: Vec3, incoming: Vec3) -> f32 {
        let part = if facet.reflects {
            facet.reflectance
        } else {
            1.0 - facet.reflectance
        };
        let normals = self.facets.visible_density(outgoing, facet.m);
        part * normals * Self::directions_per_normal(facet, outgoing, incoming)
    }

    /// The BSDF times the cosine, divided by the density.
    fn weight(&self, facet: &Facet, incoming: Vec3) -> Vec3 {
        let visible = self.facets.visible_part(incoming, facet.m);
        if facet.reflects {
            visible * self.media.reflectance
        } else {
            visible * self.media.transmittance / (facet.eta * facet.eta)
        }
    }
}

impl Scatter for RoughDielectric {
    fn model(&self) -> &'static Model {
        &ROUGH_DIELECTRIC
    }

    fn colour(&self) -> Vec3 {
        self.media.transmittance
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        match self.facet(outgoing, incoming) {
            Some(facet) => {
                self.density_of(&facet, outgoing, incoming) * self.weight(&facet, incoming)
            }
            None => Vec3::ZERO,
        }
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        let eta = index_beyond(self.media.eta, outgoing);
        // From below, the facets look as they do from above in the opposite direction.
        let side = 1f32.copysign(outgoing.z);
        let m = side * self.facets.sample_visible(side * outgoing, at);
        let cos = outgoing.dot(m);
        let interface = Interface::at(cos.clamp(0.0, 1.0), eta);
        let reflects = choice < interface.reflectance;
        let incoming = if reflects {
            reflected(outgoing, m)
        } else {
            refracted(outgoing, m, interface, eta).normalize()
        };
        let facet = Facet {
            m: side * m,
            reflectance: interface.reflectance,
            eta,
            reflects,
        };
        let density = self.density_of(&facet, outgoing, incoming);
        let is_on_side = (outgoing.z * incoming.z > 0.0) == reflects && incoming.z != 0.0;
        (is_on_side && density > 0.0 && density.is_finite()).then(|| Scattered {
            incoming,
            weight: self.weight(&facet, incoming),
            density: Some(density),
            eta: if reflects { 1.0 } else { eta },
        })
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let facet = self.facet(outgoing, incoming);
        facet.map_or(0.0, |facet| self.density_of(&facet, outgoing, incoming))
    }
}

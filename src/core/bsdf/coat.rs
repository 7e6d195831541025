//! Sampling of rough reflection over a diffuse base.

use super::diffuse::{cosine_density, cosine_direction};
use super::microfacets::Microfacets;
use super::optics::reflected;
use super::rough_conductor::{reflecting, reflection_density};
use glam::{Vec2, Vec3};

/// A direction reflected by the facets, or one of the base; `None` behind the surface.
pub(super) fn sample_direction(
    facets: &Microfacets,
    outgoing: Vec3,
    at: Vec2,
    is_reflected: bool,
) -> Option<Vec3> {
    if outgoing.z <= 0.0 {
        return None;
    }
    Some(if is_reflected {
        reflected(outgoing, facets.sample_visible(outgoing, at))
    } else {
        cosine_direction(at)
    })
}

/// The density of [`sample_direction`] if a direction is reflected with a probability.
pub(super) fn density(
    facets: &Microfacets,
    outgoing: Vec3,
    incoming: Vec3,
    probability: f32,
) -> f32 {
    let Some(m) = reflecting(outgoing, incoming) else {
        return 0.0;
    };
    probability * reflection_density(facets, outgoing, m)
        + (1.0 - probability) * cosine_density(outgoing, incoming)
}

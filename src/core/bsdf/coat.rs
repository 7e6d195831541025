//! Shared parts of the models of a coat over a base: the choice between the two, the light that the base returns, and
//! sampling of a rough coat over a diffuse base.

use super::diffuse::{cosine_density, cosine_direction};
use super::microfacets::Microfacets;
use super::optics::reflected;
use super::rough_conductor::{reflecting, reflection_density};
use glam::{Vec2, Vec3};

/// The probability of the first of two lobes with these weights; 0 if both are black.
pub(super) fn probability(first: Vec3, second: Vec3) -> f32 {
    let (first, second) = (first.element_sum(), second.element_sum());
    let sum = first + second;
    if sum > 0.0 { first / sum } else { 0.0 }
}

/// The reflectance of a diffuse base below a coat of relative index `eta` that reflects the part `inner` of the base's
/// light back to it: the sum over all reflections between the two, divided by `eta`² because light spreads as it leaves
/// the medium. If `is_nonlinear`, every reflection by the base colours the light; else only the last one does.
pub(super) fn below_coat(diffuse: Vec3, inner: f32, eta: f32, is_nonlinear: bool) -> Vec3 {
    let back = if is_nonlinear {
        inner * diffuse
    } else {
        Vec3::splat(inner)
    };
    diffuse / ((1.0 - back) * (eta * eta))
}

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

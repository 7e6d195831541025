//! The view *Triangle*.

use super::palette::id_colour;
use super::{Context, Integrator, Needs, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static TRIANGLE: Integrator = Integrator {
    name: "triangle",
    title: "Triangle",
    about: "A colour for each triangle or other primitive.",
    needs: Needs::NOTHING,
    legend: Vec::new,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, _: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    hit.map_or(context.background, |hit| id_colour(hit.primitive))
}

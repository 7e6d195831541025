//! The view *Direct light*: light that reaches surfaces straight from the lights.

use super::path::follow;
use super::{Context, Integrator, Needs, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static DIRECT: Integrator = Integrator {
    name: "direct",
    title: "Direct light",
    about: "Light from the lights, without light by way of other surfaces.",
    needs: Needs::LIGHTS,
    legend: Vec::new,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    follow(context, ray, hit, sampler, limit(context), &mut ())
}

/// The most surfaces on a path.
pub(super) fn limit(_context: &Context) -> Option<u32> {
    Some(1)
}

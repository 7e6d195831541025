//! The view *Path*: global illumination.
//!
//! Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; next event estimation and its weights: Veach, "Robust Monte
//! Carlo Methods for Light Transport Simulation", 1997.

use super::transport::{ShadingPoint, emitted, from_afar};
use super::{Context, Integrator, Needs};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static PATH: Integrator = Integrator {
    name: "path",
    title: "Path tracing",
    about: "Light from the lights and by way of other surfaces.",
    needs: Needs::PATHS,
    legend: Vec::new,
    radiance,
};

/// Surfaces on a path before Russian roulette may end it.
const SURE_SURFACES: u32 = 4;
/// The largest probability of going on, so that paths between white surfaces end.
const MOST_LIKELY: f32 = 0.95;

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    follow(context, ray, hit, sampler, context.lighting.depth_limit)
}

/// The light that arrives along a camera's ray by way of at most `limit` surfaces; the background if the ray hits nothing
/// and there is no environment.
pub(super) fn follow(
    context: &Context,
    ray: &Ray,
    hit: Option<Hit>,
    sampler: &mut Sampler,
    limit: Option<u32>,
) -> Vec3 {
    if hit.is_none() && context.lighting.lights.environment().is_none() {
        return context.background;
    }
    follow_scattered(context, *ray, hit, (ray.origin, None), sampler, limit)
}

/// The same for a ray that a surface scattered: `left` is where it left the surface, and the density of its direction.
pub(super) fn follow_scattered(
    context: &Context,
    mut ray: Ray,
    mut hit: Option<Hit>,
    left: (Vec3, Option<f32>),
    sampler: &mut Sampler,
    limit: Option<u32>,
) -> Vec3 {
    let (mut light, mut throughput) = (Vec3::ZERO, Vec3::ONE);
    // Where the ray left the last surface that scattered it, and with which density.
    let (mut from, mut density) = left;
    // The product of the squared indices of refraction.
    let mut scale = 1.0;
    let mut surfaces = 0;
    loop {
        let Some(nearest) = hit else {
            return light + throughput * from_afar(context, &ray, density);
        };
        let point = ShadingPoint::new(context, &ray, nearest);
        if point.opacity < 1.0 && sampler.next_1d() >= point.opacity {
            let Some(onward) = point.onward() else {
                return light;
            };
            ray = onward;
            hit = context.intersector.closest_hit(&ray);
            continue;
        }
        light += throughput * emitted(&point, from, density);
        if limit.is_some_and(|limit| surfaces >= limit) {
            return light;
        }
        surfaces += 1;
        light += throughput * point.direct_light(sampler);
        let Some(scattered) = point.scatter(sampler) else {
            return light;
        };
        throughput *= scattered.weight;
        scale *= scattered.eta * scattered.eta;
        if surfaces > SURE_SURFACES {
            // Refraction scales radiance, but not what is left of the path.
            let survival = (throughput.max_element() * scale).min(MOST_LIKELY);
            if sampler.next_1d() >= survival {
                return light;
            }
            throughput /= survival;
        }
        let Some(onward) = point.spawn(scattered.incoming) else {
            return light;
        };
        (from, density) = (point.position(), scattered.density);
        ray = onward;
        hit = context.intersector.closest_hit(&ray);
    }
}

//! The view *Path*: global illumination.
//!
//! Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; next event estimation and its weights: Veach, "Robust Monte
//! Carlo Methods for Light Transport Simulation", 1997.

use super::hidden_emitters::past_emitters;
use super::record::{PathEnd, Recorder};
use super::transport::{ShadingPoint, emitted, from_afar, shows_background};
use super::{Context, Integrator, Needs, Source};
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
    source: Source::Colour(radiance),
};

/// The largest probability of going on, so that paths between white surfaces end.
const MOST_LIKELY: f32 = 0.95;

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    follow(context, ray, hit, sampler, limit(context), &mut ())
}

/// The most surfaces on a path.
pub(super) fn limit(context: &Context) -> Option<u32> {
    context.lighting.depth_limit
}

/// The light that arrives along a camera's ray by way of at most `limit` surfaces; the background if the ray hits nothing
/// and there is no environment.
pub(super) fn follow(
    context: &Context,
    ray: &Ray,
    hit: Option<Hit>,
    sampler: &mut Sampler,
    limit: Option<u32>,
    recorder: &mut impl Recorder,
) -> Vec3 {
    let (ray, hit) = past_emitters(context, ray, hit, recorder);
    if shows_background(context, hit) {
        recorder.end(PathEnd::Left, &ray, context.background);
        return context.background;
    }
    let from = (ray.origin, None);
    follow_scattered(context, ray, hit, from, sampler, limit, recorder)
}

/// The same for a ray that left a surface at the point `from`, where the surface scattered it with the density `density`;
/// `None` for single directions and rays of the camera.
pub(super) fn follow_scattered(
    context: &Context,
    mut ray: Ray,
    mut hit: Option<Hit>,
    (mut from, mut density): (Vec3, Option<f32>),
    sampler: &mut Sampler,
    limit: Option<u32>,
    recorder: &mut impl Recorder,
) -> Vec3 {
    let (mut light, mut throughput) = (Vec3::ZERO, Vec3::ONE);
    // The product of the squared indices of refraction.
    let mut scale = 1.0;
    let mut surfaces = 0;
    let end = loop {
        let Some(nearest) = hit else {
            let from_afar = throughput * from_afar(context, &ray, density);
            recorder.end(PathEnd::Left, &ray, from_afar);
            return light + from_afar;
        };
        let point = ShadingPoint::new(context, &ray, nearest);
        recorder.meet(&point);
        if point.opacity < 1.0 && sampler.next_1d() >= point.opacity {
            recorder.pass();
            let Some(onward) = point.onward() else {
                break PathEnd::Overflow;
            };
            ray = onward;
            hit = context.intersector.closest_hit(&ray);
            continue;
        }
        let emission = throughput * emitted(&point, from, density);
        recorder.emission(emission);
        light += emission;
        if limit.is_some_and(|limit| surfaces >= limit) {
            break PathEnd::DepthLimit;
        }
        surfaces += 1;
        let direct = throughput * point.direct_light(sampler, recorder);
        recorder.direct(direct);
        light += direct;
        let Some(scattered) = point.scatter(sampler) else {
            break PathEnd::Absorbed;
        };
        throughput *= scattered.weight;
        scale *= scattered.eta * scattered.eta;
        if surfaces >= context.lighting.roulette_depth {
            let Some(surviving) = roulette(throughput, scale, sampler, recorder) else {
                break PathEnd::RussianRoulette;
            };
            throughput = surviving;
        }
        let Some(onward) = point.spawn(scattered.incoming) else {
            break PathEnd::Overflow;
        };
        recorder.scatter(throughput);
        (from, density) = (point.position(), scattered.density);
        ray = onward;
        hit = context.intersector.closest_hit(&ray);
    };
    recorder.end(end, &ray, Vec3::ZERO);
    light
}

/// The throughput of a path that Russian roulette lets continue; `None` if it ends the path. `scale` is the product of the
/// squared indices of refraction along the path.
fn roulette(
    throughput: Vec3,
    scale: f32,
    sampler: &mut Sampler,
    recorder: &mut impl Recorder,
) -> Option<Vec3> {
    // Refraction scales radiance, but not what is left of the path.
    let survival = (throughput.max_element() * scale).min(MOST_LIKELY);
    recorder.roulette(survival);
    (sampler.next_1d() < survival).then(|| throughput / survival)
}

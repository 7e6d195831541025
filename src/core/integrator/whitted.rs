//! The view *Recursive*: direct light, and what mirrors and glass show.
//!
//! Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980.
//! Differs from it: the parts of light that glass reflects and refracts follow from Fresnel's equations; glass casts a
//! shadow; lights may have extent, and surfaces coverage.

use super::hidden_emitters::past_emitters;
use super::path::follow_scattered;
use super::transport::{Connection, INVISIBLE, ShadingPoint, emitted, from_afar, seen};
use super::visibility::transmittance;
use super::{Context, Integrator, Needs, Sample, Source};
use crate::film::Seen;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static WHITTED: Integrator = Integrator {
    name: "whitted",
    title: "Recursive",
    about: "Direct light, and mirrors and glass, both of whose rays are followed. Light by way of matt and rough surfaces is missing.",
    needs: Needs::PATHS,
    legend: Vec::new,
    source: Source::Batch(radiances),
};

/// The most surfaces on a branch, which ends branches between mirrors and in total reflection. As surfaces scatter no more
/// light than arrives, the tree has at most 512 branches that are visible after each number of surfaces.
const MOST_SURFACES: u32 = 64;

/// A ray of the tree.
struct Branch {
    ray: Ray,
    hit: Option<Hit>,
    /// The part of its light that reaches the eye.
    weight: Vec3,
    /// The product of the squared indices of refraction.
    scale: f32,
    /// The surfaces between it and the eye.
    surfaces: u32,
}

impl Branch {
    /// The first hit is searched for where the branch is visible.
    fn along(self, context: &Context, ray: Option<Ray>) -> Option<Self> {
        // Refraction scales radiance, but not what is left of the light.
        if self.weight.max_element() * self.scale < INVISIBLE {
            return None;
        }
        let ray = ray?;
        let hit = context.intersector.closest_hit(&ray);
        Some(Self { ray, hit, ..self })
    }
}

fn radiances(context: &Context, samples: &mut [Sample]) {
    for sample in samples {
        let (mut ray, mut hit) = (sample.ray, sample.hit);
        past_emitters(context, &mut ray, &mut hit, &mut ());
        sample.seen = seen(context, hit);
        sample.radiance = match sample.seen {
            Seen::Background => context.background,
            _ => radiance(context, ray, hit, &mut sample.sampler),
        };
    }
}

fn radiance(context: &Context, ray: Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    let limit = context.lighting.depth_limit.unwrap_or(MOST_SURFACES);
    let limit = limit.min(MOST_SURFACES);
    let mut light = Vec3::ZERO;
    let mut branches = vec![Branch {
        ray,
        hit,
        weight: Vec3::ONE,
        scale: 1.0,
        surfaces: 0,
    }];
    while let Some(branch) = branches.pop() {
        let Some(hit) = branch.hit else {
            light += branch.weight * from_afar(context, &branch.ray, None);
            continue;
        };
        let point = ShadingPoint::new(context, &branch.ray, hit);
        if point.opacity < 1.0 {
            let behind = Branch {
                weight: (1.0 - point.opacity) * branch.weight,
                ..branch
            };
            branches.extend(behind.along(context, point.onward()));
        }
        let weight = point.opacity * branch.weight;
        light += weight * emitted(&point, branch.ray.origin, None);
        if branch.surfaces >= limit || weight == Vec3::ZERO {
            continue;
        }
        light += weight * direct_light(context, &point, sampler);
        for scattered in point.single_directions() {
            let next = Branch {
                weight: weight * scattered.weight,
                scale: branch.scale * scattered.eta * scattered.eta,
                surfaces: branch.surfaces + 1,
                ..branch
            };
            branches.extend(next.along(context, point.spawn(scattered.incoming)));
        }
    }
    light
}

/// The light from the lights that a surface scatters, but for that which mirrors and glass scatter into single directions.
/// Lights that are points or directions are all summed, without random numbers. For the others, there is one sample of the
/// lights and one of the surface.
fn direct_light(context: &Context, point: &ShadingPoint<'_>, sampler: &mut Sampler) -> Vec3 {
    let arriving =
        |connection: Connection| connection.light * transmittance(context, connection.ray);
    let mut light: Vec3 = point.light_without_extent().map(arriving).sum();
    if !context.lighting.lights.has_extent() {
        return light;
    }
    light += point
        .light_with_extent(sampler)
        .map_or(Vec3::ZERO, arriving);
    if let Some(scattered) = point.scatter(sampler)
        && scattered.density.is_some()
        && let Some(ray) = point.spawn(scattered.incoming)
    {
        let hit = context.intersector.closest_hit(&ray);
        let left = (point.position(), scattered.density);
        let found = follow_scattered(context, ray, hit, left, sampler, Some(0));
        light += scattered.weight * found;
    }
    light
}

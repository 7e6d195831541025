//! The view *Path*: global illumination.
//!
//! Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; next event estimation and its weights: Veach, "Robust Monte
//! Carlo Methods for Light Transport Simulation", 1997.

use super::hidden_emitters::past_emitters;
use super::record::{PathEnd, Recorder};
use super::transport::{Connection, ShadingPoint, emitted, from_afar, shows_background};
use super::visibility::transmittances;
use super::{Context, Integrator, Needs, Sample, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;
use std::slice::from_mut;

/// The row of the view.
pub(super) static PATH: Integrator = Integrator {
    name: "path",
    title: "Path tracing",
    about: "Light from the lights and by way of other surfaces.",
    needs: Needs::PATHS,
    legend: Vec::new,
    source: Source::Batch(radiances),
};

/// The largest probability of going on, so that paths between white surfaces end.
const MOST_LIKELY: f32 = 0.95;

fn radiances(context: &Context, samples: &mut [Sample]) {
    follow_all(context, samples, limit(context));
}

/// The most surfaces on a path.
pub(super) fn limit(context: &Context) -> Option<u32> {
    context.lighting.depth_limit
}

/// Sets the colours of samples: the light that arrives along their rays by way of at most `limit` surfaces; the background
/// if a ray hits nothing and there is no environment.
pub(super) fn follow_all(context: &Context, samples: &mut [Sample], limit: Option<u32>) {
    let mut paths = Vec::with_capacity(samples.len());
    for sample in samples {
        (sample.ray, sample.hit) = past_emitters(context, &sample.ray, sample.hit, &mut ());
        if shows_background(context, sample.hit) {
            sample.radiance = context.background;
        } else {
            paths.push(Path::new(sample));
        }
    }
    let mut recorders = vec![(); paths.len()];
    follow(context, &mut paths, &mut recorders, limit);
}

/// The same for one sample, whose path is recorded.
pub(super) fn follow_recorded(
    context: &Context,
    sample: &mut Sample,
    limit: Option<u32>,
    recorder: &mut impl Recorder,
) {
    (sample.ray, sample.hit) = past_emitters(context, &sample.ray, sample.hit, recorder);
    if shows_background(context, sample.hit) {
        recorder.escape(context.background);
        recorder.end(PathEnd::Left, &sample.ray);
        sample.radiance = context.background;
        return;
    }
    follow(context, &mut [Path::new(sample)], from_mut(recorder), limit);
}

/// The light that arrives along a ray that left a surface at the point `from`, where the surface scattered it with the
/// density `density`; `None` for single directions.
pub(super) fn follow_scattered(
    context: &Context,
    ray: Ray,
    hit: Option<Hit>,
    (from, density): (Vec3, Option<f32>),
    sampler: &mut Sampler,
    limit: Option<u32>,
) -> Vec3 {
    let mut sample = Sample::new(ray, hit, sampler.clone());
    let path = Path {
        from,
        density,
        ..Path::new(&mut sample)
    };
    follow(context, &mut [path], &mut [()], limit);
    *sampler = sample.sampler;
    sample.radiance
}

/// Follows paths to their ends. All advance by one surface at a time, so that their rays are traced together: first the
/// rays to the lights, then those that continue the paths.
fn follow<R: Recorder>(
    context: &Context,
    paths: &mut [Path<'_>],
    recorders: &mut [R],
    limit: Option<u32>,
) {
    let count = paths.len();
    let mut going: Vec<usize> = (0..count).collect();
    let (mut lit, mut to_lights) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (mut rays, mut hits) = (Vec::with_capacity(count), Vec::with_capacity(count));
    while !going.is_empty() {
        going.retain(|&i| {
            let (path, recorder) = (&mut paths[i], &mut recorders[i]);
            let (connection, end) = path.advance(context, limit, recorder);
            if let Some(connection) = connection {
                lit.push((i, connection.light));
                to_lights.push(connection.ray);
            }
            match end {
                Some(end) => recorder.end(end, &path.sample.ray),
                None => rays.push(path.sample.ray),
            }
            end.is_none()
        });
        let parts = transmittances(context, &to_lights);
        for ((i, light), part) in lit.drain(..).zip(parts) {
            recorders[i].direct(part, part * light);
            paths[i].sample.radiance += part * light;
        }
        hits.resize(rays.len(), None);
        context.intersector.closest_hits(&rays, &mut hits);
        context.scene.prefetch_surfaces(&hits);
        for (&i, hit) in going.iter().zip(&hits) {
            paths[i].sample.hit = *hit;
        }
        to_lights.clear();
        rays.clear();
    }
}

/// A path while it is followed.
struct Path<'a> {
    /// The ray that continues it, its hit, the random numbers, and the light that has been found.
    sample: &'a mut Sample,
    /// The point where the ray left a surface or the camera; not the ray's origin once it has passed through a surface
    /// with coverage.
    from: Vec3,
    /// The density with which that surface scattered it; `None` for single directions and rays of the camera.
    density: Option<f32>,
    /// The part of the ray's light that reaches the camera.
    throughput: Vec3,
    /// The product of the squared indices of refraction.
    scale: f32,
    /// The number of surfaces on the path.
    surfaces: u32,
}

impl<'a> Path<'a> {
    fn new(sample: &'a mut Sample) -> Self {
        Self {
            from: sample.ray.origin,
            sample,
            density: None,
            throughput: Vec3::ONE,
            scale: 1.0,
            surfaces: 0,
        }
    }

    /// Adds the light that arrives along the ray from the surface that it hits, or from the environment, and chooses the
    /// path's next ray. Returns a connection to a light, whose light is still to be added if it arrives, and why the
    /// path ends, if it does.
    fn advance(
        &mut self,
        context: &Context,
        limit: Option<u32>,
        recorder: &mut impl Recorder,
    ) -> (Option<Connection>, Option<PathEnd>) {
        let ray = self.sample.ray;
        let Some(hit) = self.sample.hit else {
            let light = self.throughput * from_afar(context, &ray, self.density);
            recorder.escape(light);
            self.sample.radiance += light;
            return (None, Some(PathEnd::Left));
        };
        let point = ShadingPoint::new(context, &ray, hit);
        recorder.meet(&point);
        if point.opacity < 1.0 && self.sample.sampler.next_1d() >= point.opacity {
            recorder.pass();
            return (None, self.go_on(point.onward()).err());
        }
        let emission = self.throughput * emitted(&point, self.from, self.density);
        recorder.emission(emission);
        self.sample.radiance += emission;
        if limit.is_some_and(|limit| self.surfaces >= limit) {
            return (None, Some(PathEnd::DepthLimit));
        }
        self.surfaces += 1;
        let mut connection = point.direct_light(&mut self.sample.sampler);
        if let Some(connection) = &mut connection {
            recorder.shadow_ray(connection);
            connection.light *= self.throughput;
        }
        (connection, self.scatter(context, &point, recorder).err())
    }

    /// Continues the path in a direction from which the surface scatters light; the error is why the path ends.
    fn scatter(
        &mut self,
        context: &Context,
        point: &ShadingPoint<'_>,
        recorder: &mut impl Recorder,
    ) -> Result<(), PathEnd> {
        let scattered = point.scatter(&mut self.sample.sampler);
        let scattered = scattered.ok_or(PathEnd::Absorbed)?;
        self.throughput *= scattered.weight;
        self.scale *= scattered.eta * scattered.eta;
        if self.surfaces >= context.lighting.roulette_depth {
            self.play_roulette(recorder)?;
        }
        self.go_on(point.spawn(scattered.incoming))?;
        recorder.scatter(self.throughput);
        (self.from, self.density) = (point.position(), scattered.density);
        Ok(())
    }

    /// Continues the path with a ray; without one, numbers have overflowed.
    fn go_on(&mut self, onward: Option<Ray>) -> Result<(), PathEnd> {
        self.sample.ray = onward.ok_or(PathEnd::Overflow)?;
        Ok(())
    }

    /// Ends the path by Russian roulette, or divides its throughput by the probability of survival.
    fn play_roulette(&mut self, recorder: &mut impl Recorder) -> Result<(), PathEnd> {
        // Refraction scales radiance, but not what is left of the path.
        let survival = (self.throughput.max_element() * self.scale).min(MOST_LIKELY);
        recorder.roulette(survival);
        if self.sample.sampler.next_1d() >= survival {
            return Err(PathEnd::RussianRoulette);
        }
        self.throughput /= survival;
        Ok(())
    }
}

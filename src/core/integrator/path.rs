//! The view *Path*: global illumination.
//!
//! Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; next event estimation and its weights: Veach, "Robust Monte
//! Carlo Methods for Light Transport Simulation", 1997.

use super::hidden_emitters::past_emitters;
use super::record::{PathEnd, Recorder};
use super::transport::{ShadingPoint, emitted, from_afar, seen};
use super::visibility::transmittances;
use super::{Context, Integrator, Needs, Sample, Source};
use crate::film::Seen;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;
use std::mem::swap;
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
        past_emitters(context, &mut sample.ray, &mut sample.hit, &mut ());
        sample.seen = seen(context, sample.hit);
        if sample.seen == Seen::Background {
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
    past_emitters(context, &mut sample.ray, &mut sample.hit, recorder);
    sample.seen = seen(context, sample.hit);
    if sample.seen == Seen::Background {
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
    let arrivals = paths.iter().map(|path| (path.sample.ray, path.sample.hit));
    let (mut rays, mut hits): (Vec<_>, Vec<_>) = arrivals.unzip();
    let mut next = NextRays::with_capacity(count);
    while !going.is_empty() {
        for ((&i, ray), hit) in going.iter().zip(&rays).zip(&hits) {
            let (path, recorder) = (&mut paths[i], &mut recorders[i]);
            let lit = next.to_lights.len();
            let end = path.advance(context, limit, (ray, hit), recorder, &mut next);
            if next.to_lights.len() > lit {
                next.lit.push(i);
            }
            match end {
                Some(end) => recorder.end(end, ray),
                None => next.going.push(i),
            }
        }
        let parts = transmittances(context, &next.to_lights);
        for ((&i, &light), part) in next.lit.iter().zip(&next.light).zip(parts) {
            recorders[i].direct(part, part * light);
            paths[i].sample.radiance += part * light;
        }
        swap(&mut rays, &mut next.onward);
        swap(&mut going, &mut next.going);
        next.clear();
        hits.resize(rays.len(), None);
        context.intersector.closest_hits(&rays, &mut hits);
        context.scene.prefetch_surfaces(&hits);
    }
}

/// The next rays of paths: shadow rays, and rays that continue paths.
struct NextRays {
    /// The indices of the paths with a ray to a light.
    lit: Vec<usize>,
    /// The light that each of these rays carries if nothing blocks it.
    light: Vec<Vec3>,
    /// The rays to lights.
    to_lights: Vec<Ray>,
    /// The indices of the paths that continue.
    going: Vec<usize>,
    /// The rays that continue them.
    onward: Vec<Ray>,
}

impl NextRays {
    fn with_capacity(count: usize) -> Self {
        Self {
            lit: Vec::with_capacity(count),
            light: Vec::with_capacity(count),
            to_lights: Vec::with_capacity(count),
            going: Vec::with_capacity(count),
            onward: Vec::with_capacity(count),
        }
    }

    fn clear(&mut self) {
        self.lit.clear();
        self.light.clear();
        self.to_lights.clear();
        self.going.clear();
        self.onward.clear();
    }

    /// Adds a ray that continues a path; `None` means that numbers have overflowed.
    #[inline]
    fn go_on(&mut self, onward: Option<Ray>) -> Result<(), PathEnd> {
        self.onward.push(onward.ok_or(PathEnd::Overflow)?);
        Ok(())
    }
}

/// A path while it is followed.
struct Path<'a> {
    /// Its first ray and hit, its random numbers, and the light that has been found.
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

    /// Adds the light that arrives along a ray from the surface that it hits, or from the environment.
    ///
    /// Adds the path's next ray to `next`, and a ray to a light; the caller adds that light if the ray isn't blocked.
    /// Returns the reason if the path ends.
    #[inline(always)]
    fn advance(
        &mut self,
        context: &Context,
        limit: Option<u32>,
        (ray, hit): (&Ray, &Option<Hit>),
        recorder: &mut impl Recorder,
        next: &mut NextRays,
    ) -> Option<PathEnd> {
        let Some(hit) = *hit else {
            let light = self.throughput * from_afar(context, ray, self.density);
            recorder.escape(light);
            self.sample.radiance += light;
            return Some(PathEnd::Left);
        };
        let point = ShadingPoint::new(context, ray, hit);
        recorder.meet(&point);
        if point.opacity < 1.0 && self.sample.sampler.next_1d() >= point.opacity {
            recorder.pass();
            return next.go_on(point.onward()).err();
        }
        let emission = self.throughput * emitted(&point, self.from, self.density);
        recorder.emission(emission);
        self.sample.radiance += emission;
        if limit.is_some_and(|limit| self.surfaces >= limit) {
            return Some(PathEnd::DepthLimit);
        }
        self.surfaces += 1;
        if let Some(connection) = point.direct_light(&mut self.sample.sampler) {
            recorder.shadow_ray(&connection);
            next.light.push(self.throughput * connection.light);
            next.to_lights.push(connection.ray);
        }
        self.scatter(context, &point, recorder, next).err()
    }

    /// Continues the path in a direction from which the surface scatters light; the error is why the path ends.
    #[inline(always)]
    fn scatter(
        &mut self,
        context: &Context,
        point: &ShadingPoint<'_>,
        recorder: &mut impl Recorder,
        next: &mut NextRays,
    ) -> Result<(), PathEnd> {
        let scattered = point.scatter(&mut self.sample.sampler);
        let scattered = scattered.ok_or(PathEnd::Absorbed)?;
        self.throughput *= scattered.weight;
        self.scale *= scattered.eta * scattered.eta;
        if self.surfaces >= context.lighting.roulette_depth {
            self.play_roulette(recorder)?;
        }
        next.go_on(point.spawn(scattered.incoming))?;
        recorder.scatter(self.throughput);
        (self.from, self.density) = (point.position(), scattered.density);
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

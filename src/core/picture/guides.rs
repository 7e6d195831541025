//! What each pixel shows first: albedo, normal, depth and primitive, which guide denoisers.
//!
//! Source: Open Image Denoise, "Open Image Denoise API", RT filter, <https://www.openimagedenoise.org/documentation.html>.

use super::rows::{TraceError, rows};
use crate::appearance::Appearance;
use crate::bsdf::Scatter as _;
use crate::integrator::Context;
use crate::interaction::SurfaceInteraction;
use crate::lane::PACKET;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::ray::{Hit, Ray};
use glam::{DVec3, UVec2, Vec3};

/// What a pixel shows first. Means are over the pixel's samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// The mean diffuse reflectance in linear RGB; samples that hit nothing count as black.
    pub albedo: Vec3,
    /// The mean shading normal in the scene's coordinates, on the side of the camera; samples that hit nothing count as
    /// zero, so that its length is at most 1.
    pub normal: Vec3,
    /// The mean distance along the ray, in the scene's units, of the samples that hit; infinite if none does.
    pub depth: f32,
    /// The primitive that the centre sample hits.
    pub primitive: Option<u32>,
}

/// The guides of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Guides {
    size: UVec2,
    /// Row by row from the top.
    pixels: Vec<Guide>,
}

impl Guides {
    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Row by row from the top.
    pub fn pixels(&self) -> &[Guide] {
        &self.pixels
    }
}

/// Traces a plan's samples again, up to their first hits, on `threads` threads; 0 takes one for each processor core. The
/// guides don't depend on the number of threads. Light isn't followed through mirrors and glass, and coverage is ignored.
///
/// # Errors
/// See [`TraceError`].
pub fn guides(
    context: &Context,
    plan: &Plan,
    threads: usize,
    progress: &Progress,
) -> Result<Guides, TraceError> {
    let size = plan.size();
    let samples = plan.samples_after(plan.pass_count());
    let nothing = Sum::default().mean(samples);
    let pixels = rows(size, threads, progress, nothing, |y, row| {
        trace_row(context, samples, plan.in_whole(UVec2::new(0, y)).y, row);
    })?;
    Ok(Guides { size, pixels })
}

/// Traces one row.
fn trace_row(context: &Context, samples: u32, y: u32, row: &mut [Guide]) {
    let mut sums = vec![Sum::default(); row.len()];
    let at = |k: u64| {
        (
            (k / u64::from(samples)) as u32,
            (k % u64::from(samples)) as u32,
        )
    };
    let count = row.len() as u64 * u64::from(samples);
    let mut hits = [None; PACKET];
    for first in (0..count).step_by(PACKET) {
        let batch = first..count.min(first + PACKET as u64);
        let ray = |k: u64| {
            let (x, sample) = at(k);
            let pixel = UVec2::new(x, y);
            context.camera.ray(pixel, Plan::position(pixel, sample))
        };
        let rays: Vec<Ray> = batch.clone().map(ray).collect();
        let hits = &mut hits[..rays.len()];
        context.intersector.coherent_hits(&rays, hits);
        for ((k, ray), hit) in batch.zip(&rays).zip(hits.iter()) {
            let (x, sample) = at(k);
            if let Some(hit) = hit {
                sums[x as usize].add(context, ray, *hit, sample);
            }
        }
    }
    for (guide, sum) in row.iter_mut().zip(sums) {
        *guide = sum.mean(samples);
    }
}

/// The sums over a pixel's samples.
#[derive(Clone, Copy, Default)]
struct Sum {
    albedo: DVec3,
    normal: DVec3,
    depth: f64,
    hit_count: u32,
    primitive: Option<u32>,
}

impl Sum {
    fn add(&mut self, context: &Context, ray: &Ray, hit: Hit, sample: u32) {
        let scene = &context.scene;
        let surface = scene.surface(ray, &hit);
        let interaction = SurfaceInteraction::of_surface(scene, &surface, hit, context.shading);
        let materials = &scene.mesh().attributes().materials;
        let material = materials.get(interaction.material);
        let appearance = Appearance::new(scene, material, surface.position, &hit);
        self.albedo += appearance.bsdf(true).colour().as_dvec3();
        self.normal += appearance.facing_normal(&interaction, ray).as_dvec3();
        // Camera rays have unit length.
        self.depth += f64::from(hit.t);
        self.hit_count += 1;
        // The first sample is at the centre.
        if sample == 0 {
            self.primitive = Some(hit.primitive);
        }
    }

    fn mean(&self, samples: u32) -> Guide {
        let samples = f64::from(samples);
        let depth = if self.hit_count > 0 {
            self.depth / f64::from(self.hit_count)
        } else {
            f64::INFINITY
        };
        Guide {
            albedo: (self.albedo / samples).as_vec3(),
            normal: (self.normal / samples).as_vec3(),
            depth: depth as f32,
            primitive: self.primitive,
        }
    }
}

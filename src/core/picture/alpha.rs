//! The part of each pixel that surfaces cover: the alpha channel of a picture with a transparent background.
//!
//! Such a picture is rendered with [`ViewOptions::has_transparent_background`]. Samples that hit nothing are then
//! black, so the film's colours are premultiplied by alpha.
//!
//! Source: Porter, Duff, "Compositing Digital Images", SIGGRAPH 1984.
//!
//! [`ViewOptions::has_transparent_background`]: crate::integrator::ViewOptions::has_transparent_background

use super::rows::{TraceError, rows};
use crate::camera::Camera;
use crate::film::Film;
use crate::intersector::Intersector;
use crate::lane::PACKET;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::ray::Ray;
use glam::{UVec2, Vec3};

/// The part of each pixel's samples that hit a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Alpha {
    size: UVec2,
    /// From 0 to 1, row by row from the top.
    pixels: Vec<f32>,
}

impl Alpha {
    /// Traces a plan's samples again, up to their first hits, on `threads` threads; 0 stands for one thread per core.
    /// The result doesn't depend on the number of threads. A transparent material counts as a surface.
    ///
    /// # Errors
    /// See [`TraceError`].
    pub fn trace(
        camera: &Camera,
        intersector: &dyn Intersector,
        plan: &Plan,
        threads: usize,
        progress: &Progress,
    ) -> Result<Self, TraceError> {
        let size = plan.size();
        let samples = plan.samples_after(plan.pass_count());
        let pixels = rows(size, threads, progress, 0.0, |y, row| {
            for (x, alpha) in (0..).zip(row) {
                let hits = hit_count(
                    camera,
                    intersector,
                    plan.in_whole(UVec2::new(x, y)),
                    samples,
                );
                *alpha = hits as f32 / samples as f32;
            }
        })?;
        Ok(Self { size, pixels })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The covered part of each pixel, from 0 to 1, row by row from the top.
    pub fn pixels(&self) -> &[f32] {
        &self.pixels
    }

    /// The pixels of a film with premultiplied colours as they are displayed: sRGB with straight alpha, row by row from
    /// the top.
    ///
    /// # Panics
    /// If the film has another size.
    pub fn shown(&self, film: &Film) -> Vec<[u8; 4]> {
        assert_eq!(film.size(), self.size, "the alpha of this film");
        let pixel = |(index, &alpha): (usize, &f32)| {
            if alpha == 0.0 {
                return [0; 4];
            }
            let index = index as u32;
            let at = UVec2::new(index % self.size.x, index / self.size.x);
            let colour = film.radiance(at).unwrap_or(Vec3::ZERO) / alpha;
            let [r, g, b, _] = film.display().encode(colour);
            [r, g, b, (255.0 * alpha).round() as u8]
        };
        self.pixels.iter().enumerate().map(pixel).collect()
    }
}

/// The pixels of a film as they are displayed, in sRGB with straight alpha, row by row from the top; opaque without
/// `alpha`.
///
/// # Panics
/// If the film and the alpha differ in size.
pub fn shown_pixels(film: &Film, alpha: Option<&Alpha>) -> Vec<[u8; 4]> {
    match alpha {
        Some(alpha) => alpha.shown(film),
        None => film.pixels().to_vec(),
    }
}

/// The number of a pixel's samples that hit a surface.
fn hit_count(camera: &Camera, intersector: &dyn Intersector, pixel: UVec2, samples: u32) -> u32 {
    let mut hits = [None; PACKET];
    let mut count = 0;
    for first in (0..samples).step_by(PACKET) {
        let batch = first..samples.min(first + PACKET as u32);
        let ray = |sample| camera.ray(pixel, Plan::position(pixel, sample));
        let rays: Vec<Ray> = batch.map(ray).collect();
        let hits = &mut hits[..rays.len()];
        intersector.coherent_hits(&rays, hits);
        count += hits.iter().flatten().count() as u32;
    }
    count
}

//! A picture of a surface, coloured by its distance from another.

use super::Surface;
use glam::{UVec2, Vec3};
use hitscope_core::colour::ColourScale;
use hitscope_core::interaction::position_at;
use hitscope_core::mesh::unit_normal;
use hitscope_core::plan::Plan;
use hitscope_core::srgb::to_display;
use hitscope_core::{Camera, Intersector};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// A picture of a surface, coloured by its distance from another.
pub struct DistancePicture<'a> {
    /// The surface that is seen.
    pub surface: &'a Surface<'a>,
    /// The surface from which distances are measured.
    pub other: &'a Surface<'a>,
    /// The camera.
    pub camera: Camera,
    /// Finds what is seen of the surface.
    pub intersector: &'a dyn Intersector,
    /// Samples per pixel.
    pub samples: u32,
    /// The colours of distances.
    pub scale: ColourScale,
    /// The colour where nothing is seen, in linear RGB.
    pub background: Vec3,
}

impl DistancePicture<'_> {
    /// Traces the picture: sRGB with alpha 255, row by row from the top. After each row, `advanced` receives the part that
    /// is done. The picture doesn't depend on the number of threads.
    pub fn trace(&self, advanced: &(dyn Fn(f64) + Sync)) -> Vec<[u8; 4]> {
        let UVec2 {
            x: width,
            y: height,
        } = self.camera.resolution();
        let done = AtomicU32::new(0);
        let mut pixels = vec![[0; 4]; width as usize * height as usize];
        let rows = pixels.par_chunks_mut(width as usize).zip(0..height);
        rows.for_each(|(row, y)| {
            for (pixel, x) in row.iter_mut().zip(0..) {
                *pixel = self.pixel(UVec2::new(x, y));
            }
            let count = done.fetch_add(1, Relaxed) + 1;
            advanced(f64::from(count) / f64::from(height));
        });
        pixels
    }

    fn pixel(&self, pixel: UVec2) -> [u8; 4] {
        let sum: Vec3 = (0..self.samples)
            .map(|sample| self.sample(pixel, sample))
            .sum();
        let [r, g, b] = (sum / self.samples as f32)
            .to_array()
            .map(|linear| (255.0 * to_display(linear)).round() as u8);
        [r, g, b, 255]
    }

    fn sample(&self, pixel: UVec2, sample: u32) -> Vec3 {
        /// The brightness of a surface seen from its side; it is 1 from the front. Less would hide the colours.
        const FROM_THE_SIDE: f32 = 0.5;
        let ray = self.camera.ray(pixel, Plan::position(pixel, sample));
        let Some(hit) = self.intersector.closest_hit(&ray) else {
            return self.background;
        };
        let (scene, mesh) = (&self.surface.loaded.scene, self.surface.mesh());
        let position = position_at(scene, &ray, &hit);
        let Some(nearest) = self.other.closest(position, mesh.origin()) else {
            return self.background;
        };
        let normal = unit_normal(mesh.corners(hit.primitive)).as_vec3();
        let cosine = normal.dot(ray.dir).abs().min(1.0);
        self.scale.colour(nearest.distance) * (FROM_THE_SIDE + (1.0 - FROM_THE_SIDE) * cosine)
    }
}

//! The surface in the centre of each pixel: distances, primitive, group and material, for other programs.

use super::rows::{TraceError, rows};
use crate::integrator::Context;
use crate::lane::PACKET;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::ray::{Hit, Ray};
use glam::UVec2;

/// The surface in the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleSurface {
    /// t along the pixel's ray, whose direction has unit length up to rounding; infinite if the ray hits nothing.
    pub t: f32,
    /// The distance from the plane through the camera that faces the view: z of the camera's coordinates, but positive in
    /// front of the camera. Infinite if the ray hits nothing.
    pub z: f32,
    /// The primitive, the group and the material.
    pub ids: Option<SurfaceIds>,
}

/// Numbers of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceIds {
    /// The index of the primitive in the scene; triangles come first.
    pub primitive: u32,
    /// The index of the group or object of the file in the mesh's groups; `None` for shapes other than triangles.
    pub group: Option<u32>,
    /// The index of the material in the mesh's materials.
    pub material: u32,
}

/// The surfaces in the centres of a picture's pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleSurfaces {
    size: UVec2,
    /// Row by row from the top.
    pixels: Vec<VisibleSurface>,
}

impl VisibleSurface {
    const NOTHING: Self = Self {
        t: f32::INFINITY,
        z: f32::INFINITY,
        ids: None,
    };

    fn new(context: &Context, ray: &Ray, hit: Hit) -> Self {
        let (scene, camera) = (&context.scene, &context.camera);
        let from_eye = ray.at(hit.t) - camera.eye().as_dvec3();
        let is_triangle = scene.is_triangle(hit.primitive);
        let group = || scene.mesh().attributes().groups.index(hit.primitive);
        Self {
            t: hit.t,
            z: -from_eye.dot(camera.back()) as f32,
            ids: Some(SurfaceIds {
                primitive: hit.primitive,
                group: is_triangle.then(group),
                material: scene.material(hit.primitive),
            }),
        }
    }
}

impl VisibleSurfaces {
    /// Traces the centres of a picture's pixels on `threads` threads; 0 takes one for each processor core. The surfaces
    /// don't depend on the number of threads.
    ///
    /// # Errors
    /// See [`TraceError`].
    pub fn trace(
        context: &Context,
        threads: usize,
        progress: &Progress,
    ) -> Result<Self, TraceError> {
        let size = context.camera.resolution();
        let nothing = VisibleSurface::NOTHING;
        let pixels = rows(size, threads, progress, nothing, |y, row| {
            trace_row(context, y, row);
        })?;
        Ok(Self { size, pixels })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Row by row from the top.
    pub fn pixels(&self) -> &[VisibleSurface] {
        &self.pixels
    }
}

fn trace_row(context: &Context, y: u32, row: &mut [VisibleSurface]) {
    let mut hits = [None; PACKET];
    for (first, pixels) in (0..).step_by(PACKET).zip(row.chunks_mut(PACKET)) {
        let ray = |x: u32| {
            let pixel = UVec2::new(x, y);
            context.camera.ray(pixel, Plan::position(pixel, 0))
        };
        let rays: Vec<Ray> = (first..first + pixels.len() as u32).map(ray).collect();
        let hits = &mut hits[..rays.len()];
        context.intersector.coherent_hits(&rays, hits);
        for ((pixel, ray), hit) in pixels.iter_mut().zip(&rays).zip(hits) {
            if let Some(hit) = *hit {
                *pixel = VisibleSurface::new(context, ray, hit);
            }
        }
    }
}

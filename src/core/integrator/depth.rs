//! The view *Depth*.

use super::{Context, Integrator, Needs};
use crate::camera::Projection;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::srgb::from_display;
use glam::Vec3;

/// The row of the view.
pub(super) static DEPTH: Integrator = Integrator {
    name: "depth",
    title: "Depth",
    about: "Distance from the eye: white at the near side of the scene's bounding sphere, dark at the far side.",
    needs: Needs::NOTHING,
    legend: Vec::new,
    radiance,
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    hit.map_or(context.background, |hit| {
        let bounds = context.scene.bounds();
        // Distances from the eye, or from its plane, to the near and far side of the scene's bounding sphere.
        let camera = &context.camera;
        let from_eye = bounds.centre().as_dvec3() - camera.eye().as_dvec3();
        let middle = match camera.projection() {
            Projection::Perspective { .. } => from_eye.length(),
            Projection::Orthographic { .. } => -from_eye.dot(camera.back()),
        };
        let nearest = (middle - bounds.radius()).max(0.0);
        let distance = f64::from(hit.t) * ray.dir.as_dvec3().length();
        let part = (distance - nearest) / (middle + bounds.radius() - nearest);
        from_display(Vec3::splat(1.0 - 0.9 * part as f32))
    })
}

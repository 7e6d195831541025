//! Views that show one property of a hit as a colour.

use super::Context;
use super::palette::{cost_colour, id_colour};
use crate::camera::Projection;
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use crate::srgb::from_display;
use glam::Vec3;

pub(super) fn normal(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    hit.map_or(context.background, |hit| {
        let surface = SurfaceInteraction::new(&context.scene, ray, hit, context.shading);
        from_display(0.5 * surface.shading_normal + 0.5)
    })
}

/// Barycentric coordinates on triangles, u and v modulo 1 on other shapes.
pub(super) fn barycentric(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    hit.map_or(context.background, |hit| {
        from_display(if context.scene.is_triangle(hit.primitive) {
            Vec3::from_array(hit.barycentric())
        } else {
            let uv = context.scene.surface(ray, &hit).uv;
            let [u, v] = uv.to_array().map(|x| x.rem_euclid(1.0) as f32);
            Vec3::new(u, v, 0.0)
        })
    })
}

pub(super) fn depth(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
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

pub(super) fn triangle(context: &Context, _: &Ray, hit: Option<Hit>) -> Vec3 {
    hit.map_or(context.background, |hit| id_colour(hit.primitive))
}

/// Rays that hit nothing have a cost, too; this view has no background.
pub(super) fn cost(context: &Context, ray: &Ray, _: Option<Hit>) -> Vec3 {
    let (_, cost) = context.intersector.closest_hit_with_cost(ray);
    cost_colour(cost.boxes + cost.primitives)
}

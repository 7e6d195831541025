//! A clay model under a studio light fixed to the camera.

use super::Context;
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use glam::Vec3;

/// Reflectance of faces whose material names none.
const CLAY: Vec3 = Vec3::new(0.68, 0.66, 0.63);
/// Light from everywhere; the rest comes from the two lamps.
const AMBIENT: f32 = 0.10;
/// Lamps in camera space: where the light comes from, and how strong it is. The key light stands
/// above the left shoulder, the fill light low on the right.
const LAMPS: [(Vec3, f32); 2] = [
    (Vec3::new(-0.45, 0.65, 0.62), 0.85),
    (Vec3::new(0.80, -0.10, 0.60), 0.22),
];

/// Diffuse reflection of the lamps; both sides of a triangle are lit. No ray is cast to the lamps:
/// they cast no shadows.
pub(super) fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let surface = SurfaceInteraction::new(&context.scene, hit, context.shading);
    let normal = surface.facing_normal(ray);
    let camera = &context.camera;
    let axes = [camera.right(), camera.up(), camera.back()].map(|axis| axis.as_vec3());
    let lamp = |(dir, strength): (Vec3, f32)| {
        let dir = (dir.x * axes[0] + dir.y * axes[1] + dir.z * axes[2]).normalize();
        strength * normal.dot(dir).max(0.0)
    };
    let light = AMBIENT + LAMPS.into_iter().map(lamp).sum::<f32>();
    let materials = &context.scene.mesh().materials;
    let material = materials.get(surface.material as usize);
    light * material.and_then(|m| m.diffuse).unwrap_or(CLAY)
}

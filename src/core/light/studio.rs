//! The studio: ambient light and two lamps fixed to the camera.
//!
//! The view *Shaded* uses them without shadows, other views as lights. Both light an unoccluded diffuse surface alike.

use super::{DirectionalLight, Environment, Light};
use crate::camera::Camera;
use glam::Vec3;
use std::f32::consts::PI;

/// The radiance from all directions.
pub(crate) const AMBIENT: f32 = 0.10;

/// A lamp, infinitely far away.
#[derive(Clone, Copy)]
pub(crate) struct Lamp {
    /// The unit direction to the lamp.
    pub to_lamp: Vec3,
    /// The radiance that a white surface reflects if it faces the lamp.
    pub strength: f32,
}

/// Directions in camera space and strengths: a key light at the upper left, a fill light at the lower right.
const LAMPS: [(Vec3, f32); 2] = [
    (Vec3::new(-0.45, 0.65, 0.62), 0.85),
    (Vec3::new(0.80, -0.10, 0.60), 0.22),
];

/// The lamps about a camera.
pub(crate) fn lamps(camera: &Camera) -> [Lamp; 2] {
    let axes = [camera.right(), camera.up(), camera.back()].map(|axis| axis.as_vec3());
    let to_lamp = |dir: Vec3| (dir.x * axes[0] + dir.y * axes[1] + dir.z * axes[2]).normalize();
    LAMPS.map(|(dir, strength)| Lamp {
        to_lamp: to_lamp(dir),
        strength,
    })
}

/// The studio about a camera as lights.
pub fn studio(camera: &Camera) -> Vec<Light> {
    let ambient = Light::Environment(Environment::Constant(Vec3::splat(AMBIENT)));
    let lamps = lamps(camera).map(|lamp| {
        Light::Directional(DirectionalLight {
            to_light: lamp.to_lamp,
            // A white diffuse surface reflects the radiance E/π.
            irradiance: Vec3::splat(PI * lamp.strength),
        })
    });
    std::iter::once(ambient).chain(lamps).collect()
}

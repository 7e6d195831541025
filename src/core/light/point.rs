//! Light from a point.

use super::LightSample;
use glam::Vec3;
use std::f32::consts::PI;

/// A point that emits light to all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// The position, in the scene's coordinates.
    pub position: Vec3,
    /// Power per solid angle.
    pub intensity: Vec3,
}

impl PointLight {
    /// `None` at the light itself.
    pub(super) fn sample(&self, from: Vec3) -> Option<LightSample> {
        let way = self.position.as_dvec3() - from.as_dvec3();
        let dir = way.try_normalize()?;
        Some(LightSample {
            dir: dir.as_vec3(),
            end: Some(self.position),
            // The square of a short way would vanish in f32.
            weight: (self.intensity.as_dvec3() / way.length_squared()).as_vec3(),
            density: None,
        })
    }

    pub(super) fn power(&self) -> Vec3 {
        4.0 * PI * self.intensity
    }
}

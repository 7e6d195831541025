//! Light from one direction.

use super::LightSample;
use glam::Vec3;
use std::f64::consts::PI;

/// Light from infinitely far away, from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// The unit direction to the light.
    pub to_light: Vec3,
    /// The irradiance of a surface that faces the light.
    pub irradiance: Vec3,
}

impl DirectionalLight {
    pub(super) fn sample(&self) -> LightSample {
        LightSample {
            dir: self.to_light,
            end: None,
            weight: self.irradiance,
            density: None,
        }
    }

    pub(super) fn power(&self, radius: f64) -> Vec3 {
        (PI * radius * radius) as f32 * self.irradiance
    }
}

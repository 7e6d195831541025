//! Light from infinitely far away, from all directions.

use super::LightSample;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// The light from each direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// The same from all directions.
    Constant(Vec3),
}

impl Environment {
    /// The light from a unit direction.
    pub fn radiance(&self, _dir: Vec3) -> Vec3 {
        match self {
            Self::Constant(radiance) => *radiance,
        }
    }

    /// `None` if directions are better sampled by the surface: light that is the same from everywhere has no direction to
    /// prefer.
    pub(super) fn sample(&self, _at: Vec2) -> Option<LightSample> {
        match self {
            Self::Constant(_) => None,
        }
    }

    pub(super) fn density(&self, _dir: Vec3) -> f32 {
        match self {
            Self::Constant(_) => 0.0,
        }
    }

    /// 0 if it isn't sampled.
    pub(super) fn power(&self, radius: f64) -> Vec3 {
        let _disk = (PI * radius * radius) as f32;
        match self {
            Self::Constant(_) => Vec3::ZERO,
        }
    }
}

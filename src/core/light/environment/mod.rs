//! Light from infinitely far away, from all directions.
//!
//! | part | file |
//! |---|---|
//! | **a measured environment: lookup and sampling** | `map` |
//! | random choice by inverting a cumulative distribution | `cumulative` |
//! | reader of environment files | `file` |
//! | a map with its orientation and brightness | `placed` |

mod cumulative;
mod file;
mod map;
mod placed;

pub use file::LoadedMap;
pub use map::{EnvironmentMap, MapError, MapSample};
pub use placed::{MapPlacement, PlacedMap};

use super::LightSample;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// The light from each direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// The same from all directions.
    Constant(Vec3),
    /// Measured or computed light.
    Map(PlacedMap),
}

impl Environment {
    /// The light from a unit direction.
    pub fn radiance(&self, dir: Vec3) -> Vec3 {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Map(map) => map.radiance(dir),
        }
    }

    /// `None` if directions are better sampled by the surface: light that is the same from everywhere has no direction to
    /// prefer.
    pub(super) fn sample(&self, at: Vec2) -> Option<LightSample> {
        match self {
            Self::Constant(_) => None,
            Self::Map(map) => map.sample(at),
        }
    }

    pub(super) fn density(&self, dir: Vec3) -> f32 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Map(map) => map.density(dir),
        }
    }

    /// 0 if it isn't sampled.
    pub(super) fn power(&self, radius: f64) -> Vec3 {
        let disk = (PI * radius * radius) as f32;
        match self {
            Self::Constant(_) => Vec3::ZERO,
            Self::Map(map) => disk * map.flux(),
        }
    }
}

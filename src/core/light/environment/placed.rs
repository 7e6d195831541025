//! A measured environment with its orientation and brightness.

use super::map::EnvironmentMap;
use crate::camera::UpAxis;
use crate::light::LightSample;
use glam::{Mat3, Vec2, Vec3};
use std::sync::Arc;

/// Orientation and brightness of a measured environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPlacement {
    /// The map's axes in the world: an orthonormal matrix. The map's y axis is up.
    pub orientation: Mat3,
    /// Rotation about the map's y axis in radians, counter-clockwise as seen from above. It happens before `orientation`.
    pub rotation_radians: f32,
    /// Factor of the radiance.
    pub scale: f32,
}

impl MapPlacement {
    /// The placement in which the map's vertical axis is the world's `up_axis`, the x axes of map and world agree, and
    /// the radiance is that of the file.
    pub fn upright(up_axis: UpAxis) -> Self {
        Self {
            orientation: match up_axis {
                UpAxis::Y => Mat3::IDENTITY,
                UpAxis::Z => Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::NEG_Y),
            },
            rotation_radians: 0.0,
            scale: 1.0,
        }
    }
}

impl Default for MapPlacement {
    /// The y axis is up, and the radiance is that of the file.
    fn default() -> Self {
        Self::upright(UpAxis::Y)
    }
}

/// A measured environment with its orientation and brightness. Another placement of the same map costs nothing.
#[derive(Clone, Debug)]
pub struct PlacedMap {
    map: Arc<EnvironmentMap>,
    placement: MapPlacement,
    world_from_map: Mat3,
}

impl PlacedMap {
    /// Places a map.
    pub fn new(map: Arc<EnvironmentMap>, placement: MapPlacement) -> Self {
        let (sin, cos) = libm::sincosf(placement.rotation_radians);
        let rotation =
            Mat3::from_cols(Vec3::new(cos, 0.0, -sin), Vec3::Y, Vec3::new(sin, 0.0, cos));
        Self {
            map,
            placement,
            world_from_map: placement.orientation * rotation,
        }
    }

    /// The map.
    pub fn map(&self) -> &Arc<EnvironmentMap> {
        &self.map
    }

    /// Its placement.
    pub fn placement(&self) -> &MapPlacement {
        &self.placement
    }

    pub(super) fn radiance(&self, dir: Vec3) -> Vec3 {
        self.placement.scale * self.map.radiance(self.in_map(dir))
    }

    pub(super) fn sample(&self, at: Vec2) -> Option<LightSample> {
        let sample = self.map.sample(at)?;
        Some(LightSample {
            dir: (self.world_from_map * sample.dir).normalize(),
            end: None,
            weight: self.placement.scale * sample.radiance / sample.density,
            density: Some(sample.density),
        })
    }

    pub(super) fn density(&self, dir: Vec3) -> f32 {
        self.map.density(self.in_map(dir))
    }

    /// The irradiance, summed over all directions.
    pub(super) fn flux(&self) -> Vec3 {
        self.placement.scale * self.map.flux()
    }

    fn in_map(&self, dir: Vec3) -> Vec3 {
        self.world_from_map.transpose() * dir
    }
}

impl PartialEq for PlacedMap {
    /// Whether both are the same map in memory, placed equally.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.map, &other.map) && self.placement == other.placement
    }
}

//! Tori.

use super::PlacedPrimitive;
use super::similarity::scale_of;
use crate::shape::Torus;
use glam::{DMat3, DMat4, DVec3};

#[derive(Debug)]
pub(super) struct PlacedTorus {
    centre: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
}

impl PlacedTorus {
    /// # Errors
    /// The map scales unequally.
    pub fn new(
        centre: DVec3,
        axis: DVec3,
        radii: [f64; 2],
        to_world: &DMat4,
    ) -> Result<Self, &'static str> {
        let linear = DMat3::from_mat4(*to_world);
        let scale = scale_of(linear)
            .ok_or("the transform scales the torus unequally, which isn't supported")?;
        let [major, minor] = radii.map(|radius| scale * radius);
        Ok(Self {
            centre: to_world.transform_point3(centre),
            axis: linear * axis,
            major,
            minor,
        })
    }
}

impl PlacedPrimitive for PlacedTorus {
    type Shape = Torus;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let reach = DVec3::splat(self.major + self.minor);
        Some([self.centre - reach, self.centre + reach])
    }

    fn rounded(&self, origin: DVec3) -> Torus {
        Torus {
            centre: (self.centre - origin).as_vec3(),
            axis: self.axis.normalize_or_zero().as_vec3(),
            major: self.major as f32,
            minor: self.minor as f32,
        }
    }
}

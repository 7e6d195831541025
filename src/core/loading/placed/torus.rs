//! Tori.

use super::similarity::scale_of;
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::scene_file::{self, Place};
use crate::shape::Torus;
use glam::{DMat3, DMat4, DVec3};

#[derive(Debug)]
struct PlacedTorus {
    centre: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
}

impl Placeable for scene_file::Torus {
    fn placed(&self, place: Place, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let linear = DMat3::from_mat4(*to_world);
        let message = "the transform scales the torus unequally, which isn't supported";
        let scale = scale_of(linear).ok_or_else(|| Refusal::new(place, message))?;
        Ok(Box::new(PlacedTorus {
            centre: to_world.transform_point3(self.center),
            axis: linear * self.axis,
            major: scale * self.major,
            minor: scale * self.minor,
        }))
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

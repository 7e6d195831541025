//! Tori.

use super::similarity::scale_of;
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::scene_file::{self, Shape};
use crate::shape::{Torus, disk_reach};
use glam::{DMat3, DMat4, DVec3};

#[derive(Debug)]
struct PlacedTorus {
    centre: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
}

impl Placeable for scene_file::Torus {
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let linear = DMat3::from_mat4(*to_world);
        let message = "the transform scales it unequally or shears it; only one factor for all directions, rotation and translation are possible";
        let scale = scale_of(linear).ok_or_else(|| Refusal::of_shape(shape, message))?;
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
        let circle = disk_reach(self.axis.to_array(), self.major);
        let reach = DVec3::from(circle) + self.minor;
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

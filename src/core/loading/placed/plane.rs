//! Infinite planes.

use super::axis_of;
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::scene_file::{self, Shape};
use crate::shape::{AxisPlane, Plane};
use glam::{DMat3, DMat4, DVec3};

impl Placeable for scene_file::Plane {
    /// A plane; one that is perpendicular to an axis becomes an [`AxisPlane`].
    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let point = to_world.transform_point3(self.point);
        let normal = DMat3::from_mat4(*to_world).inverse().transpose() * self.normal;
        Ok(match axis_of(normal) {
            Some(axis) => Box::new(PlacedAxisPlane {
                axis,
                coordinate: point[axis],
                is_along_axis: normal[axis] > 0.0,
            }),
            None => Box::new(PlacedPlane { point, normal }),
        })
    }
}

#[derive(Debug)]
struct PlacedPlane {
    point: DVec3,
    normal: DVec3,
}

impl PlacedPrimitive for PlacedPlane {
    type Shape = Plane;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn rounded(&self, origin: DVec3) -> Plane {
        // The point nearest to the origin, so that it is rounded little.
        let nearest = (self.point - origin).project_onto(self.normal);
        Plane {
            point: nearest.as_vec3(),
            normal: self.normal.normalize_or_zero().as_vec3(),
        }
    }
}

#[derive(Debug)]
struct PlacedAxisPlane {
    axis: usize,
    coordinate: f64,
    is_along_axis: bool,
}

impl PlacedPrimitive for PlacedAxisPlane {
    type Shape = AxisPlane;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn rounded(&self, origin: DVec3) -> AxisPlane {
        AxisPlane {
            axis: self.axis as u8,
            coordinate: (self.coordinate - origin[self.axis]) as f32,
            is_along_axis: self.is_along_axis,
        }
    }
}

//! Spheres, and the ellipsoids that they become.

use super::quadric::PlacedQuadric;
use super::similarity::scale_of;
use super::{Placed, PlacedPrimitive};
use crate::shape::Sphere;
use glam::{DMat3, DMat4, DVec3};

/// A sphere, or an ellipsoid if the map scales unequally.
pub(super) fn placed(centre: DVec3, radius: f64, to_world: &DMat4) -> Box<dyn Placed> {
    let (linear, centre) = (
        DMat3::from_mat4(*to_world),
        to_world.transform_point3(centre),
    );
    match scale_of(linear) {
        Some(scale) => Box::new(PlacedSphere {
            centre,
            radius: scale * radius,
        }),
        None => Box::new(PlacedQuadric::ellipsoid(centre, linear * radius)),
    }
}

#[derive(Debug)]
struct PlacedSphere {
    centre: DVec3,
    radius: f64,
}

impl PlacedPrimitive for PlacedSphere {
    type Shape = Sphere;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let reach = DVec3::splat(self.radius);
        Some([self.centre - reach, self.centre + reach])
    }

    fn rounded(&self, origin: DVec3) -> Sphere {
        Sphere {
            centre: (self.centre - origin).as_vec3(),
            radius: self.radius as f32,
        }
    }
}

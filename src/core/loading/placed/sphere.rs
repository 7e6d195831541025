//! Spheres, and the ellipsoids that they become.

use super::quadric::PlacedQuadric;
use super::similarity::scale_of;
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::group::UnitShape;
use crate::scene_file::{self, Shape};
use crate::shape::Sphere;
use glam::{DMat3, DMat4, DVec3};

impl Placeable for scene_file::Sphere {
    /// As in Mitsuba.
    const FLIPS_WHEN_MIRRORED: bool = true;

    /// A sphere, or an ellipsoid if the map scales unequally.
    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let linear = DMat3::from_mat4(*to_world);
        let centre = to_world.transform_point3(self.center);
        Ok(match scale_of(linear) {
            Some(scale) => Box::new(PlacedSphere {
                centre,
                radius: scale * self.radius,
            }),
            None => Box::new(PlacedQuadric::ellipsoid(centre, linear * self.radius)),
        })
    }

    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        let size = DMat4::from_scale(DVec3::splat(self.radius));
        Some((
            UnitShape::Sphere,
            DMat4::from_translation(self.center) * size,
        ))
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

//! Cylinders and cones.

use super::similarity::scale_across;
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::group::UnitShape;
use crate::scene_file::{self, Place};
use crate::shape::{Cone, Cylinder};
use glam::{DMat3, DMat4, DVec3};

/// The parameters that cylinders and cones have in common.
#[derive(Debug)]
struct Axial {
    ends: [DVec3; 2],
    radius: f64,
    is_capped: bool,
}

impl Axial {
    /// # Errors
    /// The map makes the shape elliptic or oblique.
    fn transformed(self, place: Place, to_world: &DMat4) -> Result<Self, Refusal> {
        let [p0, p1] = self.ends;
        let scale = scale_across(DMat3::from_mat4(*to_world), p1 - p0);
        let message = "the transform makes the shape elliptic or oblique, which isn't supported";
        Ok(Self {
            ends: self.ends.map(|end| to_world.transform_point3(end)),
            radius: self.radius * scale.ok_or_else(|| Refusal::new(place, message))?,
            ..self
        })
    }

    fn bounds(&self) -> [DVec3; 2] {
        let reach = DVec3::splat(self.radius);
        let [a, b] = self.ends;
        [a.min(b) - reach, a.max(b) + reach]
    }

    fn check_closed(&self, name: &str) -> Result<(), String> {
        if self.is_capped {
            return Ok(());
        }
        Err(format!(
            "an open {name} isn't a solid: set “capped” to true"
        ))
    }
}

#[derive(Debug)]
struct PlacedCylinder(Axial);

#[derive(Debug)]
struct PlacedCone(Axial);

impl Placeable for scene_file::Cylinder {
    fn placed(&self, place: Place, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let axial = Axial {
            ends: [self.p0, self.p1],
            radius: self.radius,
            is_capped: self.is_capped,
        };
        let axial = axial.transformed(place, to_world)?;
        Ok(Box::new(PlacedCylinder(axial)))
    }

    /// Mitsuba measures angles from an axis across the cylinder's own.
    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        let axis = self.p1 - self.p0;
        let (x, y) = axis.try_normalize()?.any_orthonormal_pair();
        let linear = DMat3::from_cols(self.radius * x, self.radius * y, axis);
        let place = DMat4::from_translation(self.p0);
        Some((UnitShape::Cylinder, place * DMat4::from_mat3(linear)))
    }
}

impl Placeable for scene_file::Cone {
    fn placed(&self, place: Place, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let axial = Axial {
            ends: [self.p0, self.p1],
            radius: self.radius,
            is_capped: self.is_capped,
        };
        let axial = axial.transformed(place, to_world)?;
        Ok(Box::new(PlacedCone(axial)))
    }
}

impl PlacedPrimitive for PlacedCylinder {
    type Shape = Cylinder;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.0.bounds())
    }

    fn rounded(&self, origin: DVec3) -> Cylinder {
        let [p0, p1] = self.0.ends.map(|end| (end - origin).as_vec3());
        Cylinder {
            p0,
            p1,
            radius: self.0.radius as f32,
            is_capped: self.0.is_capped,
        }
    }

    fn check_closed(&self) -> Result<(), String> {
        self.0.check_closed("cylinder")
    }
}

impl PlacedPrimitive for PlacedCone {
    type Shape = Cone;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.0.bounds())
    }

    fn rounded(&self, origin: DVec3) -> Cone {
        let [p0, p1] = self.0.ends.map(|end| (end - origin).as_vec3());
        Cone {
            p0,
            p1,
            radius: self.0.radius as f32,
            is_capped: self.0.is_capped,
        }
    }

    fn check_closed(&self) -> Result<(), String> {
        self.0.check_closed("cone")
    }
}

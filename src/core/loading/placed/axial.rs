//! Cylinders and cones.

use super::PlacedPrimitive;
use super::similarity::scale_across;
use crate::shape::{Cone, Cylinder};
use glam::{DMat3, DMat4, DVec3};

/// The parameters that cylinders and cones have in common.
#[derive(Debug)]
pub(super) struct Axial {
    ends: [DVec3; 2],
    radius: f64,
    is_capped: bool,
}

impl Axial {
    /// # Errors
    /// The map makes the shape elliptic or oblique.
    pub fn new(
        ends: [DVec3; 2],
        radius: f64,
        is_capped: bool,
        to_world: &DMat4,
    ) -> Result<Self, &'static str> {
        let scale = scale_across(DMat3::from_mat4(*to_world), ends[1] - ends[0]);
        Ok(Self {
            ends: ends.map(|end| to_world.transform_point3(end)),
            radius: radius
                * scale.ok_or(
                    "the transform makes the shape elliptic or oblique, which isn't supported",
                )?,
            is_capped,
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
pub(super) struct PlacedCylinder(pub Axial);

#[derive(Debug)]
pub(super) struct PlacedCone(pub Axial);

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

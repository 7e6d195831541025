//! Cylinders and cones.

use super::as_quadric::{axis_along, quadric_of};
use super::similarity::{Distortion, scale_across};
use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::group::UnitShape;
use crate::scene_file::{self, Shape, number_text};
use crate::shape::{Cone, Cylinder, disk_reach};
use glam::{DMat3, DMat4, DVec3};

/// The parameters that cylinders and cones have in common.
#[derive(Debug)]
pub(super) struct Axial {
    pub ends: [DVec3; 2],
    /// The radius at the first end.
    pub radius: f64,
    pub tip: Tip,
    pub is_capped: bool,
}

/// The second end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tip {
    /// A circle: a cylinder.
    Round,
    /// An apex: a cone.
    Pointed,
}

impl From<&scene_file::Cylinder> for Axial {
    fn from(cylinder: &scene_file::Cylinder) -> Self {
        Self {
            ends: [cylinder.p0, cylinder.p1],
            radius: cylinder.radius,
            tip: Tip::Round,
            is_capped: cylinder.is_capped,
        }
    }
}

impl From<&scene_file::Cone> for Axial {
    fn from(cone: &scene_file::Cone) -> Self {
        Self {
            ends: [cone.p0, cone.p1],
            radius: cone.radius,
            tip: Tip::Pointed,
            is_capped: cone.is_capped,
        }
    }
}

impl Axial {
    /// # Errors
    /// The map makes the shape elliptic or oblique.
    fn transformed(self, shape: &Shape, to_world: &DMat4) -> Result<Self, Refusal> {
        let [p0, p1] = self.ends;
        match scale_across(DMat3::from_mat4(*to_world), p1 - p0) {
            Ok(scale) => Ok(Self {
                ends: self.ends.map(|end| to_world.transform_point3(end)),
                radius: self.radius * scale,
                ..self
            }),
            Err(distortion) => Err(Refusal::of_shape(shape, self.refusal(distortion, shape))),
        }
    }

    /// The message about a map that isn't supported, with ways out.
    fn refusal(&self, distortion: Distortion, shape: &Shape) -> String {
        let problem = match distortion {
            Distortion::Elliptic(factors) => {
                let [most, least] = factors.map(|factor| number_text(rounded(factor, 6)));
                format!(
                    "elliptic: it scales by {most} and by {least} across the axis. These factors must be equal; along the axis, any is possible"
                )
            }
            Distortion::Oblique => "oblique: the circles aren't perpendicular to the axis any more. Only scaling along and across the axis, rotation and translation are possible".to_owned(),
        };
        let is_cut_at_ends = axis_along(self, &shape.to_world).is_some();
        let differences = match (self.is_capped, is_cut_at_ends) {
            (false, true) => "",
            (false, false) => " (it ends at the sides of its box)",
            (true, true) => " (without caps outside a csg)",
            (true, false) => " (it ends at the sides of its box, without caps outside a csg)",
        };
        let quadric = quadric_of(self, &shape.to_world);
        format!(
            "the transform makes it {problem}. Or use a “quadric” without a transform{differences}: {quadric}"
        )
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [a, b] = self.ends;
        let reach = DVec3::from(disk_reach((b - a).to_array(), self.radius));
        match self.tip {
            Tip::Round => [a.min(b) - reach, a.max(b) + reach],
            Tip::Pointed => [(a - reach).min(b), (a + reach).max(b)],
        }
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

/// A number rounded to some significant digits.
pub(super) fn rounded(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.*e}", digits - 1);
    text.parse().unwrap_or(number)
}

#[derive(Debug)]
struct PlacedCylinder(Axial);

#[derive(Debug)]
struct PlacedCone(Axial);

impl Placeable for scene_file::Cylinder {
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let axial = Axial::from(self).transformed(shape, to_world)?;
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
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let axial = Axial::from(self).transformed(shape, to_world)?;
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

//! Shapes of scene files in the coordinates of the world, in f64, and their f32 counterparts: one file per shape.

mod axial;
mod cuboid;
mod flat;
mod groups;
mod plane;
mod quadric;
mod similarity;
mod solid;
mod sphere;
mod torus;

pub(super) use groups::Groups;

use crate::group::{Grouped, Solid};
use crate::scene_file::{Place, Shape, ShapeKind};
use glam::{DMat3, DMat4, DVec3};
use std::fmt::Debug;

/// Why a shape can't be placed, and its place in the file.
#[derive(Debug)]
pub(super) struct Refusal {
    pub place: Place,
    pub message: String,
}

/// A shape in the world's coordinates.
pub(super) trait Placed: Debug {
    /// The box around the shape; `None` if it is infinite.
    fn bounds(&self) -> Option<[DVec3; 2]>;

    /// Adds the shape to its group, relative to an origin and rounded to f32.
    fn push_to(&self, groups: &mut Groups, origin: DVec3, material: u32);

    /// Checks that the surface is closed, so that the shape is a solid.
    ///
    /// # Errors
    /// Why it isn't one.
    fn check_closed(&self) -> Result<(), String>;

    /// The interior of the shape, relative to an origin and rounded to f32.
    fn solid(&self, origin: DVec3) -> Solid;
}

/// A shape in the world's coordinates that becomes a primitive.
pub(super) trait PlacedPrimitive: Debug {
    /// Its counterpart in f32.
    type Shape: Grouped;

    /// See [`Placed::bounds`].
    fn bounds(&self) -> Option<[DVec3; 2]>;

    /// The shape relative to an origin, rounded to f32.
    fn rounded(&self, origin: DVec3) -> Self::Shape;

    /// See [`Placed::check_closed`].
    fn check_closed(&self) -> Result<(), String> {
        Ok(())
    }

    /// The interior of a shape.
    fn solid(shape: Self::Shape) -> Solid {
        Solid::of(shape)
    }
}

impl<P: PlacedPrimitive> Placed for P {
    fn bounds(&self) -> Option<[DVec3; 2]> {
        P::bounds(self)
    }

    fn push_to(&self, groups: &mut Groups, origin: DVec3, material: u32) {
        groups.push(self.rounded(origin), material);
    }

    fn check_closed(&self) -> Result<(), String> {
        P::check_closed(self)
    }

    fn solid(&self, origin: DVec3) -> Solid {
        P::solid(self.rounded(origin))
    }
}

/// The axis along which a vector points, if it points along one.
fn axis_of(vector: DVec3) -> Option<usize> {
    let is_along = |axis: &usize| (0..3).all(|other| (vector[other] != 0.0) == (other == *axis));
    (0..3).find(is_along)
}

/// A shape transformed by an affine map. `None` for meshes.
///
/// # Errors
/// The transformed shape isn't supported.
pub(super) fn placed(shape: &Shape, to_world: &DMat4) -> Result<Option<Box<dyn Placed>>, Refusal> {
    let linear = DMat3::from_mat4(*to_world);
    let refused = |message: &str| Refusal {
        place: shape.place,
        message: message.to_owned(),
    };
    if !(linear.determinant() != 0.0 && to_world.is_finite()) {
        return Err(refused(
            "the transform makes the shape flat: its matrix is singular",
        ));
    }
    Ok(Some(match shape.kind {
        ShapeKind::Obj { .. } => return Ok(None),
        ShapeKind::Sphere { center, radius } => sphere::placed(center, radius, to_world),
        ShapeKind::Plane { point, normal } => plane::placed(point, normal, to_world),
        ShapeKind::Disk => Box::new(flat::PlacedDisk::new(to_world)),
        ShapeKind::Rectangle => Box::new(flat::PlacedRectangle::new(to_world)),
        ShapeKind::Cube => cuboid::placed(to_world, -DVec3::ONE, DVec3::ONE),
        ShapeKind::Box { min, max } => cuboid::placed(to_world, min, max),
        ShapeKind::Cylinder {
            p0,
            p1,
            radius,
            is_capped,
        } => {
            let axial = axial::Axial::new([p0, p1], radius, is_capped, to_world);
            Box::new(axial::PlacedCylinder(axial.map_err(refused)?))
        }
        ShapeKind::Cone {
            p0,
            p1,
            radius,
            is_capped,
        } => {
            let axial = axial::Axial::new([p0, p1], radius, is_capped, to_world);
            Box::new(axial::PlacedCone(axial.map_err(refused)?))
        }
        ShapeKind::Torus {
            center,
            axis,
            major,
            minor,
        } => {
            let torus = torus::PlacedTorus::new(center, axis, [major, minor], to_world);
            Box::new(torus.map_err(refused)?)
        }
        ShapeKind::Quadric(ref quadric) => {
            let quadric = quadric::PlacedQuadric::new(quadric, to_world);
            Box::new(quadric.map_err(refused)?)
        }
        ShapeKind::Csg {
            operation,
            ref children,
        } => Box::new(solid::PlacedSolid::new(operation, children, to_world)?),
    }))
}

//! Shapes of scene files in the coordinates of the world, in f64, and their f32 counterparts: one file per kind of
//! shape or pair of similar kinds.

mod as_quadric;
mod axial;
mod csg;
mod cuboid;
mod flat;
mod groups;
mod obj;
mod plane;
mod quadric;
mod similarity;
mod sphere;
mod torus;

pub(super) use groups::{Groups, Look};

use super::memory::{BYTES_PER_ALLOCATION, Needs};
use super::refusal::Refusal;
use crate::group::{Grouped, Placement, Solid, UnitShape};
use crate::scene_file::{self, Place, Shape, ShapeKind, with_kinds};
use crate::shape::{Shape as _, numbers_of};
use glam::{DMat3, DMat4, DVec3};
use std::fmt::Debug;

/// A kind of shape of scene files.
trait Placeable {
    /// Whether a transform that mirrors reverses the normals of the placed shape.
    const FLIPS_WHEN_MIRRORED: bool = false;

    /// The shape transformed by an invertible affine map: `shape.to_world` and then those of the solids around it.
    ///
    /// # Errors
    /// The transformed shape isn't supported.
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal>;

    /// The unit shape whose texture coordinates it has, and the map from it; `None` if it has none.
    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        None
    }
}

/// A shape in the world's coordinates.
pub(super) trait Placed: Debug {
    /// The box around the shape; `None` if it is infinite.
    fn bounds(&self) -> Option<[DVec3; 2]>;

    /// Adds the shape to its group, relative to an origin and rounded to f32.
    fn push_to(&self, groups: &mut Groups, origin: DVec3, look: Look);

    /// Checks that the surface is closed, so that the shape is a solid.
    ///
    /// # Errors
    /// Why it isn't one.
    fn check_closed(&self) -> Result<(), String>;

    /// The interior of the shape, relative to an origin and rounded to f32. Adds the places of the parts that are certainly
    /// empty, and not only because a part of theirs is, to `empty`.
    fn solid(&self, origin: DVec3, empty: &mut Vec<Place>) -> Solid;

    /// Whether rays can hit the shape after it is rounded to f32 relative to an origin: nothing overflows, and it doesn't
    /// shrink to a point.
    fn fits(&self, origin: DVec3) -> bool;

    /// The memory of the shape.
    fn needs(&self) -> Needs;

    /// The number of operands of [`solid`](Self::solid).
    fn operand_count(&self) -> usize;
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

    /// Whether the shape's numbers, if they are finite, still describe it.
    fn is_kept(_: &Self::Shape) -> bool {
        true
    }

    /// The number of operands of [`solid`](Self::solid).
    const OPERAND_COUNT: usize = 1;

    /// The interior of a shape.
    fn solid(shape: Self::Shape) -> Solid {
        Solid::of(shape)
    }
}

impl<P: PlacedPrimitive> Placed for P {
    fn bounds(&self) -> Option<[DVec3; 2]> {
        P::bounds(self)
    }

    fn push_to(&self, groups: &mut Groups, origin: DVec3, look: Look) {
        groups.push(self.rounded(origin), look);
    }

    fn check_closed(&self) -> Result<(), String> {
        P::check_closed(self)
    }

    fn solid(&self, origin: DVec3, _: &mut Vec<Place>) -> Solid {
        P::solid(self.rounded(origin))
    }

    fn fits(&self, origin: DVec3) -> bool {
        let rounded = self.rounded(origin);
        let bounds = rounded.bounds();
        let is_bounded = !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite();
        let numbers = &numbers_of(&rounded)[..P::Shape::NUMBERS];
        numbers.iter().all(|number| number.is_finite())
            && P::is_kept(&rounded)
            && (is_bounded || !P::Shape::IS_BOUNDED)
            && P::bounds(self).is_none_or(is_large_enough)
    }

    fn needs(&self) -> Needs {
        Needs {
            placed: (size_of::<P>() + BYTES_PER_ALLOCATION) as u64,
            shapes: size_of::<P::Shape>() as u64,
            primitive_count: 1,
            ..Needs::default()
        }
    }

    fn operand_count(&self) -> usize {
        P::OPERAND_COUNT
    }
}

/// Whether a box is large enough for f32: its longest edge is a normal number.
pub(super) fn is_large_enough([min, max]: [DVec3; 2]) -> bool {
    (max - min).max_element() >= f64::from(f32::MIN_POSITIVE)
}

/// The axis along which a vector points, if it points along one.
fn axis_of(vector: DVec3) -> Option<usize> {
    let is_along = |axis: &usize| (0..3).all(|other| (vector[other] != 0.0) == (other == *axis));
    (0..3).find(is_along)
}

/// The refusal of a shape that doesn't [fit](Placed::fits).
pub(super) fn misfit(place: Place) -> Refusal {
    let message = "the shape doesn't fit in 32-bit numbers: its size and its distance from the other shapes must be from 1.2e-38 to 3.4e38";
    Refusal::new(place, message)
}

/// Checks that a transform is invertible.
///
/// # Errors
/// The transform isn't invertible.
pub(super) fn require_invertible(shape: &Shape, to_world: &DMat4) -> Result<(), Refusal> {
    if DMat3::from_mat4(*to_world).determinant() != 0.0 && to_world.is_finite() {
        return Ok(());
    }
    let message = "the transform makes it flat: its matrix is singular";
    Err(Refusal::of_shape(shape, message))
}

/// Whether a transform exchanges left and right.
pub(super) fn is_mirroring(to_world: &DMat4) -> bool {
    DMat3::from_mat4(*to_world).determinant() < 0.0
}

macro_rules! placing {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// A shape transformed by an affine map.
        ///
        /// # Errors
        /// The transform isn't invertible, or the transformed shape isn't supported.
        pub(super) fn placed(shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
            require_invertible(shape, to_world)?;
            match &shape.kind {
                $(ShapeKind::$kind(kind) => kind.placed(shape, to_world),)*
            }
        }

        /// The texture coordinates of a shape in the world.
        pub(super) fn placement(shape: &Shape) -> Option<Placement> {
            let (unit, to_shape) = match &shape.kind {
                $(ShapeKind::$kind(kind) => kind.unit(),)*
            }?;
            Some(Placement::new(unit, shape.to_world * to_shape))
        }

        /// Whether the normals of a placed shape are reversed: by `flip_normals`, or by a transform that mirrors.
        pub(super) fn is_flipped(shape: &Shape) -> bool {
            let flips_when_mirrored = match &shape.kind {
                $(ShapeKind::$kind(_) => scene_file::$kind::FLIPS_WHEN_MIRRORED,)*
            };
            shape.flip_normals != (flips_when_mirrored && is_mirroring(&shape.to_world))
        }
    };
}

with_kinds!(placing);

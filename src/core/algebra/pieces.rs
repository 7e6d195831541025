//! Shapes as polynomials along a ray.

use super::interval_roots::RootIntervals;
use super::polynomial::Polynomial;
use super::quick_line::QuickLine;
use super::ring::{Ring, vector};
use crate::ray::Ray;
use glam::Vec3;

/// A ray in the numbers of a formula.
#[derive(Clone, Debug)]
pub struct RayIn<R> {
    pub origin: [R; 3],
    pub dir: [R; 3],
}

impl<R: Ring> RayIn<R> {
    pub fn of(ray: &Ray) -> Self {
        Self {
            origin: vector(ray.origin),
            dir: vector(ray.dir),
        }
    }
}

/// A part of a shape's surface along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a, R> {
    /// Number of the part, in the shape's own order.
    pub part: u8,
    /// Zero where the ray meets the surface. The polynomial 0 stands for no crossing.
    pub surface: &'a Polynomial<R>,
    /// None is negative at a crossing.
    pub conditions: &'a [Polynomial<R>],
}

/// A shape, described by polynomials.
pub trait Pieces {
    /// A point near the shape. It affects the speed, but no answer.
    fn centre(&self) -> Vec3;

    /// Bounds of the line's crossings with the shape; `None` if plain f64 doesn't decide.
    ///
    /// Only for shapes of a single piece of part 0. If the piece has no conditions, these are the bounds of all roots
    /// of its polynomial; otherwise those of its only root, or none if that root violates a condition.
    #[inline(always)]
    fn quick_roots(&self, _line: &QuickLine) -> Option<RootIntervals> {
        None
    }

    /// Passes all pieces to `emit`, always the same number of them in the same order.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<R>));
}

//! The points that a primitive's surface encloses.

use crate::algebra::{Dyadic, Piece, Pieces, RayIn, vector};
use crate::ray::Ray;
use std::cmp::Ordering;

/// The points that a primitive's surface encloses, as far as a line's crossings with the surface need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interior {
    /// None: the surface isn't closed.
    Open,
    /// Convex and bounded: those between the first and the last crossing.
    Convex,
    /// Bounded: the line enters and leaves it in turn.
    Bounded,
    /// Unbounded: whether the line's start and its end lie inside.
    Unbounded([bool; 2]),
}

/// The interior of a surface of one piece, on the side where its polynomial is negative.
pub(super) fn unbounded<S: Pieces>(shape: &S, ray: &Ray) -> Interior {
    let ray = RayIn::<Dyadic> {
        origin: vector(ray.origin),
        dir: vector(ray.dir),
    };
    let mut ends = [false; 2];
    shape.pieces(&ray, &mut |piece: Piece<'_, Dyadic>| {
        // Far away the leading term decides.
        let coefficients = piece.surface.significant();
        let leading = coefficients[coefficients.len() - 1].sign();
        let is_even = coefficients.len() % 2 == 1;
        let at_start = if is_even { leading } else { leading.reverse() };
        ends = [at_start, leading].map(|sign| sign == Ordering::Less);
    });
    Interior::Unbounded(ends)
}

//! How crossings divide a line into parts inside and outside a primitive.

use crate::algebra::{Dyadic, Piece, Pieces, RayIn};
use crate::ray::Ray;
use std::cmp::Ordering;

/// The largest coordinate of a point that counts as inside or outside an unbounded primitive: far beyond every scene,
/// yet far below the largest f32.
pub(crate) const UNBOUNDED: f32 = 1e30;

/// How crossings divide a line into parts inside and outside a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interior {
    /// None is inside: the surface isn't closed.
    Open,
    /// Convex and bounded: the part between the first and the last crossing is inside.
    Convex,
    /// Bounded: crossings alternate between entering and leaving. A tube that meets itself is hollow there.
    Bounded,
    /// Unbounded: whether the points at t = −`reach` and t = `reach` are inside. Crossings beyond them don't count.
    Unbounded {
        /// The bound of t.
        reach: f64,
        /// Whether the line is inside at either end.
        ends: [bool; 2],
    },
}

/// The interior of a surface of one piece, on the side where its polynomial is negative.
pub(super) fn negative_side<S: Pieces>(shape: &S, ray: &Ray) -> Interior {
    let reach = f64::from(UNBOUNDED) / f64::from(ray.dir.abs().max_element());
    let reach = reach.min(f64::from(f32::MAX));
    let mut ends = [false; 2];
    shape.pieces(&RayIn::of(ray), &mut |piece: Piece<'_, Dyadic>| {
        let is_inside = |t: f64| piece.surface.at(&Dyadic::from(t)).sign() == Ordering::Less;
        ends = [-reach, reach].map(is_inside);
    });
    Interior::Unbounded { reach, ends }
}

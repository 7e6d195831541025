//! Boxes that a ray must meet for its hit of a triangle to count.
//!
//! A box encloses the triangle's corners as the kernel computes them. It lies within
//! [`Shape::bounds`](crate::shape::Shape::bounds), from which the tree is built, so a ray that meets it also meets
//! every box of the tree around the triangle.

use crate::aabb::Planes;
use crate::lane::{Lane, Number, Values, plus};
use crate::shape::{Shape as _, Triangle};
use glam::Vec3;

/// The box around A, A + e1 and A + e2, which are packed from value 0.
#[inline(always)]
pub(super) fn around_edges<L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
    let a = triangles.three(0);
    let (b, c) = (plus(&a, &triangles.three(3)), plus(&a, &triangles.three(6)));
    Triangle::planes(&Corners([a, b, c]))
}

struct Corners<L>([[L; 3]; 3]);

impl<L: Lane> Values<L> for Corners<L> {
    #[inline(always)]
    fn value(&self, index: usize) -> L {
        self.0[index / 3][index % 3]
    }
}

/// Packs the box of a triangle whose corners the kernel doesn't store; [`kept`] reads it.
pub(super) fn pack<N: Number>([a, b, c]: [Vec3; 3], values: &mut [N]) {
    let (lower, upper) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
    for (axis, kept) in values.chunks_exact_mut(2).enumerate() {
        kept.copy_from_slice(&[N::from(lower[axis]), N::from(upper[axis])]);
    }
}

/// The box packed at `first`.
#[inline(always)]
pub(super) fn kept<L: Lane>(triangles: &impl Values<L>, first: usize) -> Planes<L> {
    let ([a, b, c], [d, e, f]) = (triangles.three(first), triangles.three(first + 3));
    [a, b, c, d, e, f]
}

/// The number of values that [`pack`] writes.
pub(super) const VALUES: usize = 6;

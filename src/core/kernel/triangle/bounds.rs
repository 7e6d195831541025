//! Which box must a ray meet for its hit of a triangle to count?
//!
//! The box around the triangle's corners, as the kernel takes them to be. Each lies within the one that the
//! tree is built from, [`triangle_bounds`], so that a ray that meets it meets every box of the tree around
//! the triangle.

use crate::aabb::{Aabb, Planes};
use crate::kernel::Values;
use crate::lane::{Lane, Number, plus};
use crate::mesh::TriangleMesh;
use glam::Vec3;

/// The box of a triangle in the tree: around its corners, and around those that a kernel finds again from
/// the first one and the edges.
pub fn triangle_bounds([a, b, c]: [Vec3; 3]) -> Aabb {
    Aabb::around([a, b, c, a + (b - a), a + (c - a)])
}

/// [`triangle_bounds`] of each of a mesh's triangles: what a tree over it is built from.
pub fn bounds_in(mesh: &TriangleMesh) -> impl Fn(u32) -> Aabb + Sync {
    |triangle| triangle_bounds(mesh.corners(triangle))
}

/// The box around A, B and C, packed from the first value on.
#[inline(always)]
pub(super) fn around_corners<L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
    around([triangles.three(0), triangles.three(3), triangles.three(6)])
}

/// The box around A, A + e1 and A + e2, packed from the first value on.
#[inline(always)]
pub(super) fn around_edges<L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
    let a = triangles.three(0);
    let (b, c) = (plus(&a, &triangles.three(3)), plus(&a, &triangles.three(6)));
    around([a, b, c])
}

#[inline(always)]
fn around<L: Lane>([a, b, c]: [[L; 3]; 3]) -> Planes<L> {
    let lower = |axis: usize| a[axis].lesser(b[axis]).lesser(c[axis]);
    let upper = |axis: usize| a[axis].greater(b[axis]).greater(c[axis]);
    [lower(0), upper(0), lower(1), upper(1), lower(2), upper(2)]
}

/// Packs the box of a triangle of which the kernel keeps no corners: [`kept`] finds it again.
pub(super) fn pack<N: Number>([a, b, c]: [Vec3; 3], values: &mut [N]) {
    let (lower, upper) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
    for (axis, kept) in values.chunks_exact_mut(2).enumerate() {
        kept.copy_from_slice(&[N::from(lower[axis]), N::from(upper[axis])]);
    }
}

/// The box that was packed from `first` on.
#[inline(always)]
pub(super) fn kept<L: Lane>(triangles: &impl Values<L>, first: usize) -> Planes<L> {
    let ([a, b, c], [d, e, f]) = (triangles.three(first), triangles.three(first + 3));
    [a, b, c, d, e, f]
}

/// How many values [`pack`] makes.
pub(super) const VALUES: usize = 6;

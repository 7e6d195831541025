//! Ray–quadric kernels and their table.

mod naive;
mod shifted;

use super::crossings::{Nearest, Roots};
use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::lane::{Lane, Values, dot};
use crate::shape::Quadric;
use naive::Naive;
use shifted::Shifted;
use std::sync::LazyLock;

/// All quadric kernels, ordered by algorithm.
pub static QUADRIC_KERNELS: LazyLock<Vec<KernelRow<Quadric>>> = LazyLock::new(rows_of);

impl KernelTable for Quadric {
    fn kernels() -> &'static [KernelRow<Self>] {
        &QUADRIC_KERNELS
    }
}

impl KernelList for Quadric {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Naive, f32>();
        visitor.visit::<Naive, f64>();
        visitor.visit::<Shifted, f32>();
        visitor.visit::<Shifted, f64>();
        visitor.visit_algebraic();
    }
}

/// a, b and c of the equation a·t² + 2b·t + c = 0 along f + t·d.
#[inline(always)]
fn coefficients<L: Lane>(quadrics: &impl Values<L>, f: &[L; 3], d: &[L; 3]) -> [L; 3] {
    let [xx, yy, zz] = quadrics.three(0);
    let [xy, yz, xz] = quadrics.three(3);
    let linear = quadrics.three(6);
    let constant = quadrics.value(9);
    // The symmetric matrix of the quadratic terms, times a vector.
    let product = |v: &[L; 3]| {
        [
            xx * v[0] + xy * v[1] + xz * v[2],
            xy * v[0] + yy * v[1] + yz * v[2],
            xz * v[0] + yz * v[1] + zz * v[2],
        ]
    };
    let (of_d, of_f) = (product(d), product(f));
    let two = L::of(constant.token(), 2.0);
    [
        dot(d, &of_d),
        dot(f, &of_d) + dot(&linear, d),
        dot(f, &of_f) + two * dot(&linear, f) + constant,
    ]
}

/// Offers the crossings inside the box. They are at the roots plus the shift. If a is 0, the line meets the surface
/// once, and the other root is infinite.
#[inline(always)]
fn offer<L: Lane>(
    nearest: &mut Nearest<L>,
    roots: &Roots<L>,
    quadrics: &impl Values<L>,
    f: &[L; 3],
    d: &[L; 3],
    shift: L,
) {
    let half = quadrics.three(13);
    for root in [roots.near, roots.far] {
        let is_inside = |axis: usize| (f[axis] + root * d[axis]).abs().le(half[axis]);
        let is_inside = is_inside(0) & is_inside(1) & is_inside(2);
        nearest.offer(roots.exist & is_inside, root + shift, 0);
    }
}

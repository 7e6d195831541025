//! Ray–cylinder kernels and their table.

mod naive;
mod stable;

use super::crossings::{Nearest, Roots};
use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::lane::{Lane, dot, plus, times};
use crate::shape::{Cylinder, SIDE};
use naive::Naive;
use stable::Stable;
use std::sync::LazyLock;

/// All cylinder kernels, ordered by algorithm.
pub static CYLINDER_KERNELS: LazyLock<Vec<KernelRow<Cylinder>>> = LazyLock::new(rows_of);

impl KernelTable for Cylinder {
    fn kernels() -> &'static [KernelRow<Self>] {
        &CYLINDER_KERNELS
    }
}

impl KernelList for Cylinder {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Naive, f32>();
        visitor.visit::<Naive, f64>();
        visitor.visit::<Stable, f32>();
        visitor.visit::<Stable, f64>();
        visitor.visit_algebraic();
    }
}

/// Offers the crossings of the infinite side whose position along the axis is between 0 and w·w. `along` is the
/// position at t = 0 and its growth.
#[inline(always)]
pub(super) fn offer_side<L: Lane>(
    nearest: &mut Nearest<L>,
    roots: &Roots<L>,
    along: [L; 2],
    length_squared: L,
) {
    let zero = L::of(length_squared.token(), 0.0);
    for t in [roots.near, roots.far] {
        let at = along[0] + t * along[1];
        nearest.offer(roots.exist & zero.le(at) & at.le(length_squared), t, SIDE);
    }
}

/// Offers the crossing with the disk at a position along the axis, if the shape is capped. `across` is f×w at t = 0 and
/// its growth, `along` is f·w likewise; `reach` is the square of r·|w|.
#[inline(always)]
pub(super) fn offer_cap<L: Lane>(
    nearest: &mut Nearest<L>,
    is_capped: L,
    across: [&[L; 3]; 2],
    along: [L; 2],
    (part, end): (u8, L),
    reach: L,
) {
    let t = (end - along[0]) / along[1];
    let side = plus(across[0], &times(t, across[1]));
    let zero = L::of(t.token(), 0.0);
    nearest.offer(zero.lt(is_capped) & dot(&side, &side).le(reach), t, part);
}

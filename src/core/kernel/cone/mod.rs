//! Ray–cone kernels and their table.

mod naive;
mod stable;

use super::crossings::Nearest;
use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::lane::{Lane, dot, plus, times};
use crate::shape::{BASE, Cone};
use naive::Naive;
use stable::Stable;
use std::sync::LazyLock;

/// All cone kernels, ordered by algorithm.
pub static CONE_KERNELS: LazyLock<Vec<KernelRow<Cone>>> = LazyLock::new(rows_of);

impl KernelTable for Cone {
    fn kernels() -> &'static [KernelRow<Self>] {
        &CONE_KERNELS
    }
}

impl KernelList for Cone {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Naive, f32>();
        visitor.visit::<Naive, f64>();
        visitor.visit::<Stable, f32>();
        visitor.visit::<Stable, f64>();
        visitor.visit_algebraic();
    }
}

/// Offers the crossing with the disk at the base, if the cone is capped.
#[inline(always)]
fn offer_base<L: Lane>(
    nearest: &mut Nearest<L>,
    is_capped: L,
    across: [&[L; 3]; 2],
    along: [L; 2],
    length_squared: L,
    r_squared: L,
) {
    let t = (length_squared - along[0]) / along[1];
    let side = plus(across[0], &times(t, across[1]));
    let is_inside = dot(&side, &side).le(r_squared * length_squared);
    let zero = L::of(t.token(), 0.0);
    nearest.offer(zero.lt(is_capped) & is_inside, t, BASE);
}

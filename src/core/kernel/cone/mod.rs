//! Ray–cone kernels and their table.

mod naive;
mod stable;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::shape::Cone;
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

//! Ray–plane kernels and their table.

mod hesse;
mod point_normal;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::shape::Plane;
use hesse::Hesse;
use point_normal::PointNormal;
use std::sync::LazyLock;

/// All plane kernels, ordered by algorithm.
pub static PLANE_KERNELS: LazyLock<Vec<KernelRow<Plane>>> = LazyLock::new(rows_of);

impl KernelTable for Plane {
    fn kernels() -> &'static [KernelRow<Self>] {
        &PLANE_KERNELS
    }
}

impl KernelList for Plane {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Hesse, f32>();
        visitor.visit::<Hesse, f64>();
        visitor.visit::<PointNormal, f32>();
        visitor.visit::<PointNormal, f64>();
        visitor.visit_algebraic();
    }
}

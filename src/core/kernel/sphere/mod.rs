//! Ray–sphere kernels and their table.

mod algebraic;
mod geometric;
mod hearn_baker;
mod moved_origin;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::shape::Sphere;
use algebraic::Algebraic;
use geometric::Geometric;
use hearn_baker::HearnBaker;
use moved_origin::MovedOrigin;
use std::sync::LazyLock;

/// All sphere kernels, ordered by algorithm.
pub static SPHERE_KERNELS: LazyLock<Vec<KernelRow<Sphere>>> = LazyLock::new(rows_of);

impl KernelTable for Sphere {
    fn kernels() -> &'static [KernelRow<Self>] {
        &SPHERE_KERNELS
    }
}

impl KernelList for Sphere {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Algebraic, f32>();
        visitor.visit::<Algebraic, f64>();
        visitor.visit::<MovedOrigin, f32>();
        visitor.visit::<MovedOrigin, f64>();
        visitor.visit_with_levels::<Geometric, f32>();
        visitor.visit::<Geometric, f64>();
        visitor.visit_with_packets::<HearnBaker>();
        visitor.visit_with_levels::<HearnBaker, f64>();
        visitor.visit_algebraic_with_levels();
    }
}

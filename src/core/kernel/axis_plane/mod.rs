//! Kernels of planes that are perpendicular to an axis, and their table.

mod division;
mod reciprocal;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::lane::Lane;
use crate::shape::AxisPlane;
use division::Division;
use reciprocal::Reciprocal;
use std::sync::LazyLock;

/// All kernels of axis-aligned planes, ordered by algorithm.
pub static AXIS_PLANE_KERNELS: LazyLock<Vec<KernelRow<AxisPlane>>> = LazyLock::new(rows_of);

impl KernelTable for AxisPlane {
    fn kernels() -> &'static [KernelRow<Self>] {
        &AXIS_PLANE_KERNELS
    }
}

impl KernelList for AxisPlane {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Reciprocal, f32>();
        visitor.visit::<Reciprocal, f64>();
        visitor.visit::<Division, f32>();
        visitor.visit::<Division, f64>();
        visitor.visit_algebraic();
    }
}

/// The component of a vector along the axis 0, 1 or 2.
#[inline(always)]
fn along<L: Lane>(axis: L, [x, y, z]: [L; 3]) -> L {
    let [half, more] = [0.5, 1.5].map(|bound| L::of(axis.token(), bound));
    L::select(axis.lt(half), x, L::select(axis.lt(more), y, z))
}

//! Kernels of boxes with edges along the axes, and their table.

mod padded;
mod slabs;

use super::ray_lanes::InverseRay;
use super::slabs::SlabInterval;
use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::lane::{Lane, Values};
use crate::shape::AxisBox;
use padded::Padded;
use slabs::Slabs;
use std::sync::LazyLock;

/// All kernels of axis-aligned boxes, ordered by algorithm.
pub static AXIS_BOX_KERNELS: LazyLock<Vec<KernelRow<AxisBox>>> = LazyLock::new(rows_of);

impl KernelTable for AxisBox {
    fn kernels() -> &'static [KernelRow<Self>] {
        &AXIS_BOX_KERNELS
    }
}

impl KernelList for AxisBox {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Slabs, f32>();
        visitor.visit::<Slabs, f64>();
        visitor.visit::<Padded, f32>();
        visitor.visit::<Padded, f64>();
        visitor.visit_algebraic();
    }
}

impl<L: Lane> InverseRay<L> {
    /// The part of the ray inside the box.
    #[inline(always)]
    fn inside(&self, boxes: &impl Values<L>) -> SlabInterval<L> {
        let (min, max) = (boxes.three(0), boxes.three(3));
        let mut inside = SlabInterval::whole(self.origin[0]);
        for axis in 0..3 {
            let t = |plane: L| (plane - self.origin[axis]) * self.inverse[axis];
            let slope = self.inverse[axis];
            inside.clip(axis as u8, t(min[axis]), t(max[axis]), slope);
        }
        inside
    }
}

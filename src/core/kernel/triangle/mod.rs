//! Ray–triangle kernels and their table.

mod baldwin_weber;
mod bounds;
mod dominant_axis;
mod edge_planes;
pub(crate) mod exact;
mod moller_trumbore;
mod parametric;
mod plane_projection;
mod shear;
mod watertight;

pub(crate) use shear::ShearedRay;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor, Tier};
use crate::shape::Triangle;
use baldwin_weber::BaldwinWeber;
use edge_planes::EdgePlanes;
use moller_trumbore::MollerTrumbore;
use parametric::Parametric;
use plane_projection::PlaneProjection;
use std::sync::LazyLock;
use watertight::Watertight;

/// A row of [`TRIANGLE_KERNELS`].
pub type TriangleKernel = KernelRow<Triangle>;

/// All triangle kernels, ordered by algorithm, the tiers last.
pub static TRIANGLE_KERNELS: LazyLock<Vec<TriangleKernel>> = LazyLock::new(rows_of);

impl KernelTable for Triangle {
    fn kernels() -> &'static [KernelRow<Self>] {
        &TRIANGLE_KERNELS
    }
}

impl KernelList for Triangle {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit_with_levels::<PlaneProjection, f32>();
        visitor.visit_with_levels::<PlaneProjection, f64>();
        visitor.visit_with_levels::<Parametric, f32>();
        visitor.visit_with_levels::<Parametric, f64>();
        visitor.visit_with_levels::<EdgePlanes, f32>();
        visitor.visit_with_levels::<EdgePlanes, f64>();
        visitor.visit_with_levels::<BaldwinWeber, f32>();
        visitor.visit_with_levels::<BaldwinWeber, f64>();
        visitor.visit_with_packets::<MollerTrumbore>();
        visitor.visit_with_levels::<MollerTrumbore, f64>();
        visitor.visit_with_packets::<Watertight>();
        visitor.visit_with_levels::<Watertight, f64>();
        visitor.visit_exact_triangle();
    }
}

/// The kernel with this name, or the one that serves the tier with this name.
pub fn triangle_kernel(name: &str) -> Option<&'static TriangleKernel> {
    Triangle::kernel(name)
}

/// The default kernel: that of [`Tier::DEFAULT`].
pub fn default_triangle_kernel() -> &'static TriangleKernel {
    Triangle::kernel_of(Tier::DEFAULT)
}

/// The kernel whose decisions match exact arithmetic.
pub fn exact_triangle_kernel() -> &'static TriangleKernel {
    Triangle::kernel_of(Tier::Exact)
}

//! Sizes of measurements.

use super::shape_speed::ShapeSpeedSizes;
use hitscope_core::kernel::TriangleKernel;

/// Sizes of the measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Rays per case of single triangles.
    pub triangle_rays: u64,
    /// Rays per closed mesh for each kernel that promises to be watertight.
    pub watertight_rays: u64,
    /// Rays per closed mesh for each other kernel.
    pub leaking_rays: u64,
    /// Rays per case of the order of hits.
    pub order_rays: u64,
    /// Hits per case of boxes.
    pub box_hits: u64,
    /// Rays per spawning case for each tier's kernel; a tenth for other kernels.
    pub spawn_rays: u64,
    /// Rays per case of shapes other than triangles.
    pub shape_rays: u64,
    /// Spawned rays per case and kernel of all shapes.
    pub shape_spawn_rays: u64,
    /// Primitives per shape for measuring packing and speed.
    pub packed_primitives: usize,
    /// Rays per workload; 0 skips measuring speed and packing.
    pub speed_rays: usize,
    /// Rounds per workload, of which the median counts.
    pub speed_rounds: usize,
    /// Resolution of the sphere for measuring speed: quads along an edge of the cube that it is made from.
    pub speed_cells: u32,
}

impl Sizes {
    /// Takes 30 to 60 seconds on two cores.
    pub const QUICK: Self = Self {
        triangle_rays: 4_000,
        watertight_rays: 40_000,
        leaking_rays: 10_000,
        order_rays: 2_000,
        box_hits: 4_000,
        spawn_rays: 20_000,
        shape_rays: 1_000,
        shape_spawn_rays: 500,
        packed_primitives: 2_000,
        speed_rays: 100_000,
        speed_rounds: 3,
        speed_cells: 83,
    };

    /// 10⁷ rays for single triangles, 10⁸ rays from inside closed meshes per watertight kernel, 10⁶ rays per
    /// spawning case.
    pub const FULL: Self = Self {
        triangle_rays: 100_000,
        watertight_rays: 4_200_000,
        leaking_rays: 400_000,
        order_rays: 100_000,
        box_hits: 200_000,
        spawn_rays: 1_000_000,
        shape_rays: 20_000,
        shape_spawn_rays: 20_000,
        packed_primitives: 20_000,
        speed_rays: 500_000,
        speed_rounds: 5,
        speed_cells: 300,
    };

    /// Rays per workload for measuring the speed of each shape: fewer, as there are many kernels.
    pub(super) fn shape_speed_rays(&self) -> usize {
        self.speed_rays / 50
    }

    pub(super) fn shape_speed(&self) -> ShapeSpeedSizes {
        ShapeSpeedSizes {
            primitives: self.packed_primitives,
            rays: self.shape_speed_rays(),
            rounds: self.speed_rounds,
        }
    }

    pub(super) fn mesh_rays(&self, kernel: &TriangleKernel) -> u64 {
        if kernel.info.promises.is_watertight {
            self.watertight_rays
        } else {
            self.leaking_rays
        }
    }

    /// Kernels without a tier are traced with fewer rays.
    pub(super) fn leaving_rays(&self, kernel: &TriangleKernel) -> u64 {
        match kernel.info.tier {
            Some(_) => self.spawn_rays,
            None => self.spawn_rays / 10,
        }
    }
}

//! What is measured: all kernels, and the programs of the lecture as printed.

use super::lecture;
use glam::Vec3;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::{Hit, Ray};

/// A ray–triangle test to measure.
#[derive(Clone, Copy)]
pub enum Contestant {
    /// A kernel of the table.
    Kernel(&'static TriangleKernel),
    /// A program of the lecture, including its mistakes.
    AsPrinted(&'static lecture::AsPrinted),
}

impl Contestant {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kernel(kernel) => kernel.info.name,
            Self::AsPrinted(program) => program.name,
        }
    }

    /// Tests a ray and a triangle. A program of the lecture may return numbers that aren't finite.
    pub fn intersect(self, ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
        match self {
            Self::Kernel(kernel) => kernel.intersect(ray, corners),
            Self::AsPrinted(program) => (program.intersect)(ray, corners),
        }
    }
}

/// All contestants, kernels first.
pub fn contestants() -> Vec<Contestant> {
    let kernels = TRIANGLE_KERNELS.iter().map(Contestant::Kernel);
    let programs = lecture::AS_PRINTED.iter().map(Contestant::AsPrinted);
    kernels.chain(programs).collect()
}

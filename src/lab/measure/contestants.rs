//! The tests that are measured: all kernels, and the lecture's programs as printed.

use super::lecture;
use glam::Vec3;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::{Hit, Ray};

/// A ray–triangle test to be measured.
#[derive(Clone, Copy)]
pub enum Contestant {
    /// A kernel of the table.
    Kernel(&'static TriangleKernel),
    /// One of the lecture's programs, including its mistakes.
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

    /// Tests a ray against a triangle. The lecture's programs may return non-finite numbers.
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

//! Who is measured: every kernel in the table, and the lecture's programs as they are printed.

use super::lecture;
use glam::Vec3;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::{Hit, Ray};

/// Something that tells where a ray meets a triangle.
#[derive(Clone, Copy)]
pub enum Contestant {
    /// A kernel that a user can choose.
    Kernel(&'static TriangleKernel),
    /// A program of the lecture, its slips included.
    AsPrinted(&'static lecture::AsPrinted),
}

impl Contestant {
    /// As tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kernel(kernel) => kernel.info.name,
            Self::AsPrinted(program) => program.name,
        }
    }

    /// Its answer. A program of the lecture may answer with numbers that aren't finite.
    pub fn intersect(self, ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
        match self {
            Self::Kernel(kernel) => kernel.intersect(ray, corners),
            Self::AsPrinted(program) => (program.intersect)(ray, corners),
        }
    }
}

/// All of them, the kernels first.
pub fn contestants() -> Vec<Contestant> {
    let kernels = TRIANGLE_KERNELS.iter().map(Contestant::Kernel);
    let programs = lecture::AS_PRINTED.iter().map(Contestant::AsPrinted);
    kernels.chain(programs).collect()
}

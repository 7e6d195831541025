//! The tests that are measured: all kernels, and the lecture's programs as printed.

use super::lecture::AsPrinted;
use super::shapes::Sampled;
use hitscope_core::kernel::KernelRow;
use hitscope_core::shape::{Shape, Triangle};
use hitscope_core::{Hit, Ray};

/// A ray–primitive test to be measured.
pub enum Contestant<S: Shape = Triangle> {
    /// A kernel of the table.
    Kernel(&'static KernelRow<S>),
    /// One of the lecture's programs, including its mistakes.
    AsPrinted(&'static AsPrinted<S>),
}

impl<S: Shape> Clone for Contestant<S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Shape> Copy for Contestant<S> {}

impl<S: Shape> Contestant<S> {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kernel(kernel) => kernel.info.name,
            Self::AsPrinted(program) => program.info.name,
        }
    }

    /// Tests a ray against a primitive. The lecture's programs may return non-finite numbers.
    pub fn intersect(self, ray: &Ray, shape: impl Into<S>) -> Option<Hit> {
        match self {
            Self::Kernel(kernel) => kernel.intersect(ray, shape),
            Self::AsPrinted(program) => (program.intersect)(ray, &shape.into()),
        }
    }
}

/// All contestants, kernels first.
pub fn contestants<S: Sampled>() -> Vec<Contestant<S>> {
    let kernels = S::kernels().iter().map(Contestant::Kernel);
    let programs = S::as_printed().iter().map(Contestant::AsPrinted);
    kernels.chain(programs).collect()
}

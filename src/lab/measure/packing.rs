//! Time and memory of packing primitives of every shape, and combined solids, for each kernel.

use super::primitives::{Counts, scenes};
use super::speed::median;
use cpu_time::ThreadTime;
use hitscope_core::group::Group;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::random::Random;
use hitscope_core::simd::SimdLevel;
use serde::Serialize;
use std::hint::black_box;

/// Time and memory of packing for one kernel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PackingCell {
    /// The shape.
    pub shape: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Number of primitives.
    pub n: usize,
    /// CPU time per primitive in nanoseconds: the median of several rounds.
    pub ns_per_primitive: f64,
    /// Size of the packed primitives in bytes, per primitive.
    pub bytes_per_primitive: f64,
    /// Size of the tree in bytes, per primitive.
    pub tree_bytes_per_primitive: f64,
}

/// Packs `n` random primitives of each shape, and fewer random solids, for each of its kernels.
///
/// # Errors
/// [`Cancelled`] if `progress` was cancelled.
pub fn measure(
    n: usize,
    rounds: usize,
    seed: u64,
    progress: &Progress,
) -> Result<Vec<PackingCell>, Cancelled> {
    let random = &mut Random::new(seed);
    let counts = Counts {
        bounded: n,
        infinite: n,
    };
    let mut cells = Vec::new();
    for scene in scenes(counts, random) {
        let group = &scene.groups()[0];
        for kernel in group.kernels() {
            progress.check()?;
            cells.push(cell(&**group, KernelChoice { info: kernel }, rounds));
        }
    }
    Ok(cells)
}

fn cell(group: &dyn Group, kernel: KernelChoice, rounds: usize) -> PackingCell {
    let level = SimdLevel::current();
    let mut bytes = 0;
    let mut round = || {
        let start = ThreadTime::now();
        let packed = black_box(group.intersector(kernel, level));
        let time = start.elapsed();
        bytes = packed.bytes();
        time.as_secs_f64() * 1e9
    };
    let times = (0..rounds.max(1)).map(|_| round()).collect();
    let n = group.count();
    let per_primitive = |x: f64| x / n.max(1) as f64;
    PackingCell {
        shape: group.shape().name,
        kernel: kernel.info.name,
        n,
        ns_per_primitive: per_primitive(median(times)),
        bytes_per_primitive: per_primitive(bytes as f64),
        tree_bytes_per_primitive: per_primitive(group.bvh().bytes() as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::group::{SOLID_INFO, all_kernels};

    #[test]
    fn every_kernel_of_every_shape_is_measured_and_solids_take_more_memory_than_spheres() {
        let cells = measure(64, 1, 1, &Progress::default()).expect("nobody cancels");
        let kernels = all_kernels().into_iter().map(|shape| shape.kernels.len());
        assert_eq!(cells.len(), kernels.sum::<usize>());
        let bytes = |shape: &str| {
            let own = cells.iter().filter(|cell| cell.shape == shape);
            own.map(|cell| cell.bytes_per_primitive)
                .fold(f64::INFINITY, f64::min)
        };
        assert!(bytes(SOLID_INFO.name) > bytes("sphere"));
        assert!(cells.iter().all(|cell| cell.bytes_per_primitive > 0.0));
    }

    #[test]
    fn a_cancelled_measurement_ends() {
        let cancelled = Progress::default();
        cancelled.cancel();
        assert_eq!(measure(1, 1, 1, &cancelled), Err(Cancelled));
    }
}

//! Speed of the kernels of every shape but the triangle: rays through the tree over random primitives.

use super::primitives::{Counts, scenes};
use super::scene::counted_primitives;
use super::speed::{Bench, Speed, default_camera};
use super::workloads::workloads;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::random::Random;
use hitscope_core::shape::{Shape as _, Triangle};
use serde::Serialize;

/// The speed of one kernel of a shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeSpeed {
    /// The shape.
    pub shape: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Its speed.
    pub speed: Speed,
}

/// Infinite primitives in a scene: each ray is tested against all of them.
const INFINITE: usize = 8;

/// Sizes of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct ShapeSpeedSizes {
    /// Primitives of a bounded shape.
    pub primitives: usize,
    /// Rays per workload.
    pub rays: usize,
    /// Rounds per workload.
    pub rounds: usize,
}

/// Measures every kernel of every shape but the triangle.
///
/// # Errors
/// [`Cancelled`] if `progress` was cancelled.
pub fn measure(
    sizes: ShapeSpeedSizes,
    seed: u64,
    progress: &Progress,
) -> Result<Vec<ShapeSpeed>, Cancelled> {
    let counts = Counts {
        bounded: sizes.primitives,
        infinite: INFINITE,
    };
    let mut all = Vec::new();
    for scene in scenes(counts, &mut Random::new(seed)) {
        let group = &scene.groups()[0];
        let shape = group.shape().name;
        if shape == Triangle::INFO.name {
            continue;
        }
        let workloads = workloads(&scene, &default_camera(&scene), sizes.rays, seed);
        let name = counted_primitives(&scene);
        let bench = Bench::new(&scene, name, &workloads, sizes.rounds);
        for info in group.kernels() {
            let kernel = KernelChoice { info };
            all.push(ShapeSpeed {
                shape,
                kernel: info.name,
                speed: bench.measure(kernel, &*scene.intersector(kernel), progress)?,
            });
        }
    }
    Ok(all)
}

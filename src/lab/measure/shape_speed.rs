//! Speed of the kernels of every shape but the triangle: rays through the tree over random primitives.
//!
//! Axis-aligned planes and boxes are also measured with the kernels of general planes and boxes, to show how much time
//! alignment saves.

use super::primitives::{Counts, of_primitives, scenes};
use super::scene::counted_primitives;
use super::speed::{Bench, Speed, default_camera};
use super::workloads::workloads;
use glam::Vec3;
use hitscope_core::Scene;
use hitscope_core::group::all_kernels;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::random::Random;
use hitscope_core::shape::{AxisBox, AxisPlane, Cuboid, Plane, Shape as _, Triangle};
use serde::Serialize;

/// The speed of one kernel of a shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeSpeed {
    /// The shape.
    pub shape: &'static str,
    /// Whether the primitives are aligned with the axes although the kernel doesn't require it.
    pub is_aligned: bool,
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
        if *scene.groups()[0].shape() == Triangle::INFO {
            continue;
        }
        let workloads = workloads(&scene, &default_camera(&scene), sizes.rays, seed);
        let name = counted_primitives(&scene);
        let bench = Bench::new(&scene, name, &workloads, sizes.rounds);
        measure_kernels(&bench, &scene, false, progress, &mut all)?;
        if let Some(general) = generalised(&scene) {
            measure_kernels(&bench, &general, true, progress, &mut all)?;
        }
    }
    Ok(all)
}

/// The number of kernels that [`measure`] measures: those of general planes and boxes twice.
pub(super) fn kernel_count() -> usize {
    let all = all_kernels();
    let others = all.iter().filter(|of| of.shape != Triangle::INFO);
    let again = all
        .iter()
        .filter(|of| [Plane::INFO, Cuboid::INFO].contains(&of.shape));
    others.chain(again).map(|of| of.kernels.len()).sum()
}

/// Measures the kernels of a scene's shape with the rays of a bench.
fn measure_kernels(
    bench: &Bench,
    scene: &Scene,
    is_aligned: bool,
    progress: &Progress,
    all: &mut Vec<ShapeSpeed>,
) -> Result<(), Cancelled> {
    let group = &scene.groups()[0];
    for info in group.kernels() {
        let kernel = KernelChoice { info };
        all.push(ShapeSpeed {
            shape: group.shape().name,
            is_aligned,
            kernel: info.name,
            speed: bench.measure(kernel, &*scene.intersector(kernel), progress)?,
        });
    }
    Ok(())
}

/// The primitives as general planes or boxes; `None` unless they are axis-aligned planes or boxes.
fn generalised(scene: &Scene) -> Option<Scene> {
    let group = &scene.groups()[0];
    let numbers = (0..group.count()).map(|index| group.numbers(index as u32));
    if *group.shape() == AxisPlane::INFO {
        let plane = |numbers: Vec<f32>| general_plane(AxisPlane::read(&&numbers[..]));
        Some(of_primitives(numbers.map(plane).collect()))
    } else if *group.shape() == AxisBox::INFO {
        let cuboid = |numbers: Vec<f32>| general_box(AxisBox::read(&&numbers[..]));
        Some(of_primitives(numbers.map(cuboid).collect()))
    } else {
        None
    }
}

fn general_plane(plane: AxisPlane) -> Plane {
    let axis = Vec3::AXES[usize::from(plane.axis).min(2)];
    Plane {
        point: plane.coordinate * axis,
        normal: if plane.is_along_axis { axis } else { -axis },
    }
}

fn general_box(aligned: AxisBox) -> Cuboid {
    let half = 0.5 * (aligned.max - aligned.min);
    Cuboid {
        centre: aligned.min + half,
        axes: [Vec3::X * half.x, Vec3::Y * half.y, Vec3::Z * half.z],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernels_are_counted_as_they_are_measured() {
        let sizes = ShapeSpeedSizes {
            primitives: 8,
            rays: 10,
            rounds: 1,
        };
        let measured = measure(sizes, 1, &Progress::default()).expect("never cancelled");
        assert!(measured.iter().any(|row| row.is_aligned));
        assert_eq!(measured.len(), kernel_count());
    }
}

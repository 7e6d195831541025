//! The user's own scene: what each kernel reaches there, and what it gets wrong.

use super::speed::{Bench, Speed};
use super::statistics::{Quantiles, bound_per_million, per_million};
use super::workloads::{Workloads, workloads};
use crate::oracle::{self, ExactHit};
use hitscope_core::kernel::{TRIANGLE_KERNELS, default_triangle_kernel};
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::ray::ulp_at;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use serde::Serialize;

/// How much of a scene is looked at.
#[derive(Clone, Copy, Debug)]
pub struct SceneSizes {
    /// Pixels whose rays are held against the oracle, and as many bounce rays as they have hits.
    pub checked: usize,
    /// Rays that are timed for each workload.
    pub timed: usize,
    /// How often.
    pub rounds: usize,
}

impl SceneSizes {
    /// For the command.
    pub const COMMAND: Self = Self {
        checked: 20_000,
        timed: 200_000,
        rounds: 5,
    };
    /// For the panel, in the background.
    pub const PANEL: Self = Self {
        checked: 4_000,
        timed: 40_000,
        rounds: 3,
    };
}

/// One kernel in one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneRow {
    /// The kernel.
    pub kernel: &'static str,
    /// Camera and bounce rays that were held against the oracle.
    pub n: u64,
    /// Of these, those that hit, exactly.
    pub hits: u64,
    /// Hits that it missed. The oracle is asked about the triangles in boxes that the ray meets: what a box
    /// lost would be missed by both, which is measured by itself.
    pub missed: u64,
    /// Hits that aren't.
    pub false_hits: u64,
    /// Hits on another triangle than the nearest, or the lowest of those as near.
    pub other_triangle: u64,
    /// All wrong decisions, a million.
    pub wrong_per_million: f64,
    /// What a zero means with a confidence of 95 %, a million.
    pub bound_per_million: f64,
    /// Errors of t on the right triangle, in ulps of f32.
    pub t_ulps: Option<Quantiles>,
    /// How fast it is here.
    pub speed: Speed,
}

/// Measures every kernel in a scene, as a camera sees it; hands each row to `each` as soon as it is there.
///
/// # Errors
/// [`Cancelled`] if `progress` was cancelled.
pub fn measure(
    scene: &Scene,
    camera: &Camera,
    sizes: SceneSizes,
    progress: &Progress,
    mut each: impl FnMut(SceneRow),
) -> Result<(), Cancelled> {
    let workloads = workloads(scene, camera, sizes.timed, 1);
    let checked = checked_rays(&workloads, sizes.checked);
    let answers = answers(scene, &checked, progress)?;
    let name = format!("{} triangles", scene.mesh().triangles.len());
    let bench = Bench::new(scene, name, &workloads, sizes.rounds);
    for kernel in TRIANGLE_KERNELS {
        progress.check()?;
        let intersector = scene.intersector(kernel);
        let speed = bench.measure(kernel, &*intersector, progress)?;
        each(row(&*intersector, &answers, speed));
    }
    Ok(())
}

/// Of the camera's and the bounce rays so many, evenly.
fn checked_rays(workloads: &Workloads, count: usize) -> Vec<Ray> {
    let evenly = |rays: &[Ray]| {
        let count = count.min(rays.len());
        let at = |k: usize| rays[k * rays.len() / count];
        (0..count).map(at).collect::<Vec<_>>()
    };
    let mut rays = evenly(&workloads[0]);
    rays.extend(evenly(&workloads[1]));
    rays
}

/// A ray and the oracle's nearest hit.
struct Answer {
    ray: Ray,
    nearest: Option<(u32, ExactHit)>,
}

fn answers(scene: &Scene, rays: &[Ray], progress: &Progress) -> Result<Vec<Answer>, Cancelled> {
    // Whatever the kernel, the candidates are all that the ray could hit.
    let intersector = scene.intersector(default_triangle_kernel());
    let mut answers = Vec::with_capacity(rays.len());
    for ray in rays {
        progress.check()?;
        let mut candidates = intersector.candidates(ray);
        candidates.sort_unstable();
        answers.push(Answer {
            ray: *ray,
            nearest: oracle::nearest(scene.mesh(), ray, &candidates),
        });
    }
    Ok(answers)
}

fn row(intersector: &dyn Intersector, answers: &[Answer], speed: Speed) -> SceneRow {
    let [mut hits, mut missed, mut false_hits, mut other_triangle] = [0; 4];
    let mut t_ulps = Vec::new();
    for Answer { ray, nearest } in answers {
        hits += u64::from(nearest.is_some());
        match (intersector.closest_hit(ray), nearest) {
            (None, None) => {}
            (None, Some(_)) => missed += 1,
            (Some(_), None) => false_hits += 1,
            (Some(hit), Some((triangle, exact))) => {
                if hit.primitive == *triangle {
                    let t = exact.t.to_f64();
                    t_ulps.push((f64::from(hit.t) - t).abs() / ulp_at(t));
                } else {
                    other_triangle += 1;
                }
            }
        }
    }
    let n = answers.len() as u64;
    SceneRow {
        kernel: intersector.kernel().name,
        n,
        hits,
        missed,
        false_hits,
        other_triangle,
        wrong_per_million: per_million(missed + false_hits + other_triangle, n),
        bound_per_million: bound_per_million(n),
        t_ulps: Quantiles::of(t_ulps),
        speed,
    }
}

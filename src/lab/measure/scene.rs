//! Speed and errors of every kernel in the user's scene.

use super::speed::{Bench, Speed};
use super::statistics::{Quantiles, bound_per_million, per_million};
use super::workloads::{Workloads, workloads};
use crate::oracle;
use hitscope_core::counts::counted_as;
use hitscope_core::group::ShapeKernels;
use hitscope_core::kernel::{
    KernelChoice, KernelInfo, Tier, default_triangle_kernel, exact_triangle_kernel,
};
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::ray::ulp_at;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use serde::Serialize;

/// Sizes of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct SceneSizes {
    /// Camera rays compared with the oracle; each hit adds a bounce ray.
    pub checked: usize,
    /// Rays per workload for measuring speed.
    pub timed: usize,
    /// Rounds per workload.
    pub rounds: usize,
}

impl SceneSizes {
    /// Sizes for the command line.
    pub const COMMAND: Self = Self {
        checked: 20_000,
        timed: 200_000,
        rounds: 5,
    };
    /// Sizes for the viewer's panel, which measures in the background.
    pub const PANEL: Self = Self {
        checked: 4_000,
        timed: 40_000,
        rounds: 3,
    };
}

/// The explanation of rows in reports of scenes with several shapes.
pub const OF_WHOLE_SCENE: &str = "Each row measures the whole scene: the other shapes use their kernels of the same tier or precision.";

/// Whether the rows are of a scene with several shapes.
pub fn has_several_shapes(rows: &[SceneRow]) -> bool {
    rows.iter().any(|row| row.shape != rows[0].shape)
}

/// The result of one kernel, for the whole scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneRow {
    /// The shape that the kernel tests.
    pub shape: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// The name of its tier, if it serves one.
    pub tier: Option<&'static str>,
    /// Its description.
    #[serde(skip)]
    pub info: &'static KernelInfo,
    /// Camera and bounce rays compared with the oracle.
    pub n: u64,
    /// Rays that hit, according to the oracle.
    pub hits: u64,
    /// Hits that the kernel missed. The oracle tests the triangles in boxes that the ray meets;
    /// [`boxes`](super::boxes) measures whether boxes lose hits.
    pub missed: u64,
    /// False hits.
    pub false_hits: u64,
    /// Hits on a primitive other than the nearest with the lowest index.
    pub other_triangle: u64,
    /// All wrong decisions per million.
    pub wrong_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if there are none.
    pub bound_per_million: f64,
    /// Errors of t on the right primitive, in f32 ulps.
    pub t_ulps: Option<Quantiles>,
    /// The kernel's speed in this scene.
    pub speed: Speed,
}

impl SceneRow {
    /// The number of wrong decisions.
    pub fn wrong_count(&self) -> u64 {
        self.missed + self.false_hits + self.other_triangle
    }
}

/// The scene's primitives, as in “12 triangles, 3 spheres”, or “an empty scene”.
pub(crate) fn counted_primitives(scene: &Scene) -> String {
    if scene.primitive_count() == 0 {
        return "an empty scene".to_owned();
    }
    let counted = scene.groups().iter().map(|group| {
        let shape = group.shape();
        counted_as(group.count(), shape.name, shape.plural)
    });
    counted.collect::<Vec<_>>().join(", ")
}

/// The kernels that [`measure`] measures: those of all shapes in the scene, shape by shape.
pub fn measured_kernels(scene: &Scene) -> Vec<(&'static str, KernelChoice)> {
    let of_shape = |shape: ShapeKernels| {
        let name = shape.shape.name;
        let kernels = shape.kernels.into_iter();
        kernels.map(move |info| (name, KernelChoice { info }))
    };
    scene.kernels().into_iter().flat_map(of_shape).collect()
}

/// Measures every kernel of the scene's shapes, seen by a camera. Passes each row to `each` as soon as it is measured.
///
/// Rays see the part that the scene's clip keeps: they are cut before they are timed, so that the figures are those of the
/// kernels alone.
///
/// Each row is of the whole scene: the other shapes are tested by their kernels of the same tier, or of the tier of the
/// same precision. So a tier has the same figures for every shape, and is measured once.
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
    let cut = |rays: Vec<Ray>| rays.iter().filter_map(|ray| scene.cut(ray)).collect();
    let workloads = workloads.map(cut);
    let scene = &scene.with_clip(None);
    let checked = checked_rays(&workloads, sizes.checked);
    let answers = answers(scene, &checked, progress)?;
    let name = counted_primitives(scene);
    let bench = Bench::new(scene, name, &workloads, sizes.rounds);
    let mut tiers: Vec<(Tier, SceneRow)> = Vec::new();
    for (shape, kernel) in measured_kernels(scene) {
        progress.check()?;
        let tier = kernel.info.tier;
        let measured = tiers.iter().find(|(measured, _)| Some(*measured) == tier);
        if let Some((_, row)) = measured {
            each(SceneRow {
                shape,
                kernel: kernel.info.name,
                info: kernel.info,
                ..row.clone()
            });
            continue;
        }
        let intersector = scene.intersector(kernel);
        let speed = bench.measure(kernel, &*intersector, progress)?;
        let row = row(shape, &*intersector, &answers, speed);
        tiers.extend(tier.map(|tier| (tier, row.clone())));
        each(row);
    }
    Ok(())
}

/// An even selection of camera and bounce rays.
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

/// A ray and its nearest hit: according to the oracle if only triangles can be hit, else to the exact kernels.
struct Answer {
    ray: Ray,
    /// The primitive, and t rounded once.
    nearest: Option<(u32, f64)>,
}

fn answers(scene: &Scene, rays: &[Ray], progress: &Progress) -> Result<Vec<Answer>, Cancelled> {
    // The candidates contain every triangle that the ray can hit, for any kernel.
    let intersector = scene.intersector(default_triangle_kernel());
    let exact = scene.intersector(exact_triangle_kernel());
    let mut answers = Vec::with_capacity(rays.len());
    for ray in rays {
        progress.check()?;
        let mut candidates = intersector.candidates(ray);
        candidates.sort_unstable();
        answers.push(Answer {
            ray: *ray,
            nearest: if candidates
                .iter()
                .all(|&primitive| scene.is_triangle(primitive))
            {
                let nearest = oracle::nearest(scene.mesh(), ray, &candidates);
                nearest.map(|(triangle, hit)| (triangle, hit.t.to_f64()))
            } else {
                exact.closest_hit(ray).and_then(|hit| {
                    let [t, ..] = scene.exact_answer(ray, hit.primitive)?;
                    Some((hit.primitive, t))
                })
            },
        });
    }
    Ok(answers)
}

fn row(
    shape: &'static str,
    intersector: &dyn Intersector,
    answers: &[Answer],
    speed: Speed,
) -> SceneRow {
    let [mut hits, mut missed, mut false_hits, mut other_triangle] = [0; 4];
    let mut t_ulps = Vec::new();
    for Answer { ray, nearest } in answers {
        hits += u64::from(nearest.is_some());
        match (intersector.closest_hit(ray), nearest) {
            (None, None) => {}
            (None, Some(_)) => missed += 1,
            (Some(_), None) => false_hits += 1,
            (Some(hit), Some((primitive, t))) => {
                if hit.primitive == *primitive {
                    t_ulps.push((f64::from(hit.t) - t).abs() / ulp_at(*t));
                } else {
                    other_triangle += 1;
                }
            }
        }
    }
    let (n, info) = (answers.len() as u64, intersector.kernel());
    SceneRow {
        shape,
        kernel: info.name,
        tier: info.tier.map(Tier::name),
        info,
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

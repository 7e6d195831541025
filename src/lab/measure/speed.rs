//! Speed of kernels: rays per second through the tree, and nanoseconds per triangle test.

use super::workloads::Workloads;
use cpu_time::ThreadTime;
use glam::{UVec2, Vec3};
use hitscope_core::camera::Turntable;
use hitscope_core::intersector::Cost;
use hitscope_core::kernel::{KernelChoice, Tier, TriangleKernel, triangle_kernel};
use hitscope_core::mesh::shapes;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::random::Random;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use serde::Serialize;
use std::hint::black_box;

/// The speed of one kernel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// The kernel.
    #[serde(skip)]
    pub kernel: &'static str,
    /// The scene.
    pub mesh: String,
    /// Millions of rays per second of CPU time, on one thread.
    pub mrays_per_s: Rates,
    /// Time per ray relative to `fast` in the same round; the mean over the workloads.
    pub time_relative_to_fast: f64,
    /// Nanoseconds per triangle test, without the tree; `None` for kernels of other shapes.
    pub ns_per_test: Option<f64>,
    /// Size of the packed primitives and the tree, in bytes per primitive.
    pub bytes_per_triangle: f64,
    /// Triangles decided in f64, per million rays; `None` for kernels that aren't adaptive.
    pub in_f64_per_million: Option<f64>,
    /// Decisions in integers, per million rays; `None` for kernels that aren't adaptive.
    pub in_integers_per_million: Option<f64>,
}

/// A rate per workload.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rates {
    /// Camera rays through the centres of pixels.
    pub primary: f64,
    /// Diffuse rays from the hits of the camera rays; 0 if there are none.
    pub bounce: f64,
    /// Rays from a sphere around the scene to random points in its bounding box.
    pub random: f64,
}

impl Rates {
    /// The mean over the workloads.
    pub fn mean(&self) -> f64 {
        (self.primary + self.bounce + self.random) / 3.0
    }
}

/// The default camera at 1280×720.
pub fn default_camera(scene: &Scene) -> Camera {
    let size = UVec2::new(1280, 720);
    Turntable::framing(scene.bounds(), size).camera(size)
}

/// Measures kernels in one scene, each in the same rounds as `fast`, so that other load on the machine
/// affects both. At most two packed meshes are in memory.
pub struct Bench<'a> {
    scene: &'a Scene,
    /// Title of the scene in the report.
    name: String,
    workloads: &'a Workloads,
    fast: Box<dyn Intersector>,
    alone: TestBench,
    rounds: usize,
}

impl<'a> Bench<'a> {
    /// Packs the scene for `fast`. Results are medians over `rounds` rounds.
    pub fn new(scene: &'a Scene, name: String, workloads: &'a Workloads, rounds: usize) -> Self {
        let fast = triangle_kernel(Tier::Fast.name()).expect("the fast tier is in the table");
        Self {
            scene,
            name,
            workloads,
            fast: scene.intersector(fast),
            alone: TestBench::new(),
            rounds,
        }
    }

    /// Measures a kernel; `intersector` is the scene packed for it.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn measure(
        &self,
        kernel: KernelChoice,
        intersector: &dyn Intersector,
        progress: &Progress,
    ) -> Result<Speed, Cancelled> {
        let mut rates = [0.0; 3];
        let mut ratios = Vec::new();
        for (rate, rays) in rates.iter_mut().zip(self.workloads) {
            // There are no bounce rays if the camera sees nothing.
            if rays.is_empty() {
                continue;
            }
            let (mut own, mut ratio) = (Vec::new(), Vec::new());
            for _ in 0..self.rounds {
                progress.check()?;
                let fast = seconds_for(&*self.fast, rays);
                progress.check()?;
                let seconds = seconds_for(intersector, rays);
                own.push(seconds);
                ratio.push(seconds / fast.max(1e-9));
            }
            *rate = rays.len() as f64 / median(own).max(1e-9) / 1e6;
            ratios.push(median(ratio));
        }
        // `fast` relative to itself is 1 by definition; two measurements would differ.
        let is_fast = kernel.info.tier == Some(Tier::Fast);
        let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
        let primitives = self.scene.primitive_count().max(1) as f64;
        let bytes = intersector.bytes() + self.scene.tree_bytes();
        let adaptive = adaptive(intersector, self.workloads);
        Ok(Speed {
            kernel: kernel.info.name,
            mesh: self.name.clone(),
            mrays_per_s: Rates {
                primary: rates[0],
                bounce: rates[1],
                random: rates[2],
            },
            time_relative_to_fast: if is_fast { 1.0 } else { mean },
            // Other shapes also have a kernel with the name `exact`.
            ns_per_test: triangle_kernel(kernel.info.name)
                .filter(|row| std::ptr::eq(row.info, kernel.info))
                .map(|kernel| self.alone.ns_per_test(kernel)),
            bytes_per_triangle: bytes as f64 / primitives,
            in_f64_per_million: adaptive.map(|[in_f64, _]| in_f64),
            in_integers_per_million: adaptive.map(|[_, in_integers]| in_integers),
        })
    }
}

/// Rays per call of an intersector: enough to make the cost of the call negligible.
pub const RAYS_AT_ONCE: usize = 64;

fn seconds_for(intersector: &dyn Intersector, rays: &[Ray]) -> f64 {
    let start = ThreadTime::now();
    let mut hits = [None; RAYS_AT_ONCE];
    for rays in rays.chunks(RAYS_AT_ONCE) {
        intersector.closest_hits(black_box(rays), &mut hits[..rays.len()]);
        black_box(&hits);
    }
    start.elapsed().as_secs_f64()
}

/// Decisions in f64 and in integers per million rays.
fn adaptive(intersector: &dyn Intersector, workloads: &Workloads) -> Option<[f64; 2]> {
    if !intersector.kernel().promises.is_exact {
        return None;
    }
    let (mut total, mut count) = (Cost::default(), 0);
    for ray in workloads.iter().flatten() {
        let (_, cost) = intersector.closest_hit_with_cost(ray);
        total.in_f64 += cost.in_f64;
        total.in_integers += cost.in_integers;
        count += 1;
    }
    let rate = |x: u32| f64::from(x) / f64::from(count.max(1)) * 1e6;
    Some([rate(total.in_f64), rate(total.in_integers)])
}

/// Data for timing tests without a tree: rays against 4096 triangles of size 0.2 in a cube of size 2. One test in
/// several hundred is a hit.
struct TestBench {
    scene: Scene,
    rays: Vec<Ray>,
}

impl TestBench {
    fn new() -> Self {
        const TRIANGLES: usize = 4096;
        const RAYS: usize = 40;
        let mut random = Random::new(1);
        let mut near = |p: Vec3| p + 0.1 * random.in_cube_f32();
        let mut places = Random::new(2);
        let triangles: Vec<[Vec3; 3]> = (0..TRIANGLES)
            .map(|_| {
                let p = places.in_cube_f32();
                [near(p), near(p), near(p)]
            })
            .collect();
        let ray = |_| Ray::new(3.0 * places.in_cube_f32(), places.in_cube_f32()).ok();
        Self {
            scene: hitscope_core::scene::scene(shapes::soup(&triangles)),
            rays: (0..RAYS).filter_map(ray).collect(),
        }
    }

    fn ns_per_test(&self, kernel: &'static TriangleKernel) -> f64 {
        let intersector = self.scene.intersector(kernel);
        let tests = self.rays.len() * self.scene.mesh().triangles().len();
        let round = || {
            let start = ThreadTime::now();
            for ray in &self.rays {
                black_box(intersector.count_hits(black_box(ray)));
            }
            start.elapsed().as_secs_f64() / tests as f64 * 1e9
        };
        median((0..5).map(|_| round()).collect())
    }
}

pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

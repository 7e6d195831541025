//! How fast is a kernel? In the real traversal, with rays as a renderer has them, and by itself.

use super::workloads::Workloads;
use cpu_time::ThreadTime;
use glam::{UVec2, Vec3};
use hitscope_core::camera::Turntable;
use hitscope_core::intersector::Cost;
use hitscope_core::kernel::{TriangleKernel, triangle_kernel};
use hitscope_core::mesh::shapes;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::random::Random;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use serde::Serialize;
use std::hint::black_box;

/// What one kernel reached.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// The kernel.
    #[serde(skip)]
    pub kernel: &'static str,
    /// What was traced.
    pub mesh: String,
    /// Millions of rays a second of one thread's CPU time.
    pub mrays_per_s: Rates,
    /// Time for a ray, the mean over the workloads of its ratio to `fast` in the same round.
    pub time_relative_to_fast: f64,
    /// Nanoseconds a triangle, the tree aside.
    pub ns_per_test: f64,
    /// Packed triangles and tree.
    pub bytes_per_triangle: f64,
    /// Triangles narrowed in f64, a million rays; `None` for kernels that don't adapt.
    pub in_f64_per_million: Option<f64>,
    /// Decisions taken in integers, likewise.
    pub in_integers_per_million: Option<f64>,
}

/// One rate a workload.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rates {
    /// Camera rays through pixels' centres.
    pub primary: f64,
    /// Diffuse rays from where those hit; 0 where none does.
    pub bounce: f64,
    /// Rays across the scene's sphere.
    pub random: f64,
}

/// The view that the viewer starts with, 1280×720.
pub fn default_camera(scene: &Scene) -> Camera {
    let size = UVec2::new(1280, 720);
    Turntable::framing(scene.bounds(), size).camera(size)
}

/// Measures kernels in one scene, each beside `fast` in the same rounds, so that what else the machine
/// does meets both alike. Two packed meshes are in memory at a time, not all of them.
pub struct Bench<'a> {
    scene: &'a Scene,
    /// What the report calls the scene.
    name: String,
    workloads: &'a Workloads,
    fast: Box<dyn Intersector>,
    alone: TestBench,
    rounds: usize,
}

impl<'a> Bench<'a> {
    /// Packs the scene for `fast`. The middle of so many rounds counts.
    pub fn new(scene: &'a Scene, name: String, workloads: &'a Workloads, rounds: usize) -> Self {
        let fast = triangle_kernel("fast").expect("the fast tier is in the table");
        Self {
            scene,
            name,
            workloads,
            fast: scene.intersector(fast),
            alone: TestBench::new(),
            rounds,
        }
    }

    /// How fast a kernel is; `intersector` is the scene packed for it.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn measure(
        &self,
        kernel: &'static TriangleKernel,
        intersector: &dyn Intersector,
        progress: &Progress,
    ) -> Result<Speed, Cancelled> {
        let mut rates = [0.0; 3];
        let mut ratios = Vec::new();
        for (rate, rays) in rates.iter_mut().zip(self.workloads) {
            // Nothing bounces where the camera sees nothing.
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
        // Beside itself it is no slower than that, whatever two measurements of it say.
        let is_fast = kernel.info.name == self.fast.kernel().name;
        let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
        let triangles = self.scene.mesh().triangles.len().max(1) as f64;
        let bytes = intersector.bytes() + self.scene.bvh().bytes();
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
            ns_per_test: self.alone.ns_per_test(kernel),
            bytes_per_triangle: bytes as f64 / triangles,
            in_f64_per_million: adaptive.map(|[in_f64, _]| in_f64),
            in_integers_per_million: adaptive.map(|[_, in_integers]| in_integers),
        })
    }
}

/// Rays that are handed to an intersector in one call: what its level costs to choose then doesn't show.
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

/// Of a million rays, decisions in f64 and in integers.
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

/// What a test alone is timed on, where no tree is asked: rays against 4096 triangles of size 0.2 in a
/// cube of size 2, of which one in some hundreds hits.
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
            scene: shapes::scene(shapes::soup(&triangles)),
            rays: (0..RAYS).filter_map(ray).collect(),
        }
    }

    fn ns_per_test(&self, kernel: &'static TriangleKernel) -> f64 {
        let intersector = self.scene.intersector(kernel);
        let tests = self.rays.len() * self.scene.mesh().triangles.len();
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

//! `hitscope bench`: measures the speed of loading a scene, building its trees and tracing rays.

mod report;

use super::args::MeshArgs;
use super::camera::CameraArgs;
use super::kernel::parse_kernel;
use super::{ClipArgs, CommandError, ThreadsArg, default_thread_count};
use crate::json;
use crate::measure::scene::counted_primitives;
use crate::measure::speed::{RAYS_AT_ONCE, median};
use crate::measure::workloads::{WORKLOADS, lamp_rays, workloads};
use crate::progress::{Meter, ProgressBar};
use clap::Args;
use cpu_time::ThreadTime;
use hitscope_core::bvh::Bvh;
use hitscope_core::kernel::{KernelChoice, KernelTable as _, Tier};
use hitscope_core::obj::Recentre;
use hitscope_core::shape::{Triangle, bounds_in};
use hitscope_core::simd::SimdLevel;
use hitscope_core::{Intersector, Ray, TriangleMesh};
use report::{BytesEach, PackedKernel, Report, Row, milliseconds};
use std::hint::black_box;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Measure the speed of loading, tree building and tracing
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Workloads:
  primary  camera rays through the centres of the pixels
  bounce   a diffuse ray from each hit of a primary ray
  random   rays from a sphere around the scene to points in its bounding box
  shadow   the bounce rays again, any hit instead of the closest
  lamp     rays from the hits of the primary rays to one distant lamp, any hit

Rates are rays per second of CPU time, averaged over the cores in use;
“wall-clock” rates use elapsed time. Each rate is the median of all rounds; a
round measures the kernels in turn.

Examples:
  hitscope bench bunny.obj
  hitscope bench bunny.obj --kernel fast --kernel exact --threads 1 --json")]
pub struct BenchArgs {
    /// OBJ file, plain or gzipped, or scene file (.xml); - for an OBJ on standard input
    pub file: PathBuf,
    /// Camera of the primary rays.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Clip.
    #[command(flatten)]
    pub clip: ClipArgs,
    /// Kernel, by tier or by a name that `hitscope lab --help` lists; repeat the option for several
    /// [default: the four tiers]
    #[arg(long = "kernel", value_name = "KERNEL", value_parser = parse_kernel)]
    pub kernels: Vec<KernelChoice>,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
    /// Rounds, 1 to 1000; rates are medians over all rounds
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rounds: u16,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Maximum number of camera rays, and of random rays.
const MOST_RAYS: usize = 1 << 20;
/// Rays that a thread takes from the queue at a time.
const RAYS_PER_PART: usize = 4096;

/// The query of a workload.
#[derive(Clone, Copy)]
enum WorkloadQuery {
    Closest,
    Coherent,
    Any,
    CoherentAny,
}

impl BenchArgs {
    /// Measures and prints.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        self.camera.check()?;
        let mut loaded = self.mesh.load(&self.file, Recentre::Auto)?;
        loaded.scene = self.clip.apply(loaded.scene)?;
        let scene = &loaded.scene;
        let camera = self.camera.camera(scene, loaded.view.as_ref())?;
        let primitives = scene.primitive_count();
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        meter.begin("Packing");
        let mut packed = Vec::new();
        let mut intersectors = Vec::new();
        for kernel in self.kernels() {
            let start = Instant::now();
            let intersector = scene.intersector(kernel);
            packed.push(PackedKernel {
                kernel: kernel.info.short_name(),
                pack_ms: milliseconds(start.elapsed()),
                bytes: BytesEach::new(scene.tree_bytes() + intersector.bytes(), primitives),
            });
            intersectors.push(intersector);
        }
        let report = Report {
            triangles: scene.mesh().triangles().len(),
            primitives,
            contents: counted_primitives(scene),
            simd: SimdLevel::current().name(),
            load_ms: milliseconds(loaded.report.duration),
            load_steps_ms: (loaded.report.steps.iter())
                .map(|(step, time)| (step.to_owned(), milliseconds(time).into()))
                .collect(),
            load_threads: rayon::current_num_threads(),
            build_ms: milliseconds(scene.build_time()),
            quick_build_ms: milliseconds(quick_build_time(scene.mesh())),
            bytes: packed[0].bytes,
            // Measured before the rays are generated: the viewer stores none.
            peak_rss_bytes: peak_rss_bytes(),
            kernels: packed,
            workloads: {
                meter.begin("Making rays");
                let workloads = workloads(scene, &camera, MOST_RAYS, 1);
                let lamp = lamp_rays(scene, &camera, &workloads[0]);
                self.rows(&intersectors, &workloads, &lamp, &meter)
            },
        };
        drop(bar);
        if self.json {
            writeln!(out, "{}", json::to_line(&report))?;
        } else {
            report.print(out)?;
        }
        Ok(())
    }

    fn kernels(&self) -> Vec<KernelChoice> {
        if !self.kernels.is_empty() {
            return self.kernels.clone();
        }
        Tier::ALL
            .map(|tier| Triangle::kernel_of(tier).into())
            .to_vec()
    }

    fn rows(
        &self,
        intersectors: &[Box<dyn Intersector>],
        workloads: &[Vec<Ray>; 3],
        lamp: &[Ray],
        meter: &Meter,
    ) -> Vec<Row> {
        let workloads = workloads.each_ref().map(Vec::as_slice);
        let [primary, bounce, _] = workloads;
        let single = WORKLOADS.into_iter().zip(workloads);
        let single = single.map(|(name, rays)| (name, WorkloadQuery::Closest, rays));
        let more = [
            ("primary", WorkloadQuery::Coherent, primary),
            ("shadow", WorkloadQuery::Any, bounce),
            ("lamp", WorkloadQuery::Any, lamp),
            ("lamp", WorkloadQuery::CoherentAny, lamp),
        ];
        let mut rows = Vec::new();
        for (name, query, rays) in single.chain(more) {
            meter.begin(format!("Tracing {name} rays"));
            let mut times = vec![Vec::new(); intersectors.len()];
            let mut hits = vec![0; intersectors.len()];
            // The first round is a warm-up.
            for round in 0..=self.rounds {
                for (k, intersector) in intersectors.iter().enumerate() {
                    let traced = trace(&**intersector, query, rays, self.threads.count());
                    hits[k] = traced.hits;
                    if round > 0 {
                        times[k].push(traced);
                    }
                }
                meter.set(f64::from(round + 1) / f64::from(self.rounds + 1));
            }
            for ((intersector, times), hits) in intersectors.iter().zip(times).zip(hits) {
                let rate = |seconds: fn(&Traced) -> f64| {
                    let seconds = median(times.iter().map(seconds).collect());
                    rays.len() as f64 / seconds.max(1e-9) / 1e6
                };
                rows.push(Row {
                    name,
                    kernel: intersector.kernel().short_name(),
                    rays_together: match query {
                        WorkloadQuery::Closest | WorkloadQuery::Any => 1,
                        _ => intersector.rays_together(),
                    },
                    threads: times[0].threads,
                    rays: rays.len(),
                    hits,
                    mrays_per_s: rate(|traced| traced.cpu_seconds),
                    mrays_per_s_wall: rate(|traced| traced.wall_seconds),
                });
            }
        }
        rows
    }
}

/// The results of one round of a workload.
#[derive(Clone, Copy)]
struct Traced {
    hits: u64,
    threads: usize,
    /// Average over the threads.
    cpu_seconds: f64,
    wall_seconds: f64,
}

fn trace(
    intersector: &dyn Intersector,
    query: WorkloadQuery,
    rays: &[Ray],
    threads: usize,
) -> Traced {
    let parts: Vec<&[Ray]> = rays.chunks(RAYS_PER_PART).collect();
    let (next, hits) = (AtomicUsize::new(0), AtomicU64::new(0));
    let cpu = Mutex::new(Duration::ZERO);
    let work = || {
        let start = ThreadTime::now();
        let mut count = 0;
        while let Some(part) = parts.get(next.fetch_add(1, Relaxed)) {
            count += part
                .chunks(RAYS_AT_ONCE)
                .map(|rays| hit_count(intersector, query, rays))
                .sum::<u64>();
        }
        hits.fetch_add(count, Relaxed);
        *cpu.lock().expect("adding doesn't panic") += start.elapsed();
    };
    let start = Instant::now();
    let threads = std::thread::scope(|scope| {
        // If the system grants fewer threads, those do all the work.
        let start = |_| std::thread::Builder::new().spawn_scoped(scope, work).ok();
        let others = (1..threads).map_while(start).count();
        work();
        1 + others
    });
    let wall_seconds = start.elapsed().as_secs_f64();
    let cpu = cpu.into_inner().expect("adding doesn't panic");
    Traced {
        hits: hits.into_inner(),
        threads,
        // At most one thread per core runs at a time.
        cpu_seconds: cpu.as_secs_f64() / threads.min(default_thread_count()) as f64,
        wall_seconds,
    }
}

fn hit_count(intersector: &dyn Intersector, query: WorkloadQuery, rays: &[Ray]) -> u64 {
    let (mut hits, mut are_hits) = ([None; RAYS_AT_ONCE], [false; RAYS_AT_ONCE]);
    let (hits, are_hits) = (&mut hits[..rays.len()], &mut are_hits[..rays.len()]);
    match query {
        WorkloadQuery::Closest => intersector.closest_hits(black_box(rays), hits),
        WorkloadQuery::Coherent => intersector.coherent_hits(black_box(rays), hits),
        WorkloadQuery::Any => intersector.any_hits(black_box(rays), are_hits),
        WorkloadQuery::CoherentAny => intersector.coherent_any_hits(black_box(rays), are_hits),
    }
    let count = hits.iter().flatten().count() + are_hits.iter().filter(|&&is_hit| is_hit).count();
    count as u64
}

fn quick_build_time(mesh: &TriangleMesh) -> Duration {
    let start = Instant::now();
    black_box(Bvh::build_quickly(mesh.triangles().len(), &bounds_in(mesh), &|| Ok(())).is_ok());
    start.elapsed()
}

/// Peak memory of the process so far.
fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

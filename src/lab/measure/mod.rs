//! Measurements of speed and accuracy: all kernels in extreme cases, compared with the oracle.
//!
//! | module | measures |
//! |---|---|
//! | [`cases`], [`triangles`] | errors of kernels for single triangles |
//! | [`meshes`] | rays that leave a closed mesh |
//! | [`order`] | wrong nearest triangles |
//! | [`boxes`] | hits lost by the tree's boxes |
//! | [`spawning`] | self-hits of spawned rays |
//! | [`shapes`] | errors of kernels and self-hits of spawned rays for single primitives of all shapes |
//! | [`packing`] | time and memory of packing primitives of all shapes and solids |
//! | [`shape_speed`] | rays per second at random primitives of each shape |
//! | [`speed`], [`workloads`] | rays per second |
//! | [`scene`] | kernels in the user's scene |
//! | [`lecture`] | the lecture's programs as printed |
//!
//! All results except speed and packing times depend only on the seed, not on the run or the machine.

pub mod boxes;
pub mod cases;
pub mod contestants;
pub mod convergence;
pub mod lecture;
pub mod meshes;
pub mod order;
pub mod packing;
mod primitives;
pub mod scene;
pub mod shape_speed;
pub mod shapes;
mod sizes;
pub mod spawning;
pub mod speed;
pub mod statistics;
pub mod triangles;
pub mod workloads;

use boxes::{BOX_CASES, BoxCell};
use contestants::{Contestant, contestants};
use hitscope_core::counts::counted;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::mesh::shapes::{Placement, sphere};
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::sampler::mix;
use hitscope_core::shape::Triangle;
use meshes::{MeshCell, mesh_cases};
use order::{ORDER_CASES, OrderCell};
use packing::PackingCell;
use rayon::prelude::*;
use shape_speed::ShapeSpeed;
use shapes::{ShapeCase, ShapeCell, ShapeSpawnCell, shape_cases, shape_spawn_cases};
pub use sizes::Sizes;
use spawning::{SpawnCell, spawn_cases};
use speed::Speed;
use std::sync::Arc;
use std::time::Duration;
use triangles::TriangleCell;

/// Results of all measurements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Single triangles.
    pub triangles: Vec<TriangleCell>,
    /// Closed meshes.
    pub meshes: Vec<MeshCell>,
    /// Order of hits.
    pub order: Vec<OrderCell>,
    /// Boxes.
    pub boxes: Vec<BoxCell>,
    /// Spawned rays.
    pub spawning: Vec<SpawnCell>,
    /// Single primitives of shapes other than triangles.
    pub shapes: Vec<ShapeCell>,
    /// Rays spawned on single primitives of all shapes.
    pub shape_spawning: Vec<ShapeSpawnCell>,
    /// Packing, one cell per kernel of every shape.
    pub packing: Vec<PackingCell>,
    /// One row per kernel of triangles.
    pub speed: Vec<Speed>,
    /// One row per kernel of every other shape.
    pub shape_speed: Vec<ShapeSpeed>,
}

/// Name and description of a case.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CaseInfo {
    /// The name, as in `--case`.
    pub name: String,
    /// The measurement to which the case belongs.
    pub section: &'static str,
    /// The title in tables.
    pub title: String,
    /// What makes the case extreme.
    pub about: String,
}

/// All cases of all measurements.
pub fn all_cases() -> Vec<CaseInfo> {
    let info = |section, name: &str, title: &str, about: &str| CaseInfo {
        name: name.to_owned(),
        section,
        title: title.to_owned(),
        about: about.to_owned(),
    };
    let triangles = cases::triangle_cases();
    let triangles = triangles
        .iter()
        .map(|c| info("triangles", &c.name, &c.title, c.about));
    let meshes = mesh_cases();
    let meshes = meshes
        .iter()
        .map(|c| info("meshes", &c.name, &c.title, c.about));
    let order = ORDER_CASES
        .iter()
        .map(|c| info("order", c.name, c.title, c.about));
    let boxes = BOX_CASES
        .iter()
        .map(|c| info("boxes", c.name, c.title, c.about));
    let spawning = spawn_cases();
    let spawning = spawning
        .iter()
        .map(|c| info("spawning", &c.name, &c.title, c.about));
    let shapes = shape_cases();
    let shapes = shapes
        .iter()
        .map(|c| info("shapes", &c.name, &c.title, c.about));
    let shape_spawning = shape_spawn_cases();
    let shape_spawning = shape_spawning
        .iter()
        .map(|c| info("shape_spawning", &c.name, &c.title, c.about));
    triangles
        .chain(meshes)
        .chain(order)
        .chain(boxes)
        .chain(spawning)
        .chain(shapes)
        .chain(shape_spawning)
        .collect()
}

/// A part of the work, with its expected time in seconds on one thread.
struct Task {
    seconds: f64,
    run: Box<dyn Fn() -> Measurements + Send + Sync>,
}

impl Task {
    /// A task of `n` items that take `seconds` each (measured 2026-11).
    fn new(
        n: u64,
        seconds_each: f64,
        run: impl Fn(u64) -> Measurements + Send + Sync + 'static,
    ) -> Self {
        Self {
            seconds: n as f64 * seconds_each,
            run: Box::new(move || run(n)),
        }
    }
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunProgress {
    /// The part of the cases that is measured, from 0 to 1.
    Accuracy(f64),
    /// All cases are measured; speed and packing, whose time isn't counted, follow.
    Speed,
}

/// Runs the cases for which `is_wanted` holds. Measures speed and packing only if the sizes have rays for speed.
///
/// # Errors
/// [`Cancelled`] if `progress` was cancelled.
pub fn run(
    sizes: Sizes,
    seed: u64,
    is_wanted: &(dyn Fn(&str) -> bool + Sync),
    progress: &Progress,
    advanced: &(dyn Fn(RunProgress) + Sync),
) -> Result<Measurements, Cancelled> {
    let tasks = tasks(sizes, seed, is_wanted);
    let total: f64 = tasks.iter().map(|task| task.seconds).sum();
    let done = std::sync::Mutex::new(0.0);
    let parts: Vec<Measurements> = tasks
        .par_iter()
        .map(|task| {
            progress.check()?;
            let part = (task.run)();
            let mut done = done.lock().expect("adding doesn't panic");
            *done += task.seconds / total;
            advanced(RunProgress::Accuracy(*done));
            Ok(part)
        })
        .collect::<Result<_, _>>()?;
    let mut all = Measurements::default();
    for part in parts {
        all.append(part);
    }
    if sizes.speed_rays > 0 {
        advanced(RunProgress::Speed);
        all.speed = speed_on_sphere(sizes, seed, progress)?;
        all.shape_speed = shape_speed::measure(sizes.shape_speed(), seed, progress)?;
        let (count, rounds) = (sizes.packed_primitives, sizes.speed_rounds);
        all.packing = packing::measure(count, rounds, seed, progress)?;
    }
    Ok(all)
}

/// Expected time of a run on `threads` threads, from times measured on one machine (2026-11).
pub fn expected(
    sizes: Sizes,
    is_wanted: &(dyn Fn(&str) -> bool + Sync),
    threads: usize,
) -> Duration {
    let tasks = tasks(sizes, 0, is_wanted);
    let parallel: f64 = tasks.iter().map(|task| task.seconds).sum();
    // Three workloads, each traced by the kernel and by `fast`.
    let traced = |rays: usize, kernels: usize| (rays * 3 * 2 * sizes.speed_rounds * kernels) as f64;
    let triangles = traced(sizes.speed_rays, TRIANGLE_KERNELS.len());
    let shapes = traced(sizes.shape_speed_rays(), shape_speed::kernel_count());
    Duration::from_secs_f64(parallel / threads as f64 + 1.0e-6 * triangles + 2.0e-6 * shapes)
}

impl Measurements {
    fn append(&mut self, other: Self) {
        self.triangles.extend(other.triangles);
        self.meshes.extend(other.meshes);
        self.order.extend(other.order);
        self.boxes.extend(other.boxes);
        self.spawning.extend(other.spawning);
        self.shapes.extend(other.shapes);
        self.shape_spawning.extend(other.shape_spawning);
    }
}

/// The seed of a case, independent of the other cases.
fn seed_of(seed: u64, name: &str) -> u64 {
    let mixed = |seed, byte: u8| mix(seed ^ u64::from(byte));
    name.bytes().fold(mix(seed), mixed)
}

/// The name of a case and its tasks.
type NamedTasks = (String, Vec<Task>);

fn tasks(sizes: Sizes, seed: u64, is_wanted: &(dyn Fn(&str) -> bool + Sync)) -> Vec<Task> {
    let seed_of = |name: &str| seed_of(seed, name);
    let triangles = cases::triangle_cases().into_iter().map(|case| {
        let (name, seed) = (case.name.clone(), seed_of(&case.name));
        let run = move |n| Measurements {
            triangles: triangles::measure(&case, &contestants::<Triangle>(), n, seed),
            ..Measurements::default()
        };
        (name, vec![Task::new(sizes.triangle_rays, 12e-6, run)])
    });
    let order = ORDER_CASES.iter().map(|case| {
        let seed = seed_of(case.name);
        let run = move |n| Measurements {
            order: case.measure(&TRIANGLE_KERNELS.iter().collect::<Vec<_>>(), n, seed),
            ..Measurements::default()
        };
        (
            case.name.to_owned(),
            vec![Task::new(sizes.order_rays, 150e-6, run)],
        )
    });
    let boxes = BOX_CASES.iter().map(|case| {
        let seed = seed_of(case.name);
        let run = move |n| Measurements {
            boxes: vec![case.measure(n, seed)],
            ..Measurements::default()
        };
        (
            case.name.to_owned(),
            vec![Task::new(sizes.box_hits, 60e-6, run)],
        )
    });
    let all = triangles
        .chain(mesh_tasks(sizes, seed))
        .chain(order)
        .chain(boxes)
        .chain(spawn_tasks(sizes, seed))
        .chain(shape_tasks(sizes, seed));
    all.filter(|(name, _)| is_wanted(name))
        .flat_map(|(_, tasks)| tasks)
        .collect()
}

/// The tasks of each mesh, one per kernel.
fn mesh_tasks(sizes: Sizes, seed: u64) -> impl Iterator<Item = NamedTasks> {
    mesh_cases().into_iter().map(move |case| {
        let (name, seed, case) = (case.name.clone(), seed_of(seed, &case.name), Arc::new(case));
        let task = |kernel: &'static TriangleKernel| {
            let case = Arc::clone(&case);
            Task::new(sizes.mesh_rays(kernel), 0.6e-6, move |n| Measurements {
                meshes: vec![case.measure(kernel, n, seed)],
                ..Measurements::default()
            })
        };
        (name, TRIANGLE_KERNELS.iter().map(task).collect())
    })
}

/// The tasks of each case of spawned rays, one per kernel.
fn spawn_tasks(sizes: Sizes, seed: u64) -> impl Iterator<Item = NamedTasks> {
    spawn_cases().into_iter().map(move |case| {
        let (name, seed, case) = (case.name.clone(), seed_of(seed, &case.name), Arc::new(case));
        let task = |kernel: &'static TriangleKernel| {
            let case = Arc::clone(&case);
            Task::new(sizes.leaving_rays(kernel), 6e-6, move |n| Measurements {
                spawning: case.measure(kernel, n, seed),
                ..Measurements::default()
            })
        };
        (name, TRIANGLE_KERNELS.iter().map(task).collect())
    })
}

/// The tasks of each case of single primitives.
fn shape_tasks(sizes: Sizes, seed: u64) -> impl Iterator<Item = NamedTasks> {
    let hits = shape_cases().into_iter().map(move |case: ShapeCase<_>| {
        let (name, seed) = (case.name.clone(), seed_of(seed, &case.name));
        let run = move |n| Measurements {
            shapes: case.measure(n, seed),
            ..Measurements::default()
        };
        (name, vec![Task::new(sizes.shape_rays, 40e-6, run)])
    });
    let spawned = shape_spawn_cases()
        .into_iter()
        .map(move |case: ShapeCase<_>| {
            let (name, seed) = (case.name.clone(), seed_of(seed, &case.name));
            let run = move |n| Measurements {
                shape_spawning: case.measure(n, seed),
                ..Measurements::default()
            };
            (name, vec![Task::new(sizes.shape_spawn_rays, 20e-6, run)])
        });
    hits.chain(spawned)
}

fn speed_on_sphere(sizes: Sizes, seed: u64, progress: &Progress) -> Result<Vec<Speed>, Cancelled> {
    let mesh = sphere(sizes.speed_cells, Placement::UNIT);
    let name = format!("sphere, {}", counted(mesh.triangles().len(), "triangle"));
    let scene = hitscope_core::scene::scene(mesh);
    let camera = speed::default_camera(&scene);
    let workloads = workloads::workloads(&scene, &camera, sizes.speed_rays, seed);
    let bench = speed::Bench::new(&scene, name, &workloads, sizes.speed_rounds);
    let kernels = TRIANGLE_KERNELS.iter();
    kernels
        .map(|kernel| bench.measure(kernel.into(), &*scene.intersector(kernel), progress))
        .collect()
}

/// The cells of one contestant.
pub fn cells_of(
    cells: &[TriangleCell],
    contestant: Contestant,
) -> impl Iterator<Item = &TriangleCell> {
    cells
        .iter()
        .filter(move |cell| cell.kernel == contestant.name())
}

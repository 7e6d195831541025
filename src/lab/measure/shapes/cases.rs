//! The cases in which kernels of all shapes are measured.

use super::cells::{ShapeCell, measure_shape};
use super::rays::{Aim, aimed};
use super::samples::Sampled;
use super::solid_cells::measure_solids;
use super::solid_spawning::measure_all;
use super::spawning::{ShapeSpawnCell, SpawnPlace, measure_spawning, spawn_places};
use super::special;
use hitscope_core::Ray;
use hitscope_core::group::SOLID_INFO;
use hitscope_core::kernel::KernelRow;
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
    Triangle,
};
use std::sync::Arc;

/// A measurement of `n` rays with a seed.
type Measure<C> = dyn Fn(u64, u64) -> Vec<C> + Send + Sync;

/// A case of one shape, whose measurement returns a cell for each of its kernels.
#[derive(Clone)]
pub struct ShapeCase<C> {
    /// The name, as in `--case`.
    pub name: String,
    /// The title in tables.
    pub title: String,
    /// What makes the case extreme.
    pub about: &'static str,
    measure: Arc<Measure<C>>,
}

impl<C> ShapeCase<C> {
    /// Measures all kernels of the shape.
    pub fn measure(&self, n: u64, seed: u64) -> Vec<C> {
        (self.measure)(n, seed)
    }
}

/// Targets and distances of rays: name, title and description of the case.
const KINDS: [(&str, &str, &str, Aim, f64); 8] = [
    (
        "around",
        "ordinary",
        "Rays at the primitive and its surroundings.",
        Aim::Around,
        3.0,
    ),
    (
        "far-1e3",
        "from 10³",
        "The same from a thousand sizes away.",
        Aim::Around,
        1e3,
    ),
    (
        "far-1e6",
        "from 10⁶",
        "The same from a million sizes away.",
        Aim::Around,
        1e6,
    ),
    (
        "silhouette",
        "silhouette",
        "Rays that pass the silhouette by 10⁻³ to 2⁻⁵² of the size, or meet the surface at such an angle.",
        Aim::Silhouette,
        3.0,
    ),
    (
        "edges",
        "at edges",
        "Rays at edges, rims, corners and apexes.",
        Aim::Edges,
        3.0,
    ),
    (
        "edges-far-1e3",
        "at edges from 10³",
        "Rays at edges, rims, corners and apexes, from a thousand sizes away.",
        Aim::Edges,
        1e3,
    ),
    (
        "axes",
        "along axes",
        "Rays parallel to an axis of the primitive or the world, or tilted by 10⁻⁸; half of them at edges.",
        Aim::Axes,
        3.0,
    ),
    (
        "inside",
        "from inside",
        "Rays that begin inside the primitive or close to it.",
        Aim::FromInside,
        0.0,
    ),
];

/// A random ray and a primitive.
pub(super) type Sample<S> = fn(&mut Random) -> (Ray, S);

/// A case of one shape alone: name, title, description, and its rays.
pub(super) type Special<S> = (&'static str, &'static str, &'static str, Sample<S>);

fn kernels<S: Sampled>() -> Vec<&'static KernelRow<S>> {
    S::kernels().iter().collect()
}

/// The beginning of the names of a shape's cases.
fn prefix(shape: &str) -> String {
    format!("shape-{shape}")
}

fn cases_of<S: Sampled>(special: &[Special<S>]) -> Vec<ShapeCase<ShapeCell>> {
    let case = |name: &str, title: &str, about, measure: Arc<Measure<ShapeCell>>| ShapeCase {
        name: name.to_owned(),
        title: format!("{}, {title}", S::INFO.name),
        about,
        measure,
    };
    let kinds = KINDS
        .iter()
        .filter(|kind| S::HAS_EDGES || kind.3 != Aim::Edges);
    let common = kinds.map(|&(name, title, about, aim, distance)| {
        let name = format!("{}-{name}", prefix(S::INFO.name));
        let measured = name.clone();
        let rays = move |random: &mut Random| aimed::<S>(random, aim, distance);
        let run = move |n, seed| measure_shape(&measured, &rays, n, seed);
        case(&name, title, about, Arc::new(run))
    });
    let special = special.iter().map(|&(name, title, about, rays)| {
        let name = format!("{}-{name}", prefix(S::INFO.name));
        let measured = name.clone();
        let run = move |n, seed| measure_shape(&measured, &rays, n, seed);
        case(&name, title, about, Arc::new(run))
    });
    common.chain(special).collect()
}

fn solid_cases() -> Vec<ShapeCase<ShapeCell>> {
    let case = |(name, title, about, aim, distance)| {
        let name = format!("{}-{name}", prefix(SOLID_INFO.name));
        let measured = name.clone();
        ShapeCase {
            name,
            title: format!("{}, {title}", SOLID_INFO.name),
            about,
            measure: Arc::new(move |n, seed| measure_solids(&measured, aim, distance, n, seed)),
        }
    };
    KINDS.into_iter().map(case).collect()
}

fn spawn_cases_of<S: Sampled>() -> Vec<ShapeCase<ShapeSpawnCell>> {
    spawn_cases(S::INFO.name, |case, place, n, seed| {
        measure_spawning(case, &kernels::<S>(), place, n, seed)
    })
}

/// The cases of a shape at every place.
fn spawn_cases(
    shape: &str,
    measure: fn(&str, SpawnPlace, u64, u64) -> Vec<ShapeSpawnCell>,
) -> Vec<ShapeCase<ShapeSpawnCell>> {
    let case = |place: SpawnPlace| {
        let SpawnPlace { size, offset } = place;
        let name = format!("{}-spawn-size-{size:e}-offset-{offset:e}", prefix(shape));
        let measured = name.clone();
        ShapeCase {
            name,
            title: format!("{shape} of size {size:e}, offset {offset:e}"),
            about: "Rays that leave a primitive of this size, at this distance from the world origin.",
            measure: Arc::new(move |n, seed| measure(&measured, place, n, seed)),
        }
    };
    spawn_places().into_iter().map(case).collect()
}

/// All cases of hits and misses. Triangles have their own.
pub fn shape_cases() -> Vec<ShapeCase<ShapeCell>> {
    [
        cases_of::<Sphere>(special::SPHERES),
        cases_of::<Plane>(&[]),
        cases_of::<Disk>(&[]),
        cases_of::<Rectangle>(&[]),
        cases_of::<AxisPlane>(&[]),
        cases_of::<Cuboid>(&[]),
        cases_of::<AxisBox>(&[]),
        cases_of::<Cylinder>(&[]),
        cases_of::<Cone>(&[]),
        cases_of::<Torus>(special::TORI),
        cases_of::<Quadric>(&[]),
        solid_cases(),
    ]
    .concat()
}

/// All cases of spawned rays.
pub fn shape_spawn_cases() -> Vec<ShapeCase<ShapeSpawnCell>> {
    [
        spawn_cases_of::<Triangle>(),
        spawn_cases_of::<Sphere>(),
        spawn_cases_of::<Plane>(),
        spawn_cases_of::<Disk>(),
        spawn_cases_of::<Rectangle>(),
        spawn_cases_of::<AxisPlane>(),
        spawn_cases_of::<Cuboid>(),
        spawn_cases_of::<AxisBox>(),
        spawn_cases_of::<Cylinder>(),
        spawn_cases_of::<Cone>(),
        spawn_cases_of::<Torus>(),
        spawn_cases_of::<Quadric>(),
        spawn_cases(SOLID_INFO.name, measure_all),
    ]
    .concat()
}

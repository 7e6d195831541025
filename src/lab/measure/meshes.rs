//! Measures whether rays leave a closed mesh: rays through the tree, aimed at shared edges and vertices.

use super::statistics::{bound_per_million, per_million};
use glam::DVec3;
use hitscope_core::kernel::TriangleKernel;
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::mesh::corridors::{Corridor, FOOTPRINTS, Footprint};
use hitscope_core::mesh::shapes::{Placement, in_torus, sphere, torus};
use hitscope_core::random::Random;
use hitscope_core::ray::ulp_at;
use hitscope_core::scene::scene;
use hitscope_core::{Intersector, Ray};
use serde::Serialize;

/// A closed mesh at some size and position, with rays from its inside.
pub struct MeshCase {
    /// The name, as in `--case`.
    pub name: String,
    /// The title in tables.
    pub title: String,
    /// What makes the case extreme.
    pub about: &'static str,
    body: Body,
}

/// The kind of mesh, and the aim of its rays.
#[derive(Clone, Copy)]
enum Body {
    /// A sphere and a torus.
    Round { place: Placement, aim: Aim },
    /// A long box, prism or corridor.
    Long {
        footprint: Footprint,
        length: f64,
        is_turned: bool,
    },
}

#[derive(Clone, Copy)]
enum Aim {
    Anywhere,
    Edges,
    Vertices,
    /// From a distance of this many sizes to a point well inside.
    From(f64),
}

/// The result of one kernel in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshCell {
    /// The case.
    pub case: String,
    /// The kernel.
    pub kernel: &'static str,
    /// Number of rays, all of which must hit.
    pub n: u64,
    /// Rays that missed.
    pub missed: u64,
    /// The same per million.
    pub missed_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if the count is zero.
    pub bound_per_million: f64,
    /// Rays whose first two crossings are within 4 ulps of each other, found among every 16th ray and scaled
    /// up: one surface hit twice, or two surfaces that close at the edge that the ray is aimed at.
    pub doubled: u64,
    /// The same per million.
    pub doubled_per_million: f64,
    /// The upper bound per million if there are none; larger, as only every 16th ray is tested.
    pub doubled_bound_per_million: f64,
    /// Triangles decided in f64, per million rays; `None` for kernels that aren't adaptive.
    pub in_f64_per_million: Option<f64>,
    /// Decisions in integers, per million rays; `None` for kernels that aren't adaptive.
    pub in_integers_per_million: Option<f64>,
}

/// All cases.
pub fn mesh_cases() -> Vec<MeshCase> {
    let offset = |x: f64| (format!("offset {x:e}"), Placement::new(1.0, x));
    // At 1e7 an ulp is 1: a body of size 1 has no interior there, one of size 16 has.
    let farthest = ("offset 1e7".to_owned(), Placement::new(16.0, 1e7 / 16.0));
    let scale = |x: f64| (format!("scale {x:e}"), Placement::new(x, 0.5));
    let places = [0.0, 1e2, 1e3, 1e4, 1e5, 1.5e5, 1e6].map(offset);
    let scales = [1e-30, 1e-18, 1e-12, 1e-6, 1e6, 1e12, 1e18, 1e30].map(scale);
    let places = places.into_iter().chain([farthest]).chain(scales);
    let aims = [
        (Aim::Edges, "edges"),
        (Aim::Vertices, "vertices"),
        (Aim::Anywhere, "anywhere"),
    ];
    places
        .flat_map(|(name, place)| {
            aims.map(|(aim, target)| MeshCase {
                name: format!("closed {name} {target}").replace(' ', "-"),
                title: format!("closed, {name}, {target}"),
                about: "A sphere and a torus, from inside: every ray must hit.",
                body: Body::Round { place, aim },
            })
        })
        .chain([1e3, 1e5, 1e6].map(|distance| MeshCase {
            name: format!("closed-far-{distance:e}"),
            title: format!("closed, from {distance:e}"),
            about: "The same from this many sizes away, at points well inside.",
            body: Body::Round {
                place: Placement::UNIT,
                aim: Aim::From(distance),
            },
        }))
        .chain(long_cases())
        .collect()
}

fn long_cases() -> impl Iterator<Item = MeshCase> {
    let sizes = [1.0, 1e2, 1e4, 1e6].into_iter();
    let poses = sizes.flat_map(|length| [(length, false), (length, true)]);
    poses.flat_map(|(length, is_turned)| {
        FOOTPRINTS.map(|footprint| {
            let turned = if is_turned { " turned" } else { "" };
            let title = format!("closed, {} {length:e}{turned}", footprint.name());
            MeshCase {
                name: title.replace(", ", "-").replace(' ', "-"),
                title,
                about: "A long closed mesh, from inside, half of the rays near or at walls and edges: every ray must hit.",
                body: Body::Long {
                    footprint,
                    length,
                    is_turned,
                },
            }
        })
    })
}

impl MeshCase {
    /// Traces `n` rays.
    pub fn measure(&self, kernel: &'static TriangleKernel, n: u64, seed: u64) -> MeshCell {
        let mut random = Random::new(seed);
        let mut count = Count::default();
        let bodies = self.bodies();
        let n = n / bodies.len() as u64 * bodies.len() as u64;
        for (mesh, next_ray) in &bodies {
            let intersector = scene(mesh.clone()).intersector(kernel);
            for k in 0..n / bodies.len() as u64 {
                let ray = next_ray(mesh, &mut random);
                count.add(&*intersector, &ray, k % EVERY == 0);
            }
        }
        let adapts = kernel.info.promises.is_exact;
        let rate = |x: u64| adapts.then(|| per_million(x, n));
        MeshCell {
            case: self.name.clone(),
            kernel: kernel.info.name,
            n,
            missed: count.missed,
            missed_per_million: per_million(count.missed, n),
            bound_per_million: bound_per_million(n),
            doubled: count.doubled * EVERY,
            doubled_per_million: per_million(count.doubled * EVERY, n),
            doubled_bound_per_million: bound_per_million(n / EVERY),
            in_f64_per_million: rate(count.in_f64 * EVERY),
            in_integers_per_million: rate(count.in_integers * EVERY),
        }
    }

    /// The meshes, and the functions that make their rays.
    fn bodies(&self) -> Vec<(TriangleMesh, RaySource)> {
        match self.body {
            Body::Round { place, aim } => {
                let inside_sphere: Inside = |random| 0.4 * random.in_cube();
                let inside_torus: Inside =
                    |random| in_torus(random.unit(), random.unit(), 0.5 * random.unit());
                let bodies = [
                    (sphere(6, place), inside_sphere),
                    (torus(24, 12, place), inside_torus),
                ];
                let with_rays = bodies.map(|(mesh, inside)| {
                    let source: RaySource =
                        Box::new(move |mesh, random| aimed_ray(mesh, place, aim, inside, random));
                    (mesh, source)
                });
                with_rays.into()
            }
            Body::Long {
                footprint,
                length,
                is_turned,
            } => {
                let corridor = Corridor::new(footprint, length, is_turned);
                let mesh = corridor.mesh.clone();
                vec![(mesh, Box::new(move |_, random| corridor.ray(random)))]
            }
        }
    }
}

/// Makes a point inside a body, before placement.
type Inside = fn(&mut Random) -> DVec3;

/// Makes a ray from inside a mesh.
type RaySource = Box<dyn Fn(&TriangleMesh, &mut Random) -> Ray>;

/// A ray from inside a round body, or from far away to its inside.
fn aimed_ray(
    mesh: &TriangleMesh,
    place: Placement,
    aim: Aim,
    inside: Inside,
    random: &mut Random,
) -> Ray {
    loop {
        let within = inside(random);
        if let Aim::From(distance) = aim {
            let origin = (distance * random.direction()).as_vec3();
            // From a million sizes away, f32's aim errs by up to a tenth: still inside.
            let dir = (within - origin.as_dvec3()).as_vec3();
            if let Ok(ray) = Ray::new(origin, dir) {
                return ray;
            }
            continue;
        }
        let origin = place.of(within);
        let corners = mesh.corners(random.index(mesh.triangles().len()) as u32);
        let start = random.index(3);
        let [a, b] = [corners[start], corners[(start + 1) % 3]].map(|p| p.as_dvec3());
        let target = match aim {
            Aim::Vertices => a,
            Aim::Edges => a.lerp(b, random.unit()),
            Aim::Anywhere | Aim::From(_) => origin.as_dvec3() + random.in_cube() * place.scale,
        };
        let dir = (target - origin.as_dvec3()).as_vec3();
        if let Ok(ray) = Ray::new(origin, dir) {
            return ray;
        }
    }
}

/// One ray in this many is tested for doubled hits: finding all hits costs more than finding the nearest.
const EVERY: u64 = 16;

#[derive(Default)]
struct Count {
    missed: u64,
    doubled: u64,
    in_f64: u64,
    in_integers: u64,
}

impl Count {
    fn add(&mut self, intersector: &dyn Intersector, ray: &Ray, is_sample: bool) {
        if !is_sample {
            self.missed += u64::from(intersector.closest_hit(ray).is_none());
            return;
        }
        let (hit, cost) = intersector.closest_hit_with_cost(ray);
        self.missed += u64::from(hit.is_none());
        self.in_f64 += u64::from(cost.in_f64);
        self.in_integers += u64::from(cost.in_integers);
        let crossings = intersector.all_hits(ray);
        if let [first, second, ..] = &crossings[..] {
            let (first, second) = (f64::from(first.hit.t), f64::from(second.hit.t));
            self.doubled += u64::from(second - first <= 4.0 * ulp_at(first));
        }
    }
}

//! Measures self-hits of spawned rays, and the height of their origins.
//!
//! A ray that leaves one of these surfaces can't hit it again: a convex body (a randomly rotated octahedron
//! with corners rounded to f32); a plane of two triangles whose corners lie in it exactly (multiples of a
//! power of two); a single triangle whose coordinates have independent magnitudes from 10⁻⁸ to 10⁸; and a
//! plane around an edge on an axis, where coordinates are 0, left at small angles.
//!
//! Source of the third: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., the tests of
//! its shapes.

use super::statistics::{Quantiles, bound_per_million, per_million};
use glam::{DVec3, Vec3};
use hitscope_core::kernel::TriangleKernel;
use hitscope_core::mesh::shapes::{Placement, soup};
use hitscope_core::mesh::{TriangleMesh, unit_normal};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::{Shape as _, Triangle};
use hitscope_core::spawn::{Departure, SPAWN_POLICIES};
use hitscope_core::{Hit, Intersector, Ray};
use serde::Serialize;

/// Size and position of a surface.
pub struct SpawnCase {
    /// The name, as in `--case`.
    pub name: String,
    /// The title in tables.
    pub title: String,
    /// What makes it extreme.
    pub about: &'static str,
    surfaces: Surfaces,
}

/// Surfaces that rays leave.
#[derive(Clone, Copy)]
enum Surfaces {
    /// Octahedra and planes of this size at this offset, in sizes, from the world origin.
    Bodies { size: f64, offset: f64 },
    /// A triangle whose coordinates have independent magnitudes.
    Triangle,
    /// Coplanar triangles around an edge on an axis.
    AroundAxis,
}

/// The result of one policy and one kernel in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpawnCell {
    /// The case.
    pub case: String,
    /// The policy.
    pub policy: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Number of rays.
    pub n: u64,
    /// Rays that hit the surface again.
    pub self_hits: u64,
    /// The same per million.
    pub self_hits_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if there are none.
    pub bound_per_million: f64,
    /// Median height of the rays' origins above the triangle, in sizes of the surface.
    pub height_p50: f64,
    /// The largest height.
    pub height_max: f64,
}

/// All cases.
pub fn spawn_cases() -> Vec<SpawnCase> {
    let sizes = [1e-3, 1.0, 1e4];
    sizes
        .into_iter()
        .flat_map(|size| {
            [0.0, 1e2, 1e4, 1e6].map(|offset| SpawnCase {
                name: format!("spawn-size-{size:e}-offset-{offset:e}"),
                title: format!("size {size:e}, offset {offset:e}"),
                about: "An octahedron and a plane of this size, at this offset (in sizes) from the world origin.",
                surfaces: Surfaces::Bodies { size, offset },
            })
        })
        .chain([SpawnCase {
            name: "spawn-exponents-8".to_owned(),
            title: "one triangle, 1e-8 to 1e8".to_owned(),
            about: "A triangle whose coordinates have independent magnitudes from 1e-8 to 1e8.",
            surfaces: Surfaces::Triangle,
        }])
        .chain([SpawnCase {
            name: "spawn-axis".to_owned(),
            title: "an edge in an axis".to_owned(),
            about: "Coplanar triangles around an edge in an axis, left from that edge, almost along the plane.",
            surfaces: Surfaces::AroundAxis,
        }])
        .collect()
}

/// Rays per surface.
const RAYS_PER_SURFACE: u64 = 64;

impl SpawnCase {
    /// Spawns `n` rays by each policy. The kernel finds the points that they leave, and whether they hit the
    /// surface again.
    pub fn measure(&self, kernel: &'static TriangleKernel, n: u64, seed: u64) -> Vec<SpawnCell> {
        let mut random = Random::new(seed);
        let mut self_hits = vec![0; SPAWN_POLICIES.len()];
        let mut heights = vec![Vec::new(); SPAWN_POLICIES.len()];
        let mut count = 0;
        while count < n {
            let (mesh, size) = self.surface(&mut random);
            if mesh.triangles().is_empty() {
                continue;
            }
            let scene = scene(mesh);
            let intersector = scene.intersector(kernel);
            for _ in 0..RAYS_PER_SURFACE.min(n - count) {
                let bounce = self.bounce(scene.mesh(), size, &*intersector, &mut random);
                let Some((arrived_by, hit, dir)) = bounce else {
                    break;
                };
                let corners = scene.mesh().corners(hit.primitive);
                let surface = Triangle(corners).surface(&arrived_by, &hit);
                let departure = Departure::of_triangle(&arrived_by, &hit, &surface, corners, dir);
                for (k, policy) in SPAWN_POLICIES.iter().enumerate() {
                    let ray = policy
                        .spawn(&departure)
                        .expect("a finite origin and direction");
                    self_hits[k] += u64::from(intersector.any_hit(&ray));
                    heights[k].push(height(&ray, corners, dir) / size);
                }
                count += 1;
            }
        }
        let cells = SPAWN_POLICIES
            .iter()
            .zip(self_hits.into_iter().zip(heights));
        cells
            .map(|(policy, (self_hits, heights))| {
                let heights = Quantiles::of(heights);
                SpawnCell {
                    case: self.name.clone(),
                    policy: policy.name,
                    kernel: kernel.info.name,
                    n,
                    self_hits,
                    self_hits_per_million: per_million(self_hits, n),
                    bound_per_million: bound_per_million(n),
                    height_p50: heights.map_or(0.0, |h| h.p50),
                    height_max: heights.map_or(0.0, |h| h.max),
                }
            })
            .collect()
    }

    /// A surface and its size.
    fn surface(&self, random: &mut Random) -> (TriangleMesh, f64) {
        match self.surfaces {
            Surfaces::Bodies { size, offset } => {
                let place = Placement::new(size, offset);
                let body = [octahedron, plane][random.index(2)];
                (body(place, random), size)
            }
            Surfaces::Triangle => {
                let mut number = || random.signed() * 2f64.powi(random.index(54) as i32 - 26);
                let corners = [(); 3].map(|()| DVec3::new(number(), number(), number()).as_vec3());
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                let size = (b - a).abs().max((c - a).abs()).max_element();
                (soup(&[corners]), size)
            }
            Surfaces::AroundAxis => around_axis(random),
        }
    }

    /// A ray that hits a triangle from outside, its hit, and the direction in which a ray leaves; `None` if
    /// the kernel keeps finding no hit.
    fn bounce(
        &self,
        mesh: &TriangleMesh,
        size: f64,
        intersector: &dyn Intersector,
        random: &mut Random,
    ) -> Option<(Ray, Hit, Vec3)> {
        for _ in 0..256 {
            let [a, b, c] = mesh
                .corners(random.index(mesh.triangles().len()) as u32)
                .map(Vec3::as_dvec3);
            let normal = unit_normal([a, b, c].map(|p| p.as_vec3()));
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let mut leaving = outwards(random.in_cube(), normal);
            if let Surfaces::AroundAxis = self.surfaces {
                // The target is on the edge from A to C; the angle to the plane is as small as 2⁻²⁴.
                u = 0.0;
                let along = leaving - leaving.dot(normal) * normal;
                leaving = along + 2f64.powi(-(random.index(25) as i32)) * normal;
            }
            let target = a + u * (b - a) + v * (c - a);
            let towards = outwards(random.in_cube(), normal);
            let origin = (target + 2.0 * size * towards).as_vec3();
            let leaving = leaving.as_vec3();
            let Ok(ray) = Ray::new(origin, (target - origin.as_dvec3()).as_vec3()) else {
                continue;
            };
            let Some(hit) = intersector.closest_hit(&ray) else {
                continue;
            };
            // The hit may be on another triangle; the ray must leave on the side where it arrived.
            let normal = unit_normal(mesh.corners(hit.primitive));
            let is_outside = normal.dot(ray.dir.as_dvec3()) < 0.0;
            if is_outside && normal.dot(leaving.as_dvec3()) > 0.0 {
                return Some((ray, hit, leaving));
            }
        }
        None
    }
}

/// Four coplanar triangles around an edge on an axis, and their size. Corners are multiples of a power of
/// two; in the plane two coordinates are equal, or one is 0.
fn around_axis(random: &mut Random) -> (TriangleMesh, f64) {
    let [x, y, z] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]][random.index(3)];
    let size = 2f64.powi(random.index(21) as i32 - 10);
    let step = size / 1024.0;
    let slope = random.index(2) as f64;
    let mut whole = |from: usize| (from + random.index(1024)) as f64 * step;
    let at = |across: f64, along: f64| {
        let mut p = DVec3::ZERO;
        (p[x], p[y], p[z]) = (across, slope * across, along);
        p.as_vec3()
    };
    let (start, end) = (at(0.0, -whole(1)), at(0.0, whole(1)));
    let (right, left) = (at(whole(1), whole(0)), at(-whole(1), -whole(0)));
    let beyond = at(2.0 * size, 0.0);
    let before = at(-2.0 * size, 0.0);
    // The edge is AC; both triangles have the same winding.
    let triangles = [
        [start, right, end],
        [end, left, start],
        [start, beyond, right],
        [end, before, left],
    ];
    (soup(&triangles), size)
}

/// An octahedron. Rounding its corners keeps it convex, as its faces meet at 109°, unless its size spans only
/// a few floats; the caller recognises that by degenerate triangles.
fn octahedron(place: Placement, random: &mut Random) -> TriangleMesh {
    let x = random.in_cube().normalize_or(DVec3::X);
    let y = x.cross(random.in_cube()).normalize_or(DVec3::Y);
    let z = x.cross(y);
    let at = |p: DVec3| place.of(0.5 * p);
    let mut triangles = Vec::new();
    for (k, x) in [x, -x].into_iter().enumerate() {
        for (l, y) in [y, -y].into_iter().enumerate() {
            for (m, z) in [z, -z].into_iter().enumerate() {
                let [a, b, c] = [at(x), at(y), at(z)];
                // An odd number of mirrored axes reverses the winding.
                triangles.push(if (k + l + m) % 2 == 0 {
                    [a, b, c]
                } else {
                    [a, c, b]
                });
            }
        }
    }
    soup(&triangles)
}

/// Two triangles of a slanted parallelogram whose corners are multiples of the ulp of the largest coordinate.
fn plane(place: Placement, random: &mut Random) -> TriangleMesh {
    let farthest = place.offset.abs().max_element() + 2.0 * place.scale;
    // The next power of two, computed from the bits because logarithms may differ between machines.
    let step = f64::from(f32::from_bits(
        (((farthest as f32).to_bits() >> 23) + 1) << 23,
    )) / f64::from(1 << 23);
    let whole = |p: DVec3| (p / step).round() * step;
    let a = whole(place.of(DVec3::ZERO).as_dvec3());
    let mut edge = || whole(place.scale * 0.5 * random.in_cube());
    let (e1, e2) = (edge(), edge());
    let [a, b, c, d] = [a, a + e1, a + e1 + e2, a + e2].map(|p| p.as_vec3());
    soup(&[[a, b, c], [a, c, d]])
}

/// A random direction on the normal's side.
fn outwards(dir: DVec3, normal: DVec3) -> DVec3 {
    let dir = dir.normalize_or(normal);
    if dir.dot(normal) < 0.0 { -dir } else { dir }
}

/// Height of a ray's origin above the triangle's plane, on the side on which the ray leaves.
fn height(ray: &Ray, corners: [Vec3; 3], dir: Vec3) -> f64 {
    let normal = unit_normal(corners);
    let side = normal.dot(dir.as_dvec3()).signum();
    side * normal.dot(ray.origin.as_dvec3() - corners[0].as_dvec3())
}

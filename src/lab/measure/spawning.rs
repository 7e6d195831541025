//! Does a ray that leaves a surface meet it again, and how high above it does it begin?
//!
//! Two surfaces, each of which an outgoing ray can't meet again, whatever its size and place: a convex
//! body, an octahedron turned at random, its corners rounded to f32; and a plane of two triangles whose
//! corners lie in it exactly, whole multiples of a power of two.

use super::statistics::{Quantiles, bound_per_million, per_million};
use glam::{DVec3, Vec3};
use hitscope_core::kernel::TriangleKernel;
use hitscope_core::mesh::shapes::{Place, scene, soup};
use hitscope_core::mesh::{TriangleMesh, unit_normal};
use hitscope_core::random::Random;
use hitscope_core::spawn::{Departure, SPAWN_POLICIES};
use hitscope_core::{Hit, Intersector, Ray};
use serde::Serialize;

/// How large a surface is and where it lies.
pub struct SpawnCase {
    /// As `--case` takes it.
    pub name: String,
    /// For tables.
    pub title: String,
    /// What is extreme about it.
    pub about: &'static str,
    size: f64,
    /// In sizes.
    offset: f64,
}

/// One policy and one kernel in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpawnCell {
    /// The case.
    pub case: String,
    /// The policy.
    pub policy: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Rays that left.
    pub n: u64,
    /// Those that met the surface again.
    pub self_hits: u64,
    /// The same, a million.
    pub self_hits_per_million: f64,
    /// What a zero means with a confidence of 95 %, a million.
    pub bound_per_million: f64,
    /// The middle height above the triangle at which rays begin, in its sizes.
    pub height_p50: f64,
    /// The largest.
    pub height_max: f64,
}

/// Every case.
pub fn spawn_cases() -> Vec<SpawnCase> {
    let sizes = [1e-3, 1.0, 1e4];
    sizes
        .into_iter()
        .flat_map(|size| {
            [0.0, 1e2, 1e4, 1e6].map(|offset| SpawnCase {
                name: format!("spawn-size-{size:e}-offset-{offset:e}"),
                title: format!("size {size:e}, offset {offset:e}"),
                about: "An octahedron and a plane of this size, so many sizes from the world's origin.",
                size,
                offset,
            })
        })
        .collect()
}

/// Rays that one surface is good for.
const RAYS_PER_SURFACE: u64 = 64;

impl SpawnCase {
    /// Lets `n` rays leave by each policy; the kernel finds where they start, and whether they meet the
    /// surface again.
    pub fn measure(&self, kernel: &TriangleKernel, n: u64, seed: u64) -> Vec<SpawnCell> {
        let mut random = Random::new(seed);
        let mut self_hits = vec![0; SPAWN_POLICIES.len()];
        let mut heights = vec![Vec::new(); SPAWN_POLICIES.len()];
        let mut count = 0;
        while count < n {
            let mesh = if random.index(2) == 0 {
                self.octahedron(&mut random)
            } else {
                self.plane(&mut random)
            };
            if mesh.triangles.is_empty() {
                continue;
            }
            let scene = scene(mesh);
            let intersector = scene.intersector(kernel);
            for _ in 0..RAYS_PER_SURFACE.min(n - count) {
                let (arrived_by, hit, dir) = self.bounce(scene.mesh(), &*intersector, &mut random);
                let corners = scene.mesh().corners(hit.primitive);
                let departure = Departure {
                    arrived_by: &arrived_by,
                    hit: &hit,
                    corners,
                    dir,
                };
                for (k, policy) in SPAWN_POLICIES.iter().enumerate() {
                    let ray = policy
                        .spawn(&departure)
                        .expect("a finite place and direction");
                    self_hits[k] += u64::from(intersector.any_hit(&ray));
                    heights[k].push(height(&ray, corners, dir) / self.size);
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

    fn place(&self) -> Place {
        Place::new(self.size, self.offset)
    }

    /// Convex also when its corners are rounded, as its faces meet at 109°: but where there are only a
    /// few floats within its size, which the caller notices by the triangles that vanish.
    fn octahedron(&self, random: &mut Random) -> TriangleMesh {
        let x = random.in_cube().normalize_or(DVec3::X);
        let y = x.cross(random.in_cube()).normalize_or(DVec3::Y);
        let z = x.cross(y);
        let place = self.place();
        let at = |p: DVec3| place.of(0.5 * p);
        let mut triangles = Vec::new();
        for (k, x) in [x, -x].into_iter().enumerate() {
            for (l, y) in [y, -y].into_iter().enumerate() {
                for (m, z) in [z, -z].into_iter().enumerate() {
                    let [a, b, c] = [at(x), at(y), at(z)];
                    // Mirrored as often as an axis is turned round.
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

    /// Two triangles of a slanted parallelogram, its corners whole multiples of the last place of the
    /// farthest coordinate.
    fn plane(&self, random: &mut Random) -> TriangleMesh {
        let farthest = self.size * (self.offset + 2.0);
        // The power of two above it, from its bits: a logarithm may differ from machine to machine.
        let step = f64::from(f32::from_bits(
            (((farthest as f32).to_bits() >> 23) + 1) << 23,
        )) / f64::from(1 << 23);
        let whole = |p: DVec3| (p / step).round() * step;
        let a = whole(self.place().of(DVec3::ZERO).as_dvec3());
        let mut edge = || whole(self.size * 0.5 * random.in_cube());
        let (e1, e2) = (edge(), edge());
        let [a, b, c, d] = [a, a + e1, a + e1 + e2, a + e2].map(|p| p.as_vec3());
        soup(&[[a, b, c], [a, c, d]])
    }

    /// A ray that arrives at a triangle's outside, its hit, and where it goes from there.
    fn bounce(
        &self,
        mesh: &TriangleMesh,
        intersector: &dyn Intersector,
        random: &mut Random,
    ) -> (Ray, Hit, Vec3) {
        loop {
            let [a, b, c] = mesh
                .corners(random.index(mesh.triangles.len()) as u32)
                .map(Vec3::as_dvec3);
            let normal = unit_normal([a, b, c].map(|p| p.as_vec3()));
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let target = a + u * (b - a) + v * (c - a);
            let towards = outwards(random.in_cube(), normal);
            let origin = (target + 2.0 * self.size * towards).as_vec3();
            let leaving = outwards(random.in_cube(), normal).as_vec3();
            let Ok(ray) = Ray::new(origin, (target - origin.as_dvec3()).as_vec3()) else {
                continue;
            };
            let Some(hit) = intersector.closest_hit(&ray) else {
                continue;
            };
            // What it hit may be another triangle: it must leave on the side on which it arrived.
            let normal = unit_normal(mesh.corners(hit.primitive));
            let is_outside = normal.dot(ray.dir.as_dvec3()) < 0.0;
            if is_outside && normal.dot(leaving.as_dvec3()) > 0.0 {
                return (ray, hit, leaving);
            }
        }
    }
}

/// A direction on the normal's side.
fn outwards(dir: DVec3, normal: DVec3) -> DVec3 {
    let dir = dir.normalize_or(normal);
    if dir.dot(normal) < 0.0 { -dir } else { dir }
}

/// How high above the triangle's plane a ray begins, on the side to which it goes.
fn height(ray: &Ray, corners: [Vec3; 3], dir: Vec3) -> f64 {
    let normal = unit_normal(corners);
    let side = normal.dot(dir.as_dvec3()).signum();
    side * normal.dot(ray.origin.as_dvec3() - corners[0].as_dvec3())
}

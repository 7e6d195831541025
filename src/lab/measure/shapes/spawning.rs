//! Self-hits of rays that the default policy spawns on a primitive of any shape.
//!
//! A ray that leaves a surface on one side and meets it again has to meet it on that side: the products of its direction
//! with the outer normals at the start and at the hit have opposite signs. A hit at which they are equal is a self-hit.
//! A convex shape that was left outwards can't be hit at all, so there every hit counts. A ray that leaves a part of the
//! surface inwards, closer to an edge than a point is rounded, may begin beyond the part that adjoins there, and hit that
//! one from outside. Close to a cone's apex, it may begin beyond the apex. Such hits count separately. For a solid, the oracle decides whether a ray began beyond an edge.
//!
//! Source of the sizes and offsets: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, the tests of
//!   its shapes.

use super::samples::Sampled;
use crate::measure::statistics::{Quantiles, bound_per_million, per_million};
use glam::{DVec3, Vec3};
use hitscope_core::kernel::KernelRow;
use hitscope_core::random::Random;
use hitscope_core::shape::SurfacePoint;
use hitscope_core::spawn::{Departure, default_spawn_policy};
use hitscope_core::{Hit, Ray};
use serde::Serialize;

/// Self-hits of one kernel at one size and offset.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeSpawnCell {
    /// The case.
    pub case: String,
    /// The shape.
    pub shape: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Number of rays.
    pub n: u64,
    /// Rays that hit the surface that they left.
    pub self_hits: u64,
    /// Rays that began beyond an edge, and hit the part of the surface on its other side.
    pub edge_hits: u64,
    /// Self-hits per million rays.
    pub self_hits_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if there are none.
    pub bound_per_million: f64,
    /// Median height of the rays' origins above the surface, in sizes of the primitive.
    pub height_p50: f64,
    /// The largest height.
    pub height_max: f64,
}

/// The size of primitives, and their distance from the world's origin.
#[derive(Clone, Copy, Debug)]
pub struct SpawnPlace {
    /// The size.
    pub size: f64,
    /// The distance.
    pub offset: f64,
}

/// Sizes of 10⁻⁴, 1 and 10⁴ at offsets of 0, 10⁻⁸, 1, 10⁴ and 10⁸.
pub fn spawn_places() -> Vec<SpawnPlace> {
    let sizes = [1e-4, 1.0, 1e4].into_iter();
    let places =
        sizes.flat_map(|size| [0.0, 1e-8, 1.0, 1e4, 1e8].map(|offset| SpawnPlace { size, offset }));
    places.collect()
}

/// Hits of one kernel, and the rays that leave there.
#[derive(Default)]
struct Counts {
    n: u64,
    self_hits: u64,
    edge_hits: u64,
    heights: Vec<f64>,
}

/// A surface that rays hit and leave.
pub(super) trait SpawnSurface {
    /// The first hit.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// The surface there.
    fn point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint;

    /// The corners of a triangle.
    fn corners(&self) -> Option<[Vec3; 3]> {
        None
    }

    /// The kind of another hit of the surface by a ray that left it at a hit, on the side of the normal or not. The ray
    /// meets the surface from the wrong side, unless the surface is convex and the ray left it outwards.
    fn judge(&self, left: &Hit, is_outwards: bool, ray: &Ray, again: &Hit) -> Again;

    /// Whether a ray that leaves the surface outwards can't hit it again.
    fn is_convex(&self) -> bool;
}

/// A primitive and a kernel.
struct Primitive<'a, S: 'static> {
    kernel: &'a KernelRow<S>,
    shape: S,
}

impl<S: Sampled> SpawnSurface for Primitive<'_, S> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.kernel.intersect(ray, self.shape.clone())
    }

    fn point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.shape.surface(ray, hit)
    }

    fn corners(&self) -> Option<[Vec3; 3]> {
        self.shape.corners()
    }

    fn judge(&self, left: &Hit, is_outwards: bool, ray: &Ray, again: &Hit) -> Again {
        let is_same_part = S::part(again) == S::part(left)
            && (is_outwards || !self.shape.is_beyond_apex(ray.origin.as_dvec3()));
        if S::IS_CONVEX && is_outwards || is_same_part {
            Again::Same
        } else {
            Again::BeyondEdge
        }
    }

    fn is_convex(&self) -> bool {
        S::IS_CONVEX
    }
}

/// Spawns up to `n` rays at hits of each kernel; fewer where rays hit less than one primitive in 16.
pub fn measure_spawning<S: Sampled>(
    case: &str,
    kernels: &[&KernelRow<S>],
    place: SpawnPlace,
    n: u64,
    seed: u64,
) -> Vec<ShapeSpawnCell> {
    let cell = |&kernel: &&KernelRow<S>| {
        let sample = |random: &mut Random, near: DVec3| Primitive {
            kernel,
            shape: S::sample(random, near, place.size),
        };
        let names = [S::INFO.name, kernel.info.name];
        measure_surfaces(case, names, &sample, place, n, seed)
    };
    kernels.iter().map(cell).collect()
}

/// Spawns up to `n` rays at hits of random surfaces. `names` are those of the shape and the kernel.
pub(super) fn measure_surfaces<T: SpawnSurface>(
    case: &str,
    [shape, kernel]: [&'static str; 2],
    sample: &dyn Fn(&mut Random, DVec3) -> T,
    place: SpawnPlace,
    n: u64,
    seed: u64,
) -> ShapeSpawnCell {
    let mut random = Random::new(seed);
    let mut counts = Counts::default();
    for _ in 0..16 * n {
        if counts.n >= n {
            break;
        }
        counts.add(sample, place, &mut random);
    }
    let heights = Quantiles::of(counts.heights);
    ShapeSpawnCell {
        case: case.to_owned(),
        shape,
        kernel,
        n: counts.n,
        self_hits: counts.self_hits,
        edge_hits: counts.edge_hits,
        self_hits_per_million: per_million(counts.self_hits, counts.n),
        bound_per_million: bound_per_million(counts.n),
        height_p50: heights.map_or(0.0, |h| h.p50),
        height_max: heights.map_or(0.0, |h| h.max),
    }
}

impl Counts {
    /// Shoots a ray at a random surface. If it hits, rays leave there on both sides.
    fn add<T: SpawnSurface>(
        &mut self,
        sample: &dyn Fn(&mut Random, DVec3) -> T,
        place: SpawnPlace,
        random: &mut Random,
    ) {
        let near = place.offset * random.direction();
        let target = sample(random, near);
        let distance = [0.1, 4.0][random.index(2)];
        let origin = (near + distance * place.size * random.direction()).as_vec3();
        let aim = near + 0.7 * place.size * random.in_cube();
        let dir = (aim - origin.as_dvec3()).as_vec3();
        let Ok(arrived_by) = Ray::new(origin, dir) else {
            return;
        };
        let Some(hit) = target.intersect(&arrived_by) else {
            return;
        };
        let surface = target.point(&arrived_by, &hit);
        let outwards = leaving(random, surface.normal);
        // Where places are rounded to a tenth of the size, a ray can't start inside.
        let is_coarse = place.offset > 1e5 * place.size;
        let sides: &[f64] = if is_coarse { &[1.0] } else { &[1.0, -1.0] };
        for &side in sides {
            let dir = (side * outwards).as_vec3();
            if side * surface.normal.dot(dir.as_dvec3()) <= 0.0 {
                // Rounded to the other side.
                continue;
            }
            let departure = (&arrived_by, &hit, surface);
            let (height, again) = leave(&target, departure, dir);
            self.n += 1;
            self.self_hits += u64::from(again == Some(Again::Same));
            self.edge_hits += u64::from(again == Some(Again::BeyondEdge));
            self.heights.push(height / place.size);
        }
    }
}

/// A direction on the side of a normal; one in four is within 2⁻²⁴ to 1 of the tangent plane.
fn leaving(random: &mut Random, normal: DVec3) -> DVec3 {
    let dir = random.direction();
    let up = dir.dot(normal);
    if random.index(4) > 0 {
        return if up < 0.0 { -dir } else { dir };
    }
    let along = (dir - up * normal).normalize_or(normal.any_orthonormal_vector());
    along + 2f64.powi(-(random.index(25) as i32)) * normal
}

/// A hit of a ray on the surface that it leaves.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Again {
    /// On the part that it leaves.
    Same,
    /// On another part.
    BeyondEdge,
}

/// The height of the spawned ray's origin, and its hit of the surface that it leaves.
fn leave(
    target: &impl SpawnSurface,
    (arrived_by, hit, surface): (&Ray, &Hit, SurfacePoint),
    dir: Vec3,
) -> (f64, Option<Again>) {
    let departure = Departure {
        arrived_by,
        hit,
        surface: &surface,
        corners: target.corners(),
        dir,
        offset: Vec3::ZERO,
    };
    let ray = default_spawn_policy().spawn(&departure);
    let ray = ray.expect("a finite origin and direction");
    let up = surface.normal.dot(dir.as_dvec3());
    let rise = (ray.origin - surface.position).as_dvec3();
    let again = target.intersect(&ray).and_then(|again| {
        let normal = target.point(&ray, &again).normal;
        let is_from_wrong_side = up * normal.dot(dir.as_dvec3()) > 0.0;
        let is_wrong = is_from_wrong_side || target.is_convex() && up > 0.0;
        is_wrong.then(|| target.judge(hit, up > 0.0, &ray, &again))
    });
    (up.signum() * surface.normal.dot(rise), again)
}

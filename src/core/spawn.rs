//! Spawn policies: rules for the origin of a ray that leaves a surface, so that it neither hits that surface
//! again nor misses surfaces that touch it.
//!
//! Hit points are rounded, and about half of them lie below their triangle: a ray that starts there hits the
//! triangle again. [`SPAWN_POLICIES`] is the table of policies. `hitscope lab` measures how often each policy
//! fails, and the height at which its rays start.

use crate::mesh::unit_normal;
use crate::ray::{Hit, Ray, RayError};
use glam::Vec3;

/// A hit on a triangle, and the direction in which a new ray leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Departure<'a> {
    /// The ray that arrived.
    pub arrived_by: &'a Ray,
    /// Its hit.
    pub hit: &'a Hit,
    /// The corners of the triangle.
    pub corners: [Vec3; 3],
    /// The direction of the new ray.
    pub dir: Vec3,
}

/// A rule for the origin of a spawned ray.
pub struct SpawnPolicy {
    /// The name in the lab's tables.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// Author, title, year.
    pub source: &'static str,
    /// Strengths and weaknesses in a sentence.
    pub summary: &'static str,
    begin: fn(&Departure<'_>) -> RayStart,
}

/// The origin of a spawned ray, the start of its interval and the triangle that it excludes.
struct RayStart {
    origin: Vec3,
    t_min: f32,
    exclude: Option<u32>,
}

impl SpawnPolicy {
    /// The spawned ray.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn spawn(&self, departure: &Departure<'_>) -> Result<Ray, RayError> {
        let RayStart {
            origin,
            t_min,
            exclude,
        } = (self.begin)(departure);
        let ray = Ray::with_interval(origin, departure.dir, t_min, f32::INFINITY)?;
        Ok(Ray { exclude, ..ray })
    }
}

/// All policies; the last one is the default.
pub static SPAWN_POLICIES: &[SpawnPolicy] = &[
    SpawnPolicy {
        name: "fixed-epsilon",
        title: "Fixed ε",
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Ignores hits with t < 1e-6 at any scale; fails in most scenes.",
        begin: |departure| RayStart {
            origin: departure.point_along_ray(),
            t_min: LECTURE_EPSILON,
            exclude: None,
        },
    },
    SpawnPolicy {
        name: "scaled-epsilon",
        title: "Scaled ε",
        source: "Jakob et al., Mitsuba 3, 2022",
        summary: "Lifted by 1500 half ulps of the largest coordinate; far too high at large coordinates.",
        begin: |departure| {
            let p = departure.point_by_weights();
            let height = (1.0 + p.abs().max_element()) * MITSUBA_EPSILON;
            RayStart::at(p + height * departure.facing_normal())
        },
    },
    SpawnPolicy {
        name: "wachter-binder",
        title: "Wächter–Binder",
        source: "Wächter, Binder, A Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems 2019",
        summary: "Lifted by up to 256 ulps of each coordinate; simple, but too high at large coordinates.",
        begin: |departure| {
            RayStart::at(wachter_binder(
                departure.point_by_weights(),
                departure.facing_normal(),
            ))
        },
    },
    SpawnPolicy {
        name: "nvidia",
        title: "NVIDIA, object space",
        source: "NVIDIA, Self Intersection Avoidance, 2023",
        summary: "Lifted by a bound on the error of A + u(B − A) + v(C − A); low, but the sum is rounded once more.",
        begin: |departure| RayStart::at(nvidia(departure)),
    },
    SpawnPolicy {
        name: "error-bounded",
        title: "Error-bounded",
        source: "Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, 6.8.6",
        summary: "Lifted by a bound on the errors of the point and of the next test, then rounded away from the surface.",
        begin: |departure| RayStart::at(error_bounded(departure)),
    },
    SpawnPolicy {
        name: "exclusion",
        title: "Exclusion",
        source: "Folklore",
        summary: "Not lifted; ignores the triangle that the ray leaves, but not its neighbours.",
        begin: |departure| RayStart {
            exclude: Some(departure.hit.primitive),
            ..RayStart::at(departure.point_by_weights())
        },
    },
    SpawnPolicy {
        name: "combined",
        title: "Error-bounded and exclusion",
        source: "Pharr et al., 2023, with exclusion",
        summary: "The bound avoids hits on neighbours, the exclusion hits on the triangle itself.",
        begin: |departure| RayStart {
            exclude: Some(departure.hit.primitive),
            ..RayStart::at(error_bounded(departure))
        },
    },
];

/// The default policy.
pub fn default_spawn_policy() -> &'static SpawnPolicy {
    SPAWN_POLICIES.last().expect("the table isn't empty")
}

/// The lecture's epsilon, in units of the direction's length.
const LECTURE_EPSILON: f32 = 1e-6;
/// Mitsuba's `RayEpsilon`, 1500 half ulps of 1.
const MITSUBA_EPSILON: f32 = 1500.0 * U;
/// Half an ulp of 1.
const U: f32 = f32::EPSILON / 2.0;

impl RayStart {
    fn at(origin: Vec3) -> Self {
        Self {
            origin,
            t_min: 0.0,
            exclude: None,
        }
    }
}

impl Departure<'_> {
    /// o + t·d. Its error is a few ulps of t·d and of the point.
    fn point_along_ray(&self) -> Vec3 {
        self.arrived_by.origin + self.hit.t * self.arrived_by.dir
    }

    /// l1·A + l2·B + l3·C. Its error is a few ulps of the corners.
    fn point_by_weights(&self) -> Vec3 {
        self.weighted_corners().into_iter().sum()
    }

    fn weighted_corners(&self) -> [Vec3; 3] {
        let [a, b, c] = self.corners;
        let [l1, l2, l3] = self.hit.barycentric();
        [l1 * a, l2 * b, l3 * c]
    }

    /// The triangle's unit normal on the side of the new ray.
    fn facing_normal(&self) -> Vec3 {
        let normal = unit_normal(self.corners);
        let side = normal.dot(self.dir.as_dvec3());
        (if side < 0.0 { -normal } else { normal }).as_vec3()
    }
}

/// Moves each coordinate by up to 256 ulps, or near 0, where ulps are too small, by 1/65536 of the normal.
fn wachter_binder(p: Vec3, normal: Vec3) -> Vec3 {
    const ORIGIN: f32 = 1.0 / 32.0;
    const FLOAT_SCALE: f32 = 1.0 / 65536.0;
    const INT_SCALE: f32 = 256.0;
    let coordinate = |axis: usize| {
        let (p, n) = (p[axis], normal[axis]);
        if p.abs() < ORIGIN {
            p + FLOAT_SCALE * n
        } else {
            let ulps = (INT_SCALE * n) as i32;
            // The bit pattern grows with the magnitude, for either sign.
            let away = if p < 0.0 { -ulps } else { ulps };
            f32::from_bits(p.to_bits().wrapping_add_signed(away))
        }
    };
    Vec3::from_array(std::array::from_fn(coordinate))
}

/// The source's terms in object space: u for the corner and 3u for the edges. Its terms for the transforms
/// between object and world are omitted, as there is no transform.
fn nvidia(departure: &Departure<'_>) -> Vec3 {
    let [a, b, c] = departure.corners;
    let (e1, e2) = (b - a, c - a);
    let (u, v) = (departure.hit.u, departure.hit.v);
    let p = a + (u * e1 + v * e2);
    let extent = (e1.abs() + e2.abs() + (e1 - e2).abs()).max_element();
    let error = U * a.abs() + Vec3::splat(3.0 * U * extent);
    let normal = departure.facing_normal();
    p + normal * error.dot(normal.abs())
}

/// The point lifted along the normal n by γ(7)·Σ|nᵢ|·(sᵢ + e), where s bounds the error of the point and e
/// the error with which the next test sees the plane.
///
/// s is the sum of the magnitudes of the weighted corners. 1 − u − v is off by 1.5u, which moves the point
/// along the normal by 1.5u·|n·P|, where |n·P| is at most Σ|lᵢPᵢ|·|n|; a product and two sums add 3u. The
/// rest of 7u comes from the source, whose weights err more.
///
/// e is the largest coordinate of a corner relative to the point. A test in f32 moves the corners to the new
/// origin and shears them along the new ray, which moves each coordinate by up to 7u·e (see
/// `kernel::triangle::exact::filter`). It sees a neighbour in the same plane, as large as this triangle, that
/// much higher or lower. The source omits e, so it doesn't lift a point at all if the weighted corners'
/// coordinates are 0: on an edge that lies in an axis, or in a plane through two axes.
///
/// Neighbours that are many times as large or as narrow are avoided only by kernels that decide exactly
/// whether t is positive.
fn error_bounded(departure: &Departure<'_>) -> Vec3 {
    const GAMMA_7: f32 = 7.0 * U / (1.0 - 7.0 * U);
    let weighted = departure.weighted_corners();
    let size: Vec3 = weighted.iter().map(|p| p.abs()).sum();
    let p: Vec3 = weighted.into_iter().sum();
    // Computed from halves, as an extent may overflow f32.
    let half_distances = departure
        .corners
        .map(|corner| (0.5 * corner - 0.5 * p).abs());
    let half_extent = half_distances.map(Vec3::max_element);
    let half_extent = half_extent.into_iter().fold(0.0, f32::max);
    let error = GAMMA_7 * size + Vec3::splat(2.0 * GAMMA_7 * half_extent);
    let normal = departure.facing_normal();
    let offset = normal * error.dot(normal.abs());
    // Round the sum away from the surface.
    let coordinate = |axis: usize| {
        let (x, offset) = (p[axis] + offset[axis], offset[axis]);
        if offset > 0.0 {
            x.next_up()
        } else if offset < 0.0 {
            x.next_down()
        } else {
            x
        }
    };
    Vec3::from_array(std::array::from_fn(coordinate))
}

//! Spawn policies: rules for the origin of a ray that leaves a surface, so that it neither hits that surface
//! again nor misses surfaces that touch it.
//!
//! Hit points are rounded, and about half of them lie below their triangle: a ray that starts there hits the
//! triangle again. [`SPAWN_POLICIES`] is the table of policies. `hitscope lab` measures how often each policy
//! fails, and the height at which its rays start.

use crate::ray::{Hit, Ray, RayError};
use crate::shape::SurfacePoint;
use glam::Vec3;

/// A hit on a primitive, and the direction in which a new ray leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Departure<'a> {
    /// The ray that arrived.
    pub arrived_by: &'a Ray,
    /// Its hit.
    pub hit: &'a Hit,
    /// The surface there.
    pub surface: &'a SurfacePoint,
    /// The corners of the triangle, if it is one.
    pub corners: Option<[Vec3; 3]>,
    /// The direction of the new ray.
    pub dir: Vec3,
    /// Added to the origin of the new ray, by a repair of the shadow terminator; zero without one.
    pub offset: Vec3,
}

/// A rule for the origin of a spawned ray.
pub struct SpawnPolicy {
    /// The name, as in the lab's tables and `--spawn`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// Author, title, year.
    pub source: &'static str,
    /// Strengths and weaknesses in a sentence.
    pub summary: &'static str,
    /// Whether the rule uses the triangle's corners.
    pub uses_corners: bool,
    begin: fn(&Departure<'_>) -> RayStart,
}

/// The origin of spawned rays, the start of their interval and the triangle that they exclude. It is the same for all
/// directions on one side of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RayStart {
    origin: Vec3,
    t_min: f32,
    exclude: Option<u32>,
}

impl RayStart {
    fn at(origin: Vec3) -> Self {
        Self {
            origin,
            t_min: 0.0,
            exclude: None,
        }
    }

    /// The ray in a direction.
    ///
    /// # Errors
    /// See [`RayError`].
    #[inline(always)]
    pub fn towards(&self, dir: Vec3) -> Result<Ray, RayError> {
        let ray = Ray::with_interval(self.origin, dir, self.t_min, f32::INFINITY)?;
        Ok(Ray {
            exclude: self.exclude,
            ..ray
        })
    }

    /// The ray to a point. The last [`END_SLACK`] of the way isn't tested.
    ///
    /// # Errors
    /// See [`RayError`]; also if both ends are the same point.
    #[inline(always)]
    pub fn connect(&self, end: Vec3) -> Result<Ray, RayError> {
        let t_max = 1.0 - END_SLACK;
        let t_min = self.t_min.min(0.5 * t_max);
        let ray = Ray::with_interval(self.origin, end - self.origin, t_min, t_max)?;
        Ok(Ray {
            exclude: self.exclude,
            ..ray
        })
    }
}

impl SpawnPolicy {
    /// The spawned ray.
    ///
    /// # Errors
    /// See [`RayError`].
    #[inline]
    pub fn spawn(&self, departure: &Departure<'_>) -> Result<Ray, RayError> {
        self.start(departure).towards(departure.dir)
    }

    /// The start of the spawned ray.
    #[inline]
    pub(crate) fn start(&self, departure: &Departure<'_>) -> RayStart {
        let offset = departure.offset;
        if offset == Vec3::ZERO {
            return (self.begin)(departure);
        }
        // The ray starts on the side of the offset. From there it may point through the primitive.
        let start = (self.begin)(&Departure {
            dir: offset,
            ..*departure
        });
        let leaves = departure.surface.facing_normal(departure.dir).dot(offset) > 0.0;
        RayStart {
            origin: start.origin + offset,
            exclude: start.exclude.filter(|_| leaves),
            ..start
        }
    }

    /// The end of a ray from the point `from` to a point of a surface: where a ray back to `from` would start, so that
    /// the ray doesn't hit the surface. `corners` are those of a triangle.
    pub(crate) fn end(
        &self,
        from: Vec3,
        hit: &Hit,
        surface: &SurfacePoint,
        corners: impl FnOnce() -> Option<[Vec3; 3]>,
    ) -> Vec3 {
        let way = surface.position - from;
        // Only the policy reads it.
        let arrived_by = Ray {
            origin: from,
            dir: way,
            t_min: 0.0,
            t_max: f32::INFINITY,
            scale: 0,
            exclude: None,
        };
        let arrival = Departure {
            arrived_by: &arrived_by,
            hit: &Hit { t: 1.0, ..*hit },
            surface,
            corners: if self.uses_corners { corners() } else { None },
            dir: -way,
            offset: Vec3::ZERO,
        };
        (self.begin)(&arrival).origin
    }
}

/// All policies; the last one is the default.
pub static SPAWN_POLICIES: &[SpawnPolicy] = &[
    SpawnPolicy {
        name: "fixed-epsilon",
        title: "Fixed ε",
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Ignores hits with t < 1e-6 at any scale; fails in most scenes.",
        uses_corners: false,
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
        uses_corners: false,
        begin: |departure| {
            let p = departure.surface.position;
            let height = (1.0 + p.abs().max_element()) * MITSUBA_EPSILON;
            RayStart::at(p + height * departure.surface.facing_normal(departure.dir))
        },
    },
    SpawnPolicy {
        name: "wachter-binder",
        title: "Wächter–Binder",
        source: "Wächter, Binder, A Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems 2019",
        summary: "Lifted by up to 256 ulps of each coordinate; simple, but too high at large coordinates.",
        uses_corners: false,
        begin: |departure| {
            RayStart::at(wachter_binder(
                departure.surface.position,
                departure.surface.facing_normal(departure.dir),
            ))
        },
    },
    SpawnPolicy {
        name: "nvidia",
        title: "NVIDIA, object space",
        source: "NVIDIA, Self Intersection Avoidance, 2023",
        summary: "Lifted by a bound on the error of A + u(B − A) + v(C − A); low, but the sum is rounded once more.",
        uses_corners: true,
        begin: |departure| RayStart::at(nvidia(departure)),
    },
    SpawnPolicy {
        name: "error-bounded",
        title: "Error-bounded",
        source: "Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, 6.8.6",
        summary: "Lifted by a bound on the errors of the point and of the next test, then rounded away from the surface.",
        uses_corners: false,
        begin: |departure| RayStart::at(error_bounded(departure)),
    },
    SpawnPolicy {
        name: "exclusion",
        title: "Exclusion",
        source: "Folklore",
        summary: "Not lifted; ignores the triangle that the ray leaves, but not its neighbours.",
        uses_corners: false,
        begin: |departure| RayStart {
            exclude: departure.excluded(),
            ..RayStart::at(departure.surface.position)
        },
    },
    SpawnPolicy {
        name: "combined",
        title: "Error-bounded and exclusion",
        source: "Pharr et al., 2023, with exclusion",
        summary: "The bound avoids hits on neighbours, the exclusion hits on the triangle itself.",
        uses_corners: false,
        begin: |departure| RayStart {
            exclude: departure.excluded(),
            ..RayStart::at(error_bounded(departure))
        },
    },
];

/// The policy of this name.
pub fn spawn_policy(name: &str) -> Option<&'static SpawnPolicy> {
    SPAWN_POLICIES.iter().find(|policy| policy.name == name)
}

/// The default policy.
pub fn default_spawn_policy() -> &'static SpawnPolicy {
    SPAWN_POLICIES.last().expect("the table isn't empty")
}

/// The part of the way between two points that isn't tested, at its end: twice the largest relative error of t that the
/// f32 kernels of the tiers promise, 513·2⁻²⁴, so that the surface at the end isn't found.
pub const END_SLACK: f32 = 1.0 / 16384.0;

/// The lecture's epsilon, in units of the direction's length.
const LECTURE_EPSILON: f32 = 1e-6;
/// Mitsuba's `RayEpsilon`, 1500 half ulps of 1.
const MITSUBA_EPSILON: f32 = 1500.0 * U;
/// Half an ulp of 1.
const U: f32 = f32::EPSILON / 2.0;

impl<'a> Departure<'a> {
    /// A departure from a triangle.
    pub fn of_triangle(
        arrived_by: &'a Ray,
        hit: &'a Hit,
        surface: &'a SurfacePoint,
        corners: [Vec3; 3],
        dir: Vec3,
    ) -> Self {
        Self {
            arrived_by,
            hit,
            surface,
            corners: Some(corners),
            dir,
            offset: Vec3::ZERO,
        }
    }

    /// o + t·d. Its error is a few ulps of t·d and of the point.
    fn point_along_ray(&self) -> Vec3 {
        self.arrived_by.origin + self.hit.t * self.arrived_by.dir
    }

    /// The primitive, if the ray can't hit it again.
    fn excluded(&self) -> Option<u32> {
        self.surface.is_flat.then_some(self.hit.primitive)
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
/// between object and world are omitted, as there is no transform. Other shapes than triangles use their own bound.
fn nvidia(departure: &Departure<'_>) -> Vec3 {
    let surface = departure.surface;
    let normal = surface.facing_normal(departure.dir);
    let Some([a, b, c]) = departure.corners else {
        return surface.position + normal * surface.error.dot(normal.abs());
    };
    let (e1, e2) = (b - a, c - a);
    let (u, v) = (departure.hit.u, departure.hit.v);
    let p = a + (u * e1 + v * e2);
    let extent = (e1.abs() + e2.abs() + (e1 - e2).abs()).max_element();
    let error = U * a.abs() + Vec3::splat(3.0 * U * extent);
    p + normal * error.dot(normal.abs())
}

/// The point lifted along the normal n by Σ|nᵢ|·eᵢ, where e is the surface's error.
///
/// Neighbours that are many times as large or as narrow as a triangle are avoided only by kernels that decide exactly
/// whether t is positive.
fn error_bounded(departure: &Departure<'_>) -> Vec3 {
    let SurfacePoint {
        position, error, ..
    } = *departure.surface;
    let normal = departure.surface.facing_normal(departure.dir);
    let offset = normal * error.dot(normal.abs());
    // Round the sum away from the surface.
    Vec3::new(
        next_towards(position.x + offset.x, offset.x),
        next_towards(position.y + offset.y, offset.y),
        next_towards(position.z + offset.z, offset.z),
    )
}

/// The next number in the direction of `offset`'s sign; `x` itself if that is 0. What isn't finite may become another number
/// that isn't, or the largest finite one.
// Without branches on signs, which are as good as random.
#[inline]
fn next_towards(x: f32, offset: f32) -> f32 {
    let (bits, sign) = (x.to_bits(), offset.to_bits());
    // The bit pattern grows with the magnitude, for either sign: 1 if both signs are equal, else −1.
    let step = ((bits ^ sign) as i32 >> 31) | 1;
    let from_zero = (sign & (1 << 31)) | 1;
    let next = if x == 0.0 {
        from_zero
    } else {
        bits.wrapping_add_signed(step)
    };
    f32::from_bits(if offset == 0.0 { bits } else { next })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_number_in_a_direction_is_that_of_the_standard_library() {
        let sizes = [
            0.0,
            f32::from_bits(1),
            f32::MIN_POSITIVE,
            1.0,
            1.5,
            f32::MAX,
        ];
        for x in sizes.into_iter().flat_map(|x| [x, -x]) {
            assert_eq!(next_towards(x, 1e-9), x.next_up(), "{x}");
            assert_eq!(next_towards(x, -1e-9), x.next_down(), "{x}");
            for zero in [0.0, -0.0] {
                assert_eq!(next_towards(x, zero).to_bits(), x.to_bits());
            }
        }
    }
}

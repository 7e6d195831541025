//! Rays and hits.

use glam::{DVec3, Vec3};

/// A ray `origin + t·dir` with the open interval `t_min < t < t_max`.
///
/// `dir` needn't be unit length; `t` is in units of its length. [`Ray::new`] rejects invalid rays and
/// rescales directions of unusual length.
#[derive(Clone, Copy, Debug, PartialEq)]
// The first eight numbers are in this order because packets load four at a time.
#[repr(C)]
pub struct Ray {
    /// Start of the ray, in the mesh's coordinates (relative to
    /// [`TriangleMesh::origin`](crate::TriangleMesh)).
    pub origin: Vec3,
    /// Direction of the ray.
    pub dir: Vec3,
    /// Start of the interval: hits at or before it are not reported.
    pub t_min: f32,
    /// End of the interval: hits at or behind it are not reported.
    pub t_max: f32,
    /// `dir` is the given direction times 2 to this power.
    pub scale: i32,
    /// The triangle that the ray starts on and therefore can't hit.
    pub exclude: Option<u32>,
}

/// Reason why a ray is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RayError {
    /// The origin holds a NaN or an infinity.
    #[error("the origin isn't finite, or is too large for 32-bit numbers, which end at 3.4e38")]
    OriginNotFinite,
    /// The direction holds a NaN or an infinity.
    #[error("the direction isn't finite, or is too large for 32-bit numbers, which end at 3.4e38")]
    DirectionNotFinite,
    /// The direction is (0, 0, 0).
    #[error("the direction is zero in f32")]
    DirectionZero,
    /// `t_min` or `t_max` is NaN, or `t_min` isn't below `t_max`.
    #[error("tmin must be less than tmax, and neither may be NaN")]
    IntervalEmpty,
}

/// The range of the largest component of directions that need no rescaling: from 2⁻¹⁶ to 2¹⁶, so that the products of a
/// direction and two distances stay well inside the range of f32.
const USUAL: std::ops::Range<f32> = 1.0 / 65536.0..65536.0;

impl Ray {
    /// A ray over `0 < t < ∞`.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn new(origin: Vec3, dir: Vec3) -> Result<Self, RayError> {
        Self::with_interval(origin, dir, 0.0, f32::INFINITY)
    }

    /// A ray over `t_min < t < t_max`. `t_max` may be infinite, `t_min` negative or minus infinity. A hit is
    /// a miss if |t|, in units of the length of `dir`, is at least the largest finite f32.
    ///
    /// A direction whose longest component isn't between 2⁻¹⁶ and 2¹⁶ is scaled by a power of two to between
    /// 1 and 2, unless that would round a component. The interval is scaled with it; an end that leaves the
    /// normal f32 range may be rounded. t is then in units of the scaled direction: see
    /// [`t_as_given`](Self::t_as_given).
    ///
    /// # Errors
    /// See [`RayError`].
    #[inline(always)]
    pub fn with_interval(
        origin: Vec3,
        dir: Vec3,
        t_min: f32,
        t_max: f32,
    ) -> Result<Self, RayError> {
        let ray = Self {
            origin,
            dir,
            t_min,
            t_max,
            scale: 0,
            exclude: None,
        };
        // Comparisons with NaN are false.
        let size = dir.abs();
        let is_usual =
            size.cmplt(Vec3::splat(USUAL.end)).all() && size.max_element() >= USUAL.start;
        if is_usual && origin.is_finite() && t_min < t_max {
            return Ok(ray);
        }
        ray.checked()
    }

    /// Checks a ray, and rescales a direction of unusual length.
    #[cold]
    fn checked(self) -> Result<Self, RayError> {
        if !self.origin.is_finite() {
            return Err(RayError::OriginNotFinite);
        } else if !self.dir.is_finite() {
            return Err(RayError::DirectionNotFinite);
        } else if self.dir == Vec3::ZERO {
            return Err(RayError::DirectionZero);
        }
        let ray = if USUAL.contains(&self.dir.abs().max_element()) {
            self
        } else {
            self.rescaled()
        };
        if ray.t_min < ray.t_max {
            Ok(ray)
        } else {
            Err(RayError::IntervalEmpty)
        }
    }

    /// The ray with a direction of usual length, or unchanged if scaling would round a component.
    fn rescaled(self) -> Self {
        let exponent = exponent_of(self.dir);
        let usual = Vec3::from_array(self.dir.to_array().map(|x| scaled(x, -exponent)));
        if usual.as_dvec3() * 2f64.powi(exponent) != self.dir.as_dvec3() {
            return self;
        }
        Self {
            dir: usual,
            t_min: scaled(self.t_min.max(-f32::MAX), exponent),
            t_max: scaled(self.t_max.min(f32::MAX), exponent),
            scale: -exponent,
            ..self
        }
    }

    /// The part of the interval in which t is a finite f32: hits at or beyond the largest finite f32, ahead
    /// or behind, are misses.
    #[inline(always)]
    pub(crate) fn finite_interval(&self) -> [f32; 2] {
        [self.t_min.max(-f32::MAX), self.t_max.min(f32::MAX)]
    }

    /// The point `origin + t·dir`, in f64.
    pub fn at(&self, t: f32) -> DVec3 {
        self.origin.as_dvec3() + f64::from(t) * self.dir.as_dvec3()
    }

    /// Converts a distance to units of the length of the direction that the ray was created with.
    pub fn t_as_given(&self, t: impl Into<f64>) -> f64 {
        t.into() * 2f64.powi(self.scale)
    }
}

fn scaled(x: f32, power: i32) -> f32 {
    (f64::from(x) * 2f64.powi(power)) as f32
}

/// Exponent of the longest component.
#[inline]
fn exponent_of(dir: Vec3) -> i32 {
    // f32 subnormals are normal numbers in f64, so its exponent is that of the magnitude.
    (f64::from(dir.abs().max_element()).to_bits() >> 52) as i32 - 1023
}

/// The largest f32 that isn't above a number; NaN for NaN.
pub fn f32_below(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x {
        nearest.next_down()
    } else {
        nearest
    }
}

/// The smallest f32 that isn't below a number; NaN for NaN.
pub fn f32_above(x: f64) -> f32 {
    -f32_below(-x)
}

/// Distance from an f32 of magnitude `t` to the next larger one; the unit in which errors of t are measured.
pub fn ulp_at(t: f64) -> f64 {
    let size = (t.abs() as f32).min(f32::MAX.next_down());
    f64::from(size.next_up()) - f64::from(size)
}

/// A ray's hit of a triangle, at `P = (1 − u − v)·A + u·B + v·C`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the length of the ray's direction.
    pub t: f32,
    /// Barycentric coordinate of the triangle's second vertex.
    pub u: f32,
    /// Barycentric coordinate of the triangle's third vertex.
    pub v: f32,
    /// Index of the triangle in the mesh.
    pub primitive: u32,
}

impl Hit {
    /// The barycentric coordinates of the three vertices, in order.
    pub fn barycentric(&self) -> [f32; 3] {
        // Adding zero turns −0 into 0.
        [1.0 - self.u - self.v, self.u + 0.0, self.v + 0.0]
    }

    /// The largest barycentric error against the exact coordinates. The first coordinate is computed in f64,
    /// because the last rounding of 1 − u − v isn't the kernel's.
    pub fn weight_error(&self, exact: [f64; 3]) -> f64 {
        let (u, v) = (f64::from(self.u), f64::from(self.v));
        let errors = [1.0 - u - v, u, v].into_iter().zip(exact);
        let errors = errors.map(|(found, exact)| (found - exact).abs());
        errors.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_rays_are_rejected_with_the_reason() {
        let (o, d) = (Vec3::ZERO, Vec3::X);
        assert!(Ray::new(o, d).is_ok());
        assert_eq!(Ray::new(o, -Vec3::ZERO), Err(RayError::DirectionZero));
        assert_eq!(
            Ray::new(Vec3::new(0.0, f32::NAN, 0.0), d),
            Err(RayError::OriginNotFinite)
        );
        assert_eq!(
            Ray::new(o, Vec3::new(f32::INFINITY, 0.0, 0.0)),
            Err(RayError::DirectionNotFinite)
        );
        for (lo, hi) in [(1.0, 1.0), (2.0, 1.0), (f32::NAN, 1.0), (0.0, f32::NAN)] {
            assert_eq!(
                Ray::with_interval(o, d, lo, hi),
                Err(RayError::IntervalEmpty)
            );
        }
    }

    #[test]
    fn a_direction_of_an_unusual_length_is_rescaled_exactly() {
        for length in [
            1e-45f32,
            1e-42,
            1e-20,
            1e-10,
            1.0,
            1e5,
            1e10,
            1e20,
            f32::MAX,
        ] {
            let given = Vec3::new(0.25 * length, 0.0, -length);
            let ray = Ray::with_interval(Vec3::ZERO, given, 0.0, 2.0).expect("a ray");
            let factor = 2f64.powi(ray.scale);
            assert_eq!(ray.dir.as_dvec3(), given.as_dvec3() * factor, "{length}");
            let longest = ray.dir.abs().max_element();
            assert!(ray.scale == 0 || (1.0..2.0).contains(&longest), "{length}");
            if ray.t_max.is_finite() {
                assert_eq!(ray.t_as_given(ray.t_max), 2.0, "{length}");
            }
        }
        let scale = |dir| Ray::new(Vec3::ZERO, dir).map(|ray| ray.scale);
        assert_eq!(scale(Vec3::X * 3.0), Ok(0));
        // Scaled down, the second component would underflow to 0.
        assert_eq!(scale(Vec3::new(1e30, 1e-20, 0.0)), Ok(0));
    }

    #[test]
    fn barycentric_coordinates_are_in_the_order_of_the_vertices() {
        let hit = Hit {
            t: 1.0,
            u: 0.25,
            v: 0.5,
            primitive: 0,
        };
        assert_eq!(hit.barycentric(), [0.25, 0.25, 0.5]);
    }
}

//! What is asked, and what is answered: rays and hits.

use glam::Vec3;

/// A half-line `origin + t·dir`, asked about for `t_min < t < t_max`.
///
/// `dir` needn't be unit length; `t` counts its lengths. Make one with [`Ray::new`], which refuses
/// what has no answer, and rescales a direction of an unusual length.
#[derive(Clone, Copy, Debug, PartialEq)]
// The first eight numbers in this order: packets load four at a time.
#[repr(C)]
pub struct Ray {
    /// Where it starts, in the mesh's coordinates (about [`TriangleMesh::origin`](crate::TriangleMesh)).
    pub origin: Vec3,
    /// Where it goes.
    pub dir: Vec3,
    /// Hits at or before this are not reported.
    pub t_min: f32,
    /// Hits at or behind this are not reported.
    pub t_max: f32,
    /// `dir` is the direction that was given times 2 to this power.
    pub scale: i32,
    /// The triangle that it starts on, which it therefore can't hit.
    pub exclude: Option<u32>,
}

/// Why a ray has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RayError {
    /// The origin holds a NaN or an infinity.
    #[error("the origin isn't finite in f32")]
    OriginNotFinite,
    /// The direction holds a NaN or an infinity.
    #[error("the direction isn't finite in f32")]
    DirectionNotFinite,
    /// The direction is (0, 0, 0).
    #[error("the direction is zero in f32")]
    DirectionZero,
    /// `t_min` or `t_max` is NaN, or `t_min` isn't below `t_max`.
    #[error("the interval from tmin to tmax is empty")]
    IntervalEmpty,
}

/// Powers of two of the directions that are taken as they are: lengths of 2⁻¹⁶ to 2¹⁶ leave
/// products of a direction and two distances well inside f32's range.
const USUAL: std::ops::Range<i32> = -16..16;

impl Ray {
    /// A ray over `0 < t < ∞`.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn new(origin: Vec3, dir: Vec3) -> Result<Self, RayError> {
        Self::with_interval(origin, dir, 0.0, f32::INFINITY)
    }

    /// A ray over `t_min < t < t_max`. `t_max` may be infinite, `t_min` negative, and minus infinity. A hit is
    /// a miss if its |t|, in lengths of `dir`, is f32's largest number or more.
    ///
    /// A direction whose longest coordinate isn't between 2⁻¹⁶ and 2¹⁶ is brought to between 1 and 2 by a
    /// power of two, where that rounds no coordinate, and the interval with it, whose ends may be rounded
    /// where they leave f32's normal numbers. t then counts other lengths: see
    /// [`t_as_given`](Self::t_as_given).
    ///
    /// # Errors
    /// See [`RayError`].
    #[inline]
    pub fn with_interval(
        origin: Vec3,
        dir: Vec3,
        t_min: f32,
        t_max: f32,
    ) -> Result<Self, RayError> {
        if !origin.is_finite() {
            return Err(RayError::OriginNotFinite);
        } else if !dir.is_finite() {
            return Err(RayError::DirectionNotFinite);
        } else if dir == Vec3::ZERO {
            return Err(RayError::DirectionZero);
        }
        let ray = Self {
            origin,
            dir,
            t_min,
            t_max,
            scale: 0,
            exclude: None,
        };
        let ray = if USUAL.contains(&exponent_of(dir)) {
            ray
        } else {
            ray.rescaled()
        };
        if ray.t_min < ray.t_max {
            Ok(ray)
        } else {
            Err(RayError::IntervalEmpty)
        }
    }

    /// With a direction of a usual length; as it is where that would round one of its coordinates.
    #[cold]
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

    /// The part of the interval in which a hit's t is a finite f32: what is as far as f32's largest number,
    /// ahead or behind, is a miss.
    #[inline(always)]
    pub(crate) fn finite_interval(&self) -> [f32; 2] {
        [self.t_min.max(-f32::MAX), self.t_max.min(f32::MAX)]
    }

    /// A distance in lengths of the direction that the ray was made with.
    pub fn t_as_given(&self, t: f32) -> f64 {
        f64::from(t) * 2f64.powi(self.scale)
    }
}

fn scaled(x: f32, power: i32) -> f32 {
    (f64::from(x) * 2f64.powi(power)) as f32
}

/// That of the longest coordinate.
#[inline]
fn exponent_of(dir: Vec3) -> i32 {
    // An f64 holds f32's subnormals as normal numbers: its exponent is that of the size.
    (f64::from(dir.abs().max_element()).to_bits() >> 52) as i32 - 1023
}

/// The distance from an f32 of this size to the next larger one: what errors of t are counted in.
pub fn ulp_at(t: f64) -> f64 {
    let size = (t.abs() as f32).min(f32::MAX.next_down());
    f64::from(size.next_up()) - f64::from(size)
}

/// Where a ray meets a triangle: `P = (1 − u − v)·A + u·B + v·C`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Weight of the triangle's second vertex.
    pub u: f32,
    /// Weight of the triangle's third vertex.
    pub v: f32,
    /// Index of the triangle in the mesh.
    pub primitive: u32,
}

impl Hit {
    /// The weights of the three vertices, in their order.
    pub fn barycentric(&self) -> [f32; 3] {
        // Plus zero: no −0.
        [1.0 - self.u - self.v, self.u + 0.0, self.v + 0.0]
    }

    /// The largest error of a weight against the exact ones. The first one's is taken in f64: the last
    /// rounding of 1 − u − v isn't the kernel's.
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
    fn rays_without_an_answer_are_refused_with_the_reason() {
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
        // Scaled down, the second coordinate would vanish.
        assert_eq!(scale(Vec3::new(1e30, 1e-20, 0.0)), Ok(0));
    }

    #[test]
    fn the_weights_belong_to_the_vertices_in_order() {
        let hit = Hit {
            t: 1.0,
            u: 0.25,
            v: 0.5,
            primitive: 0,
        };
        assert_eq!(hit.barycentric(), [0.25, 0.25, 0.5]);
    }
}

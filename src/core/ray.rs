//! What is asked, and what is answered: rays and hits.

use glam::Vec3;

/// A half-line `origin + t·dir`, asked about for `t_min < t < t_max`.
///
/// `dir` needn't be unit length; `t` counts its lengths. Make one with [`Ray::new`], which refuses
/// what has no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, in the mesh's coordinates (about [`TriangleMesh::origin`](crate::TriangleMesh)).
    pub origin: Vec3,
    /// Where it goes.
    pub dir: Vec3,
    /// Hits at or before this are not reported.
    pub t_min: f32,
    /// Hits at or behind this are not reported.
    pub t_max: f32,
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
    /// The direction is so short that its inverse leaves f32's range.
    #[error("the direction is too short: its longest coordinate is below 1.2e-38")]
    DirectionTooShort,
    /// `t_min` or `t_max` is NaN, or `t_min` isn't below `t_max`.
    #[error("the interval from tmin to tmax is empty")]
    IntervalEmpty,
}

impl Ray {
    /// A ray over `0 < t < ∞`.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn new(origin: Vec3, dir: Vec3) -> Result<Self, RayError> {
        Self::with_interval(origin, dir, 0.0, f32::INFINITY)
    }

    /// A ray over `t_min < t < t_max`. `t_max` may be infinite, `t_min` negative.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn with_interval(
        origin: Vec3,
        dir: Vec3,
        t_min: f32,
        t_max: f32,
    ) -> Result<Self, RayError> {
        if !origin.is_finite() {
            Err(RayError::OriginNotFinite)
        } else if !dir.is_finite() {
            Err(RayError::DirectionNotFinite)
        } else if dir == Vec3::ZERO {
            Err(RayError::DirectionZero)
        } else if dir.abs().max_element() < f32::MIN_POSITIVE {
            Err(RayError::DirectionTooShort)
        } else if t_min < t_max {
            Ok(Self {
                origin,
                dir,
                t_min,
                t_max,
                exclude: None,
            })
        } else {
            Err(RayError::IntervalEmpty)
        }
    }
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
            Ray::new(o, Vec3::X * 1e-40),
            Err(RayError::DirectionTooShort)
        );
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

//! One side of a plane, and the part of a ray on it.

use super::{ClipError, KeptInterval};
use crate::ray::f32_below;
use glam::DVec3;

/// Twice the rounding of f32 vertices in a plane, relative to their coordinates.
const VERTEX_ERROR: f64 = 2.0 / (1 << 24) as f64;
/// Sixteen times the rounding of t to f32, relative to the length of the ray: some kernels compute in f32.
const T_ERROR: f64 = 16.0 / (1 << 24) as f64;
/// The most that the length of a ray adds to the thickness, relative to its origin's distance to the plane. It matters for
/// rays that are almost parallel to the plane, whose t has no bound.
const MOST_OF_LENGTH: f64 = 1.0 / 1024.0;

/// One side of a plane, with the plane: `normal·p ≤ offset`; see the [module](super).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    normal: DVec3,
    offset: f64,
}

impl HalfSpace {
    /// The side of a plane that its normal points away from.
    ///
    /// # Errors
    /// See [`ClipError`].
    pub fn new(normal: DVec3, offset: f64) -> Result<Self, ClipError> {
        if normal == DVec3::ZERO {
            return Err(ClipError::NormalZero);
        }
        if !normal.is_finite() {
            return Err(ClipError::NotFinite);
        }
        // A power of two, so that nothing is rounded: the largest component is then about 1, and no product overflows.
        let exponent = libm::ilogb(normal.abs().max_element());
        let scaled = |x: f64| libm::scalbn(x, -exponent);
        let (normal, offset) = (normal.map(scaled), scaled(offset));
        if !offset.is_finite() {
            return Err(ClipError::NotFinite);
        }
        Ok(Self { normal, offset })
    }

    /// The normal, which points to what is removed. Its largest component is between 1 and 2.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The offset: `normal·p` of the points of the plane.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    pub(super) fn moved(&self, by: DVec3) -> Result<Self, ClipError> {
        let offset = self.offset + self.normal.dot(by);
        let moved = Self { offset, ..*self };
        offset
            .is_finite()
            .then_some(moved)
            .ok_or(ClipError::NotFinite)
    }

    /// Whether a point is on this side. A point with a NaN isn't.
    pub fn keeps(&self, point: DVec3) -> bool {
        self.distance(point) >= 0.0
    }

    /// The offset at which points near `point` are cut: that of the plane, moved away from this side by the rounding of
    /// vertices there.
    pub fn offset_near(&self, point: DVec3) -> f64 {
        let size = self.normal.abs().dot(point.abs()) + self.offset.abs();
        self.offset + VERTEX_ERROR * size
    }

    /// The distance of a point to the boundary in lengths of the normal, positive on this side.
    fn distance(&self, point: DVec3) -> f64 {
        self.offset_near(point) - self.normal.dot(point)
    }

    /// The t of a ray on this side; `None` if there are none, or for a NaN. The origin decides about a ray that is
    /// parallel to the plane.
    pub(super) fn kept(&self, origin: DVec3, dir: DVec3) -> Option<KeptInterval> {
        let (distance, speed) = (self.distance(origin), self.normal.dot(dir));
        let length = self.normal.abs().dot((distance / speed * dir).abs());
        let thickness = ((VERTEX_ERROR + T_ERROR) * length).min(MOST_OF_LENGTH * distance.abs());
        let t = (distance + thickness) / speed;
        if speed > 0.0 && !t.is_nan() {
            // The ray leaves this side.
            Some(KeptInterval {
                last: f32_below(t),
                ..KeptInterval::ALL
            })
        } else if speed < 0.0 && !t.is_nan() {
            Some(KeptInterval {
                after: before(t),
                ..KeptInterval::ALL
            })
        } else {
            let is_parallel = speed == 0.0 && distance >= 0.0;
            is_parallel.then_some(KeptInterval::ALL)
        }
    }
}

/// The largest f32 that is less than t.
fn before(t: f64) -> f32 {
    let last = f32_below(t);
    if f64::from(last) == t {
        last.next_down()
    } else {
        last
    }
}

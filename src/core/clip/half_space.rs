//! One side of a plane, and the part of a ray on it.

use super::{ClipError, KeptInterval};
use crate::ray::f32_below;
use glam::DVec3;

/// One side of a plane: `normal·p ≤ offset`, or `<` if the plane itself belongs to the other side; see the
/// [module](super).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    normal: DVec3,
    offset: f64,
    has_plane: bool,
}

impl HalfSpace {
    /// The side of a plane that its normal points away from.
    ///
    /// # Errors
    /// See [`ClipError`].
    pub fn new(normal: DVec3, offset: f64) -> Result<Self, ClipError> {
        let first = normal.to_array().into_iter().find(|&x| x != 0.0);
        let has_plane = first.ok_or(ClipError::NormalZero)? > 0.0;
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
        Ok(Self {
            normal,
            offset,
            has_plane,
        })
    }

    /// The normal, which points to what is removed. Its largest component is between 1 and 2.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The offset: `normal·p` of the points of the plane.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The other side.
    #[must_use]
    pub fn opposite(&self) -> Self {
        Self {
            normal: -self.normal,
            offset: -self.offset,
            has_plane: !self.has_plane,
        }
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
        self.keeps_distance(self.offset - self.normal.dot(point))
    }

    /// The offset at which rays from an origin are cut: that of the plane's face on the side that doesn't own the plane.
    /// The opposite side computes the same number with the opposite sign.
    ///
    /// ```text
    ///   owner │▓▓▓▓▓│ other side          plane = offset, ▓ = thickness
    ///       offset  here
    /// ```
    pub fn offset_from(&self, origin: DVec3) -> f64 {
        /// Half ulp of a vertex and some ulps of t, relative to the numbers that they are computed from.
        const THICKNESS: f64 = 1.0 / (1 << 20) as f64;
        let size = self.normal.abs().dot(origin.abs()) + self.offset.abs();
        let thickness = THICKNESS * size;
        self.offset
            + if self.has_plane {
                thickness
            } else {
                -thickness
            }
    }

    fn keeps_distance(&self, distance: f64) -> bool {
        distance > 0.0 || (self.has_plane && distance == 0.0)
    }

    /// The t of a ray on this side; `None` if there are none, or for a NaN. The origin decides about a ray that is
    /// parallel to the plane.
    pub(super) fn kept(&self, origin: DVec3, dir: DVec3) -> Option<KeptInterval> {
        let distance = self.offset_from(origin) - self.normal.dot(origin);
        let speed = self.normal.dot(dir);
        let t = distance / speed;
        if speed > 0.0 && !t.is_nan() {
            // The ray leaves this side.
            let last = last_before(t, self.has_plane);
            Some(KeptInterval {
                last,
                ..KeptInterval::ALL
            })
        } else if speed < 0.0 && !t.is_nan() {
            let after = last_before(t, !self.has_plane);
            Some(KeptInterval {
                after,
                ..KeptInterval::ALL
            })
        } else {
            let is_parallel = speed == 0.0 && self.keeps_distance(distance);
            is_parallel.then_some(KeptInterval::ALL)
        }
    }

    /// The t of a line on this side, with the plane, in f64.
    pub(super) fn crossed(&self, origin: DVec3, dir: DVec3) -> Option<[f64; 2]> {
        let distance = self.offset - self.normal.dot(origin);
        let speed = self.normal.dot(dir);
        let t = distance / speed;
        if speed > 0.0 {
            Some([f64::NEG_INFINITY, t])
        } else if speed < 0.0 {
            Some([t, f64::INFINITY])
        } else {
            let is_kept = speed == 0.0 && distance >= 0.0;
            is_kept.then_some([f64::NEG_INFINITY, f64::INFINITY])
        }
    }
}

/// The largest f32 on the side of a plane that a ray leaves at t. `has_plane` says whether t itself is on that side.
fn last_before(t: f64, has_plane: bool) -> f32 {
    let last = f32_below(t);
    if !has_plane && f64::from(last) == t {
        last.next_down()
    } else {
        last
    }
}

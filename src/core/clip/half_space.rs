//! One side of a plane, and the part of a ray on it.

use super::{ClipError, KeptInterval};
use crate::ray::f32_below;
use glam::DVec3;

/// The thickness of a plane, relative to the sum of the products whose sum is a distance to it: 2⁻²⁴ for the rounding of
/// f32 vertices, and 15 times as much for t of the kernels that round.
const THICKNESS: f64 = 16.0 / (1 << 24) as f64;
/// The most that the reach of a ray adds, relative to its origin's distance to the plane. It matters for rays that are
/// almost parallel to the plane, whose t has no bound.
const MOST_OF_REACH: f64 = 1.0 / 1024.0;

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
        self.keeps_distance(self.distance(point))
    }

    /// The offset at which rays from `origin` are cut. It is the plane's offset, moved by the plane's thickness away from
    /// the side that owns the plane.
    ///
    /// ```text
    ///   owner │▓▓▓▓▓│ other side          │ left = offset, ▓ = thickness, │ right = returned offset
    /// ```
    pub fn offset_from(&self, origin: DVec3) -> f64 {
        let size = self.normal.abs().dot(origin.abs()) + self.offset.abs();
        self.offset + self.towards_other_side(THICKNESS * size)
    }

    /// The distance of a point to the plane's boundary in lengths of the normal, positive on this side. The opposite side
    /// computes the same number with the opposite sign.
    fn distance(&self, point: DVec3) -> f64 {
        self.offset_from(point) - self.normal.dot(point)
    }

    /// A length along the normal that leads from the owner of the plane to the other side.
    fn towards_other_side(&self, length: f64) -> f64 {
        if self.has_plane { length } else { -length }
    }

    fn keeps_distance(&self, distance: f64) -> bool {
        distance > 0.0 || (self.has_plane && distance == 0.0)
    }

    /// The t of a ray on this side; `None` if there are none, or for a NaN. The origin decides about a ray that is
    /// parallel to the plane.
    pub(super) fn kept(&self, origin: DVec3, dir: DVec3) -> Option<KeptInterval> {
        let (distance, speed) = (self.distance(origin), self.normal.dot(dir));
        // At the hit, positions are rounded in proportion to the ray's reach.
        let reach = self.normal.abs().dot((distance / speed * dir).abs());
        let thickness = (THICKNESS * reach).min(MOST_OF_REACH * distance.abs());
        let t = (distance + self.towards_other_side(thickness)) / speed;
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

//! Axis-aligned bounding boxes.

use glam::{DVec3, Vec3};

/// A closed box, `min ≤ p ≤ max` in each axis. Empty while `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: Vec3,
    /// Upper corner.
    pub max: Vec3,
}

/// Boxes side by side, plane by plane: lower x, upper x, lower y, upper y, lower z, upper z.
pub(crate) type Planes<T> = [T; 6];

impl Aabb {
    /// The empty box, neutral under [`union`](Self::union).
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The box around all points, neutral under [`intersection`](Self::intersection).
    pub const EVERYWHERE: Self = Self {
        min: Vec3::NEG_INFINITY,
        max: Vec3::INFINITY,
    };

    /// The smallest box around the points; [`Aabb::EMPTY`] for none. The result is unspecified if a point holds
    /// a NaN.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// The box between planes; see [`Planes`].
    pub(crate) fn from_planes([a, b, c, d, e, f]: Planes<f32>) -> Self {
        Self {
            min: Vec3::new(a, c, e),
            max: Vec3::new(b, d, f),
        }
    }

    /// The planes of the box; see [`Planes`].
    pub(crate) fn planes(&self) -> Planes<f32> {
        let (a, b) = (self.min, self.max);
        [a.x, b.x, a.y, b.y, a.z, b.z]
    }

    /// The points in both boxes.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let both = Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether the box contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The centre. It can't overflow, as both corners are halved before they are added.
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The square of the distance of a point from the box; 0 inside, infinite if the box is empty. NaN if the point holds
    /// one.
    pub fn distance_squared(&self, point: DVec3) -> f64 {
        let below = self.min.as_dvec3() - point;
        let above = point - self.max.as_dvec3();
        // Unlike `max`, `select` keeps a NaN.
        let outside = DVec3::select(below.cmpgt(above), below, above);
        DVec3::select(outside.cmplt(DVec3::ZERO), DVec3::ZERO, outside).length_squared()
    }

    /// The length of the diagonal; zero if the box is empty.
    pub fn diagonal(&self) -> f64 {
        self.extent().length()
    }

    /// Lengths of the edges; zero if the box is empty. In f64, so that those of the largest box are finite.
    pub fn extent(&self) -> DVec3 {
        (self.max.as_dvec3() - self.min.as_dvec3()).max(DVec3::ZERO)
    }

    /// Half the surface area, which the surface-area heuristic needs; zero if the box is empty.
    pub fn half_area(&self) -> f64 {
        let e = self.extent();
        e.x * (e.y + e.z) + e.y * e.z
    }

    /// The radius of the sphere about [`centre`](Self::centre) through the corners; zero if the box is empty.
    pub fn radius(&self) -> f64 {
        0.5 * self.diagonal()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_empty_box_is_the_identity_of_the_union() {
        let b = Aabb::around([Vec3::ZERO, Vec3::ONE]);
        assert_eq!(Aabb::EMPTY.union(b), b);
        assert!(Aabb::EMPTY.is_empty() && !b.is_empty());
        assert_eq!(Aabb::EMPTY.half_area(), 0.0);
        assert_eq!(Aabb::EMPTY.radius(), 0.0);
    }

    #[test]
    fn a_box_of_one_point_is_not_empty() {
        let b = Aabb::around([Vec3::splat(3.0)]);
        assert!(!b.is_empty());
        assert_eq!(b.centre(), Vec3::splat(3.0));
        assert_eq!(b.half_area(), 0.0);
    }

    #[test]
    fn the_distance_from_a_box_is_that_from_its_nearest_point() {
        let b = Aabb::around([Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)]);
        for (point, squared) in [
            (DVec3::new(0.5, 1.0, 3.0), 0.0),
            (DVec3::new(-2.0, 1.0, 1.0), 4.0),
            (DVec3::new(2.0, 4.0, 5.0), 9.0),
        ] {
            assert_eq!(b.distance_squared(point), squared, "{point}");
        }
        assert_eq!(Aabb::EMPTY.distance_squared(DVec3::ONE), f64::INFINITY);
        assert!(b.distance_squared(DVec3::new(0.5, f64::NAN, 0.5)).is_nan());
    }

    #[test]
    fn the_measures_of_the_largest_box_are_finite() {
        let b = Aabb::around([Vec3::splat(f32::MIN), Vec3::splat(f32::MAX)]);
        assert_eq!(b.centre(), Vec3::ZERO);
        assert!(b.radius().is_finite() && b.half_area().is_finite());
    }
}

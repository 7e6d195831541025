//! Triangles.

use super::Shape;
use super::shared_corners::SharedCorners;
use crate::aabb::Aabb;
use glam::Vec3;

/// A closed triangle by its corners A, B and C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle(pub [Vec3; 3]);

impl From<[Vec3; 3]> for Triangle {
    fn from(corners: [Vec3; 3]) -> Self {
        Self(corners)
    }
}

impl Shape for Triangle {
    type Compact = SharedCorners;

    fn nowhere() -> Self {
        Self([Vec3::NAN; 3])
    }

    /// Encloses the corners, and the corners as a kernel recomputes them from the first corner and the edges.
    fn bounds(&self) -> Aabb {
        let [a, b, c] = self.0;
        Aabb::around([a, b, c, a + (b - a), a + (c - a)])
    }
}

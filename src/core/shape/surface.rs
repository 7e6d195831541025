//! Points of surfaces.

use glam::{DVec2, DVec3, Vec3};

/// The point at which a ray hits a primitive, and the surface there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub position: Vec3,
    /// Unit normal: by the right-hand rule for a triangle, outwards for a closed shape. Zero if the surface has none.
    pub normal: DVec3,
    /// Surface coordinates. For a triangle, the weights of its second and third corner.
    pub uv: DVec2,
    /// Bounds, per coordinate, of the distance between the point and the surface as the next test sees it.
    pub error: Vec3,
    /// Whether a ray that leaves the primitive can't hit it again.
    pub is_flat: bool,
}

impl SurfacePoint {
    /// Whether a direction points to the side of the surface opposite to the normal.
    #[inline]
    pub fn is_behind(&self, dir: Vec3) -> bool {
        self.normal.dot(dir.as_dvec3()) < 0.0
    }

    /// The normal on the side of a direction.
    #[inline]
    pub fn facing_normal(&self, dir: Vec3) -> Vec3 {
        let normal = self.normal.as_vec3();
        if self.is_behind(dir) { -normal } else { normal }
    }
}

//! The surface at a hit, in the file's coordinates.

use hitscope_core::interaction::position_at;
use hitscope_core::mesh::unit_normal;
use hitscope_core::{Hit, Ray, Scene};

/// A point of the surface, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The position; for a triangle, computed from the barycentric coordinates.
    pub position: [f64; 3],
    /// Unit normal, independent of the side that the ray hits: by the right-hand rule for a triangle, outwards for a
    /// closed shape.
    pub normal: [f64; 3],
}

impl SurfacePoint {
    /// The point at a hit. The ray is in the scene's coordinates; for a triangle, it may be in any others.
    pub fn in_file(scene: &Scene, ray: &Ray, hit: &Hit) -> Self {
        let mesh = scene.mesh();
        let (position, normal) = if scene.is_triangle(hit.primitive) {
            let position = position_at(scene, ray, hit);
            (
                mesh.in_file(position),
                unit_normal(mesh.corners(hit.primitive)),
            )
        } else {
            let surface = scene.surface(ray, hit);
            // An f32 point, with no more digits than it has.
            (mesh.vertex_in_file(surface.position), surface.normal)
        };
        Self {
            position: position.to_array(),
            normal: normal.to_array(),
        }
    }
}

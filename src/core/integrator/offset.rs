//! Offsets of ray origins by a repair of the shadow terminator.

use super::Context;
use crate::ray::Hit;
use crate::scene::Shading;
use crate::terminator::Offset;
use glam::Vec3;

/// The offset of the origins of rays that leave on the front or the back; zero with flat shading and for primitives
/// other than triangles.
pub(super) fn offset_by(offset: Offset, context: &Context, hit: &Hit, is_front: bool) -> Vec3 {
    let scene = &context.scene;
    let corners = scene.corners(hit.primitive);
    let Some(corners) = corners.filter(|_| context.shading != Shading::Flat) else {
        return Vec3::ZERO;
    };
    let normals = scene.vertex_normals();
    let normals = normals.of_triangle(scene.mesh(), hit.primitive);
    let side = if is_front { 1.0 } else { -1.0 };
    offset(hit.barycentric(), corners, normals.map(|n| side * n))
}

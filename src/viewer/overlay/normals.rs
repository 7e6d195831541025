//! What normals of faces and of vertices share.

use super::spec::{OptionKind, OverlayOption};
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::Scene;

/// Length of the normals, as a fraction of the mesh's radius.
pub static LENGTH: OverlayOption = OverlayOption {
    name: "length",
    title: "Length",
    kind: OptionKind::Fraction(0.002..=0.5),
    default: 0.03,
};

/// A normal as a line. It is as long as the scene's radius; [`LENGTH`] shortens it. `gap` leads to the next one.
pub fn line(scene: &Scene, start: Vec3, normal: Vec3, gap: Vec3) -> Line {
    let length = scene.bounds().radius() as f32;
    Line {
        start,
        end: start + normal * length,
        gap,
    }
}

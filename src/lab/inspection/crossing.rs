//! The points where a ray crosses surfaces.

use super::OperandName;
use super::hit::side;
use crate::surface::SurfacePoint;
use hitscope_core::interaction::SurfaceInteraction;
use hitscope_core::intersector::Crossing;
use hitscope_core::scene::Shading;
use hitscope_core::{Ray, Scene};
use serde::Serialize;

/// A point where a ray crosses a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossingReport {
    /// Distance in units of the direction's length.
    pub t: f32,
    /// The shape.
    pub shape: &'static str,
    /// Index of the primitive in the scene, counted from 0; the lowest of several at the same t.
    pub primitive: u32,
    /// The operand whose surface is crossed, if the primitive is a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub operand: Option<OperandName>,
    /// Other primitives at the same t.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<u32>,
    /// The side, as in [`HitReport`](super::HitReport).
    pub side: &'static str,
    /// The position in the file's coordinates.
    pub position: [f64; 3],
}

impl CrossingReport {
    /// Describes a crossing of a ray.
    pub fn new(scene: &Scene, ray: &Ray, Crossing { hit, also }: Crossing) -> Self {
        let surface = SurfaceInteraction::new(scene, ray, hit, Shading::Flat);
        Self {
            t: hit.t,
            shape: scene.group_of(hit.primitive).0.shape().name,
            primitive: hit.primitive,
            operand: OperandName::of_hit(scene, &hit),
            also,
            side: side(ray, surface.geometric_normal),
            position: SurfacePoint::in_file(scene, ray, &hit).position,
        }
    }
}

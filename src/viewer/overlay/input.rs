//! What overlays are drawn from.

use crate::measuring::Measurements;
use glam::DVec3;
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::PathRecord;
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::{Aabb, Camera, Scene};
use std::sync::Arc;

/// The scene and the view that overlays are drawn from.
#[derive(Clone)]
pub struct OverlayInput {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The camera of the picture.
    pub camera: Camera,
    /// The camera that curves are divided into lines for: that of the picture, but while it moves, an earlier one.
    pub lines_camera: Camera,
    /// The axis that points up.
    pub up_axis: UpAxis,
    /// The point that the camera turns about, in the scene's coordinates.
    pub pivot: DVec3,
    /// What is marked.
    pub marks: Marks,
    /// Physical pixels per unit of width, at least 1.
    pub scale: f32,
}

/// What the user has selected.
#[derive(Clone, Default)]
pub struct Marks {
    /// A kind of flaw, and where the mesh's flaws are.
    pub flaw: Option<(Flaw, Arc<Health>)>,
    /// The picked primitive.
    pub picked: Option<u32>,
    /// The path of the picked pixel.
    pub path: Option<Arc<PathRecord>>,
    /// The picked points in the scene's coordinates, with their numbers and names.
    pub picks: Vec<(DVec3, String)>,
    /// Measurements between them.
    pub measurements: Measurements,
    /// The selected box of the picked ray's walk.
    pub opened: Option<Aabb>,
}

impl OverlayInput {
    /// Size of a pixel at the pivot, in the scene's units. Zero if a perspective camera is at the pivot.
    pub fn pixel_size(&self) -> f64 {
        let depth = self.camera.depth_of(self.pivot).abs();
        self.camera.pixel_size_at(depth)
    }
}

//! A request for a picture.

use super::stopwatch::Stopwatch;
use hitscope_core::integrator::{Context, Integrator, Lighting};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A request for a picture.
#[derive(Clone)]
pub struct Request {
    /// Scene, camera, kernels and lights.
    pub context: Context,
    /// The view.
    pub integrator: &'static Integrator,
    /// Samples per pixel of the finished picture.
    pub samples: u32,
    /// Whether the view shows the cost of rays in the final tree.
    pub shows_last_tree: bool,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&self.context, &other.context);
        Arc::ptr_eq(&a.scene, &b.scene)
            && Arc::ptr_eq(&a.intersector, &b.intersector)
            && Arc::ptr_eq(&a.second, &b.second)
            && (a.camera, a.shading, a.background) == (b.camera, b.shading, b.background)
            && a.options == b.options
            && (self.integrator.name, self.samples) == (other.integrator.name, other.samples)
            && self.shows_last_tree == other.shows_last_tree
            && (!self.is_lit() || is_same_light(&a.lighting, &b.lighting))
    }
}

impl Request {
    /// Whether the view needs lights.
    pub fn is_lit(&self) -> bool {
        self.integrator.needs.lights
    }
}

fn is_same_light(a: &Lighting, b: &Lighting) -> bool {
    Arc::ptr_eq(&a.lights, &b.lights)
        && a.spawn.name == b.spawn.name
        && a.second_spawn.name == b.second_spawn.name
        && a.ao_distance == b.ao_distance
        && a.depth_limit == b.depth_limit
        && a.terminator.name == b.terminator.name
}

/// The request that the threads are working on.
pub(super) struct PostedRequest {
    pub request: Request,
    pub at: Instant,
    /// Time from posting to the newest tile.
    pub lasted: Duration,
    /// Whether the preview is being traced.
    pub is_preview: bool,
    /// Wall-clock time since the view, or its preview, was posted; without pauses.
    pub refined: Stopwatch,
}

impl PostedRequest {
    /// Whether a view that needs lights is being traced, not its preview.
    pub fn is_lit(&self) -> bool {
        self.request.is_lit() && !self.is_preview
    }
}

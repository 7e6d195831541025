//! Hidden emitters, which light the scene but aren't seen: rays of the camera pass through surfaces that emit light.

use super::Context;
use super::record::Recorder;
use super::transport::ShadingPoint;
use crate::ray::{Hit, Ray};

/// Replaces a camera's ray by its part behind the emitters before the first other surface, and its hit by the hit of
/// that part. Does nothing unless emitters are hidden.
#[inline]
pub(super) fn past_emitters(
    context: &Context,
    ray: &mut Ray,
    hit: &mut Option<Hit>,
    recorder: &mut impl Recorder,
) {
    if context.lighting.hides_emitters {
        (*ray, *hit) = search(context, *ray, *hit, recorder);
    }
}

fn search(
    context: &Context,
    mut ray: Ray,
    mut hit: Option<Hit>,
    recorder: &mut impl Recorder,
) -> (Ray, Option<Hit>) {
    while let Some(nearest) = hit.filter(|hit| context.scene.emits(hit.primitive)) {
        let point = ShadingPoint::new(context, &ray, nearest);
        recorder.meet(&point);
        recorder.pass();
        // If numbers overflow, the ray hits nothing more.
        let Some(onward) = point.onward() else {
            return (ray, None);
        };
        ray = onward;
        hit = context.intersector.closest_hit(&ray);
    }
    (ray, hit)
}

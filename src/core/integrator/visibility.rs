//! Transmittance of rays: the part of the light that surfaces in the way let pass.

use super::Context;
use super::transport::ShadingPoint;
use crate::ray::Ray;

/// The part of the light that passes along each ray.
///
/// Packets aren't used: rays to a lamp from neighbouring pixels, sorted by the signs of their directions, take twice as
/// many instructions in packets as one by one, because the paths' first surfaces and the points of the lamp are too far
/// apart (bunny on a plane, AVX2, 2026-11). Pictures of ambient occlusion take 12 % longer with packets of rays that
/// are sorted by direction (bunny, AVX-512, 2026-11), and 14 % longer with unsorted packets that are split where their
/// rays diverge, which make no difference to pictures of path tracing (1.1 million triangles, AVX2, 2026-11).
pub(super) fn transmittances(context: &Context, rays: &[Ray]) -> Vec<f32> {
    if context.lighting.lights.has_coverage() {
        return rays
            .iter()
            .map(|ray| transmittance(context, *ray))
            .collect();
    }
    let mut are_blocked = vec![false; rays.len()];
    context.intersector.any_hits(rays, &mut are_blocked);
    let part = |is_blocked| if is_blocked { 0.0 } else { 1.0 };
    are_blocked.into_iter().map(part).collect()
}

/// The part of the light that passes along a ray, from 0 to 1; 0 if numbers overflow.
#[inline]
pub(super) fn transmittance(context: &Context, mut ray: Ray) -> f32 {
    if !context.lighting.lights.has_coverage() {
        return if context.intersector.any_hit(&ray) {
            0.0
        } else {
            1.0
        };
    }
    let mut passed = 1.0;
    while let Some(hit) = context.intersector.closest_hit(&ray) {
        let point = ShadingPoint::new(context, &ray, hit);
        passed *= 1.0 - point.opacity;
        if passed <= 0.0 {
            return 0.0;
        }
        let Some(onward) = point.onward() else {
            return 0.0;
        };
        // The rest of the way.
        let t_max = ray.t_max - hit.t;
        if t_max <= onward.t_min {
            break;
        }
        ray = Ray { t_max, ..onward };
    }
    passed
}

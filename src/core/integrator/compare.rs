//! Views that compare the chosen kernel with another one, usually the exact kernel.

use super::Context;
use super::palette::{FALSE_HIT, MISSED, OTHER_TRIANGLE, UNDEFINED, error_ramp};
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray, ulp_at};
use glam::Vec3;

/// Range of the scale for t in ulps: from a tenth of the error of correct rounding to four wrong digits of f32's
/// seven.
pub(super) const T_RANGE: [f64; 2] = [0.05, 5e4];
/// Range of the scale for barycentric errors: from a sixth of half an f32 ulp of 1 to a tenth.
pub(super) const WEIGHT_RANGE: [f64; 2] = [1e-8, 0.1];

/// The error of t in f32 ulps.
pub(super) fn error_t(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    error(context, ray, hit, |hit, [t, _, _]| {
        log_colour((f64::from(hit.t) - t).abs() / ulp_at(t), T_RANGE)
    })
}

/// The largest error of a barycentric coordinate; [`UNDEFINED`] on shapes other than triangles.
pub(super) fn error_barycentric(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    error(context, ray, hit, |hit, [_, u, v]| {
        if context.scene.is_triangle(hit.primitive) {
            log_colour(hit.weight_error([1.0 - u - v, u, v]), WEIGHT_RANGE)
        } else {
            UNDEFINED
        }
    })
}

/// The colour of a hit's error against the exact t, u and v of its triangle; other colours mark wrong decisions.
fn error(
    context: &Context,
    ray: &Ray,
    hit: Option<Hit>,
    colour: impl Fn(Hit, [f64; 3]) -> Vec3,
) -> Vec3 {
    let Some(hit) = hit else {
        return if context.second.any_hit(ray) {
            MISSED
        } else {
            context.background
        };
    };
    match context.scene.exact_answer(ray, hit.primitive) {
        Some(exact) => colour(hit, exact),
        None if context.second.any_hit(ray) => OTHER_TRIANGLE,
        None => FALSE_HIT,
    }
}

/// Marks where the two kernels disagree; elsewhere shows a faint picture for orientation.
pub(super) fn disagreement(context: &Context, ray: &Ray, hit: Option<Hit>) -> Vec3 {
    match (hit, context.second.closest_hit(ray)) {
        (None, None) => context.background,
        (None, Some(_)) => MISSED,
        (Some(_), None) => FALSE_HIT,
        (Some(a), Some(b)) if a.primitive != b.primitive => OTHER_TRIANGLE,
        (Some(hit), Some(_)) => {
            let surface = SurfaceInteraction::new(&context.scene, ray, hit, context.shading);
            let facing = surface.facing_normal(ray).dot(-ray.dir.normalize_or_zero());
            Vec3::splat(0.02 + 0.10 * facing.max(0.0))
        }
    }
}

/// The ramp's colour for a number, on a logarithmic scale over a range.
pub(super) fn log_colour(x: f64, [least, most]: [f64; 2]) -> Vec3 {
    // 0 has no logarithm; it gets the colour of the lower end.
    let part = (x.max(least) / least).ln() / (most / least).ln();
    error_ramp(part as f32)
}

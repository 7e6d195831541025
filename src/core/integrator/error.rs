//! The views *Error of t* and *Barycentric error*: hits compared with the exact answer.

use super::palette::{FALSE_HIT, MISSED, OTHER_TRIANGLE, UNDEFINED, decisions, log_colour};
use super::{Comparison, Context, Integrator, Legend, Needs};
use crate::ray::{Hit, Ray, ulp_at};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static ERROR_T: Integrator = Integrator {
    name: "error-t",
    title: "Error of t",
    about: "Error of t of the chosen kernel, in f32 ulps, on a logarithmic scale.",
    needs: Needs {
        second: Comparison::Exact,
        ..Needs::NOTHING
    },
    legend: legend_of_t,
    radiance: of_t,
};

/// The row of the view.
pub(super) static ERROR_BARYCENTRIC: Integrator = Integrator {
    name: "error-barycentric",
    title: "Barycentric error",
    about: "Largest error of a barycentric coordinate of the chosen kernel, on a logarithmic scale. Shapes other than triangles have no barycentric coordinates and are grey.",
    needs: Needs {
        second: Comparison::Exact,
        ..Needs::NOTHING
    },
    legend: legend_of_weights,
    radiance: of_weights,
};

/// Range of the scale for t in ulps: from a tenth of the error of correct rounding to four wrong digits of f32's
/// seven.
const T_RANGE: [f64; 2] = [0.05, 5e4];
/// Range of the scale for barycentric errors: from a sixth of half an f32 ulp of 1 to a tenth.
const WEIGHT_RANGE: [f64; 2] = [1e-8, 0.1];

/// The error of t in f32 ulps.
fn of_t(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    error(context, ray, hit, |hit, [t, _, _]| {
        log_colour((f64::from(hit.t) - t).abs() / ulp_at(t), T_RANGE)
    })
}

fn legend_of_t() -> Legend {
    let ulps = [0.05, 0.5, 5.0, 50.0, 500.0, 5e3, 5e4];
    let entry = |x: f64| (log_colour(x, T_RANGE), x.to_string());
    vec![ulps.map(entry).into(), decisions()]
}

/// The largest error of a barycentric coordinate; [`UNDEFINED`] on shapes other than triangles.
fn of_weights(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    error(context, ray, hit, |hit, [_, u, v]| {
        if context.scene.is_triangle(hit.primitive) {
            log_colour(hit.weight_error([1.0 - u - v, u, v]), WEIGHT_RANGE)
        } else {
            UNDEFINED
        }
    })
}

fn legend_of_weights() -> Legend {
    let errors = [1e-8, 1e-6, 1e-4, 1e-2, 0.1];
    let entry = |x: f64| (log_colour(x, WEIGHT_RANGE), format!("{x:e}"));
    let undefined = (UNDEFINED, "not a triangle: undefined".to_owned());
    vec![errors.map(entry).into(), decisions(), vec![undefined]]
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

//! The views *Error of t* and *Barycentric error*: hits compared with the exact answer.

use super::number::{DefaultRange, NumberView, Shown};
use super::palette::{FALSE_HIT, MISSED, OTHER_TRIANGLE, UNDEFINED, decisions, named};
use super::{Comparison, Context, Integrator, Needs, Setting, Source};
use crate::colour::DUSK;
use crate::ray::{Hit, Ray, ulp_at};
use crate::sampler::Sampler;

/// The row of the view.
pub(super) static ERROR_T: Integrator = Integrator {
    name: "error-t",
    title: "Error of t",
    about: "Error of t of the chosen kernel, in f32 ulps, on a logarithmic scale.",
    needs: Needs {
        second: Comparison::Exact,
        settings: &[Setting::Scale],
        ..Needs::NOTHING
    },
    legend: || vec![decisions()],
    source: Source::Number(NumberView {
        title: "Error of t",
        unit: "f32 ulps",
        map: &DUSK,
        range: DefaultRange::Fixed(T_RANGE),
        is_logarithmic: true,
        shown: of_t,
    }),
};

/// The row of the view.
pub(super) static ERROR_BARYCENTRIC: Integrator = Integrator {
    name: "error-barycentric",
    title: "Barycentric error",
    about: "Largest error of a barycentric coordinate of the chosen kernel, on a logarithmic scale. Shapes other than triangles have no barycentric coordinates and are grey.",
    needs: Needs {
        second: Comparison::Exact,
        settings: &[Setting::Scale],
        ..Needs::NOTHING
    },
    legend: || {
        vec![
            decisions(),
            vec![named(UNDEFINED, "not a triangle: undefined")],
        ]
    },
    source: Source::Number(NumberView {
        title: "Barycentric error",
        unit: "",
        map: &DUSK,
        range: DefaultRange::Fixed(WEIGHT_RANGE),
        is_logarithmic: true,
        shown: of_weights,
    }),
};

/// Range of the scale for t in ulps: from a tenth of the error of correct rounding to four wrong digits of f32's
/// seven.
const T_RANGE: [f64; 2] = [0.05, 5e4];
/// Range of the scale for barycentric errors: from a sixth of half an f32 ulp of 1 to a tenth.
const WEIGHT_RANGE: [f64; 2] = [1e-8, 0.1];

/// The error of t in f32 ulps.
fn of_t(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Shown {
    error(context, ray, hit, |hit, [t, _, _]| {
        Shown::Number((f64::from(hit.t) - t).abs() / ulp_at(t))
    })
}

/// The largest error of a barycentric coordinate; [`UNDEFINED`] on shapes other than triangles.
fn of_weights(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Shown {
    error(context, ray, hit, |hit, [_, u, v]| {
        if context.scene.is_triangle(hit.primitive) {
            Shown::Number(hit.weight_error([1.0 - u - v, u, v]))
        } else {
            Shown::Colour(UNDEFINED)
        }
    })
}

/// A hit's error against the exact t, u and v of its triangle; colours mark wrong decisions.
fn error(
    context: &Context,
    ray: &Ray,
    hit: Option<Hit>,
    error: impl Fn(Hit, [f64; 3]) -> Shown,
) -> Shown {
    let Some(hit) = hit else {
        return Shown::Colour(if context.second.any_hit(ray) {
            MISSED
        } else {
            context.background
        });
    };
    match context.scene.exact_answer(ray, hit.primitive) {
        Some(exact) => error(hit, exact),
        None if context.second.any_hit(ray) => Shown::Colour(OTHER_TRIANGLE),
        None => Shown::Colour(FALSE_HIT),
    }
}

//! Legends of the views.

use super::Legend;
use super::compare::{T_RANGE, WEIGHT_RANGE, log_colour};
use super::palette::{COST_SCALE, FALSE_HIT, MISSED, OTHER_TRIANGLE, UNDEFINED, cost_colour};
use glam::Vec3;

pub(super) fn none() -> Legend {
    Vec::new()
}

pub(super) fn barycentric() -> Legend {
    let named = |colour, text: &str| (colour, text.to_owned());
    vec![
        vec![
            named(Vec3::X, "A"),
            named(Vec3::Y, "B"),
            named(Vec3::Z, "C of a triangle"),
        ],
        vec![named(Vec3::X, "u"), named(Vec3::Y, "v of other shapes")],
    ]
}

pub(super) fn cost() -> Legend {
    let tests = [0, 4, 16, 64, 256, COST_SCALE];
    vec![tests.map(|n| (cost_colour(n), n.to_string())).into()]
}

pub(super) fn error_t() -> Legend {
    let ulps = [0.05, 0.5, 5.0, 50.0, 500.0, 5e3, 5e4];
    let entry = |x: f64| (log_colour(x, T_RANGE), x.to_string());
    vec![ulps.map(entry).into(), decisions().remove(0)]
}

pub(super) fn error_barycentric() -> Legend {
    let errors = [1e-8, 1e-6, 1e-4, 1e-2, 0.1];
    let entry = |x: f64| (log_colour(x, WEIGHT_RANGE), format!("{x:e}"));
    let undefined = (UNDEFINED, "not a triangle: undefined".to_owned());
    vec![
        errors.map(entry).into(),
        decisions().remove(0),
        vec![undefined],
    ]
}

pub(super) fn decisions() -> Legend {
    let named = |colour, text: &str| (colour, text.to_owned());
    vec![vec![
        named(MISSED, "missed"),
        named(FALSE_HIT, "false hit"),
        named(OTHER_TRIANGLE, "other primitive"),
    ]]
}

//! The view *Triangle*.

use super::{Integrator, Needs, Source};

/// The row of the view.
pub(super) static TRIANGLE: Integrator = Integrator {
    name: "triangle",
    title: "Triangle",
    about: "A colour for each triangle or other primitive.",
    needs: Needs::NOTHING,
    legend: Vec::new,
    source: Source::Index,
};

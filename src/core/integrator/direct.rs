//! The view *Direct light*: light that reaches surfaces straight from the lights.

use super::path::follow_all;
use super::{Context, Integrator, Needs, Sample, Source};

/// The row of the view.
pub(super) static DIRECT: Integrator = Integrator {
    name: "direct",
    title: "Direct light",
    about: "Light from the lights, without light by way of other surfaces.",
    needs: Needs::LIGHTS,
    legend: Vec::new,
    source: Source::Batch(radiances),
};

fn radiances(context: &Context, samples: &mut [Sample]) {
    follow_all(context, samples, limit(context));
}

/// The most surfaces on a path.
pub(super) fn limit(_context: &Context) -> Option<u32> {
    Some(1)
}

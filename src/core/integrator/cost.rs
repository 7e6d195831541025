//! The view *Cost*.

use super::number::{DefaultRange, NumberView, Shown};
use super::{Context, Integrator, Needs, Setting, Source};
use crate::colour::VIRIDIS;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;

/// The row of the view.
pub(super) static COST: Integrator = Integrator {
    name: "cost",
    title: "Cost",
    about: "Boxes and primitives tested for the ray, on a logarithmic scale.",
    needs: Needs {
        final_tree: true,
        settings: &[Setting::Scale],
        ..Needs::NOTHING
    },
    legend: Vec::new,
    source: Source::Number(NumberView {
        title: "Boxes and primitives tested",
        unit: "",
        map: &VIRIDIS,
        // To an expensive ray in a good tree.
        range: DefaultRange::Fixed([1.0, 1024.0]),
        is_logarithmic: true,
        shown,
    }),
};

/// Rays that hit nothing have a cost, too; this view has no background.
fn shown(context: &Context, ray: &Ray, _: Option<Hit>, _: &mut Sampler) -> Shown {
    let (_, cost) = context.intersector.closest_hit_with_cost(ray);
    Shown::Number(f64::from(cost.boxes) + f64::from(cost.primitives))
}

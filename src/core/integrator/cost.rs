//! The view *Cost*.

use super::palette::{COST_SCALE, cost_colour};
use super::{Context, Integrator, Legend, Needs};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static COST: Integrator = Integrator {
    name: "cost",
    title: "Cost",
    about: "Boxes and primitives tested for the ray, on a logarithmic scale.",
    needs: Needs {
        final_tree: true,
        ..Needs::NOTHING
    },
    legend,
    radiance,
};

/// Rays that hit nothing have a cost, too; this view has no background.
fn radiance(context: &Context, ray: &Ray, _: Option<Hit>, _: &mut Sampler) -> Vec3 {
    let (_, cost) = context.intersector.closest_hit_with_cost(ray);
    cost_colour(cost.boxes + cost.primitives)
}

fn legend() -> Legend {
    let tests = [0, 4, 16, 64, 256, COST_SCALE];
    vec![tests.map(|n| (cost_colour(n), n.to_string())).into()]
}

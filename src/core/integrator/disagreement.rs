//! The view *Disagreement*: two kernels of the user's choice.

use super::palette::{FALSE_HIT, MISSED, OTHER_TRIANGLE, decisions};
use super::{Comparison, Context, Integrator, Needs, Source};
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static DISAGREEMENT: Integrator = Integrator {
    name: "disagreement",
    title: "Disagreement",
    about: "Where the chosen kernel and a second one hit different primitives, or only one of them hits.",
    needs: Needs {
        second: Comparison::Second,
        ..Needs::NOTHING
    },
    legend: || vec![decisions()],
    source: Source::Colour(radiance),
};

/// Marks where the two kernels disagree; elsewhere shows a faint picture for orientation.
fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
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

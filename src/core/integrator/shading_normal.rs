//! The view *Shading normal*: where the shading and the geometric normal disagree about which light arrives.
//!
//! Source of the problem: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 5.3.

use super::palette::{FALSE_HIT, MISSED, decision, named};
use super::transport::ShadingPoint;
use super::{Context, Integrator, Legend, Needs, Setting, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static SHADING_NORMAL: Integrator = Integrator {
    name: "shading-normal",
    title: "Shading normal",
    about: "Directions of light that only the shading normal or only the geometric normal admits. Path tracing drops both, which darkens edges and the border of shadows.",
    needs: Needs {
        settings: &[Setting::Lights],
        ..Needs::LIGHTS
    },
    legend,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let point = ShadingPoint::new(context, ray, hit);
    let [by_shading, by_geometry] = point.sides(point.light_direction(sampler));
    decision(by_shading, by_geometry, by_shading)
}

fn legend() -> Legend {
    vec![vec![
        named(FALSE_HIT, "shading normal alone"),
        named(MISSED, "geometric normal alone"),
    ]]
}

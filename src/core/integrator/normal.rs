//! The view *Normal*.

use super::{Context, Integrator, Needs, Source};
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::srgb::from_display;
use glam::Vec3;

/// The row of the view.
pub(super) static NORMAL: Integrator = Integrator {
    name: "normal",
    title: "Normal",
    about: "The shading normal: x, y, z from −1 to 1 as red, green, blue.",
    needs: Needs::VERTEX_NORMALS,
    legend: Vec::new,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    hit.map_or(context.background, |hit| {
        let surface = SurfaceInteraction::new(&context.scene, ray, hit, context.shading);
        from_display(0.5 * surface.shading_normal + 0.5)
    })
}

//! The view *Orientation*: which side of a face the ray sees.

use super::options::{back_face_colour, front_face_colour};
use super::palette::named;
use super::{Context, Integrator, Needs, Source};
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::scene::Shading;
use glam::Vec3;

/// The row of the view.
pub(super) static ORIENTATION: Integrator = Integrator {
    name: "orientation",
    title: "Orientation",
    about: "Front faces are blue, back faces orange. By the right-hand rule, the corners of a triangle run counterclockwise as seen from its front; the front of a closed shape is its outside.",
    needs: Needs::NOTHING,
    legend: || {
        vec![vec![
            named(front_face_colour(), "front"),
            named(back_face_colour(), "back"),
        ]]
    },
    source: Source::Colour(radiance),
};

/// The colour of the side, darker where the surface is seen at a flat angle.
fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let surface = SurfaceInteraction::new(&context.scene, ray, hit, Shading::Flat);
    let towards_eye = -surface.geometric_normal.dot(ray.dir.normalize_or_zero());
    let colour = if towards_eye >= 0.0 {
        front_face_colour()
    } else {
        back_face_colour()
    };
    (0.4 + 0.6 * towards_eye.abs()) * colour
}

//! The view *Interpolation*: the angle between the two ways to interpolate vertex normals.

use super::number::{DefaultRange, NumberView, Shown};
use super::{Context, Integrator, Needs, Setting, Source};
use crate::colour::DUSK;
use crate::interaction::SurfaceInteraction;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::scene::Shading;
use glam::Vec3;

/// The row of the view.
pub(super) static INTERPOLATION: Integrator = Integrator {
    name: "interpolation",
    title: "Interpolation",
    about: "Angle between the linearly and the spherically interpolated vertex normal, on a logarithmic scale; grey below 0.001°.",
    needs: Needs {
        settings: &[Setting::Scale],
        ..Needs::VERTEX_NORMALS
    },
    legend: Vec::new,
    source: Source::Number(NumberView {
        title: "Angle",
        unit: "°",
        map: &DUSK,
        // From invisible, yet above rounding to f32, to a visible shift of highlights.
        range: DefaultRange::Fixed([0.001, 10.0]),
        is_logarithmic: true,
        shown,
    }),
};

/// The angle between the linearly and the spherically interpolated normal; grey below the scale.
fn shown(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Shown {
    let Some(hit) = hit else {
        return Shown::Colour(context.background);
    };
    let normal = |shading| {
        let surface = SurfaceInteraction::new(&context.scene, ray, hit, shading);
        surface.shading_normal.as_dvec3()
    };
    let (linear, spherical) = (normal(Shading::Smooth), normal(Shading::Spherical));
    // Accurate for small angles, unlike the inverse cosine.
    let angle = 2.0 * (0.5 * (linear - spherical).length()).min(1.0).asin();
    let facing = linear.dot(ray.dir.as_dvec3().normalize_or_zero());
    let grey = Vec3::splat(0.02 + 0.10 * facing.abs() as f32);
    Shown::NumberOr(angle.to_degrees(), grey)
}

//! The view *Interpolation*: the angle between the two ways to interpolate vertex normals.

use super::palette::log_colour;
use super::{Context, Integrator, Legend, Needs};
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
    needs: Needs::VERTEX_NORMALS,
    legend,
    radiance,
};

/// Range of the scale in degrees: from invisible, yet above rounding to f32, to a visible shift of highlights.
const RANGE: [f64; 2] = [0.001, 10.0];

/// The angle between the linearly and the spherically interpolated normal; grey below the scale.
fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let normal = |shading| {
        let surface = SurfaceInteraction::new(&context.scene, ray, hit, shading);
        surface.shading_normal.as_dvec3()
    };
    let (linear, spherical) = (normal(Shading::Smooth), normal(Shading::Spherical));
    // Accurate for small angles, unlike the inverse cosine.
    let angle = 2.0 * (0.5 * (linear - spherical).length()).min(1.0).asin();
    if angle.to_degrees() < RANGE[0] {
        let facing = linear.dot(ray.dir.as_dvec3().normalize_or_zero());
        return Vec3::splat(0.02 + 0.10 * facing.abs() as f32);
    }
    log_colour(angle.to_degrees(), RANGE)
}

fn legend() -> Legend {
    let degrees = [0.001, 0.01, 0.1, 1.0, 10.0];
    vec![
        degrees
            .map(|x| (log_colour(x, RANGE), format!("{x}°")))
            .into(),
    ]
}

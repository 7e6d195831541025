//! The view *Ambient occlusion*: how open surfaces are.
//!
//! Source: Zhukov, Iones, Kronin, "An Ambient Light Illumination Model", Rendering Techniques 1998.

use super::transport::{ShadingPoint, transmittance};
use super::{Context, Integrator, Needs, Setting, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::Vec3;

/// The row of the view.
pub(super) static AMBIENT_OCCLUSION: Integrator = Integrator {
    name: "ao",
    title: "Ambient occlusion",
    about: "The part of directions, weighted by cosine, in which nothing is near. White is open.",
    needs: Needs {
        settings: &[Setting::Spawn, Setting::OcclusionDistance],
        ..Needs::LIGHTS
    },
    legend: Vec::new,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let point = ShadingPoint::unrepaired(context, ray, hit);
    let Some(ray) = point
        .open_direction(sampler)
        .and_then(|dir| point.spawn(dir))
    else {
        return Vec3::ZERO;
    };
    // The direction's length is 1 up to rounding.
    let distance = f64::from(context.lighting.ao_distance) * context.scene.bounds().radius();
    let t_max = (distance * 2f64.powi(-ray.scale)) as f32;
    if ray.t_min >= t_max {
        return Vec3::ONE;
    }
    Vec3::splat(transmittance(context, Ray { t_max, ..ray }))
}

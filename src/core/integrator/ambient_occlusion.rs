//! The view *Ambient occlusion*: how open surfaces are.
//!
//! Source: Zhukov, Iones, Kronin, "An Ambient Light Illumination Model", Rendering Techniques 1998.

use super::transport::ShadingPoint;
use super::visibility::transmittances;
use super::{Context, Integrator, Needs, Sample, Setting, Source};
use crate::ray::Ray;
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
    source: Source::Batch(radiances),
};

fn radiances(context: &Context, samples: &mut [Sample]) {
    let (mut rays, mut indices) = (Vec::new(), Vec::new());
    for (i, sample) in samples.iter_mut().enumerate() {
        match occlusion_ray(context, sample) {
            Ok(ray) => {
                rays.push(ray);
                indices.push(i);
            }
            Err(colour) => sample.radiance = colour,
        }
    }
    for (i, part) in indices.into_iter().zip(transmittances(context, &rays)) {
        samples[i].radiance = Vec3::splat(part);
    }
}

/// The ray that tests for occluders; as the error, the colour of a sample without such a ray.
fn occlusion_ray(context: &Context, sample: &mut Sample) -> Result<Ray, Vec3> {
    let hit = sample.hit.ok_or(context.background)?;
    let point = ShadingPoint::unrepaired(context, &sample.ray, hit);
    let dir = point.open_direction(&mut sample.sampler);
    let ray = dir.and_then(|dir| point.spawn(dir)).ok_or(Vec3::ZERO)?;
    // The direction's length is 1 up to rounding.
    let distance = f64::from(context.lighting.ao_distance) * context.scene.bounds().radius();
    let t_max = (distance * 2f64.powi(-ray.scale)) as f32;
    if ray.t_min >= t_max {
        return Err(Vec3::ONE);
    }
    Ok(Ray { t_max, ..ray })
}

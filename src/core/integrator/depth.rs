//! The view *Depth*.

use super::number::{DefaultRange, NumberView, Shown};
use super::{Context, Integrator, Needs, Setting, Source};
use crate::camera::Projection;
use crate::colour::GREY;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;

/// The row of the view.
pub(super) static DEPTH: Integrator = Integrator {
    name: "depth",
    title: "Depth",
    about: "Distance from the eye: white at the near side of the scene's bounding sphere, dark at the far side.",
    needs: Needs {
        settings: &[Setting::Scale],
        ..Needs::NOTHING
    },
    legend: Vec::new,
    source: Source::Number(NumberView {
        title: "Distance from the eye",
        unit: "",
        map: &GREY,
        range: DefaultRange::Of(far_to_near),
        is_logarithmic: false,
        shown,
    }),
};

fn shown(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Shown {
    hit.map_or(Shown::Colour(context.background), |hit| {
        Shown::Number(f64::from(hit.t) * ray.dir.as_dvec3().length())
    })
}

/// Distances from the eye, or from its plane, to the far and the near side of the scene's bounding sphere.
fn far_to_near(context: &Context) -> [f64; 2] {
    let (bounds, camera) = (context.scene.bounds(), &context.camera);
    let from_eye = bounds.centre().as_dvec3() - camera.eye().as_dvec3();
    let middle = match camera.projection() {
        Projection::Perspective { .. } => from_eye.length(),
        Projection::Orthographic { .. } => -from_eye.dot(camera.back()),
    };
    [
        middle + bounds.radius(),
        (middle - bounds.radius()).max(0.0),
    ]
}

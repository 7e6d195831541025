//! The view *Barycentric*.

use super::palette::named;
use super::{Context, Integrator, Legend, Needs, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::srgb::from_display;
use glam::Vec3;

/// The row of the view.
pub(super) static BARYCENTRIC: Integrator = Integrator {
    name: "barycentric",
    title: "Barycentric",
    about: "The barycentric coordinates of a triangle's corners as red, green, blue. On other shapes, the surface coordinates u and v, modulo 1, as red and green.",
    needs: Needs::NOTHING,
    legend,
    source: Source::Colour(radiance),
};

/// Barycentric coordinates on triangles, u and v modulo 1 on other shapes.
fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    hit.map_or(context.background, |hit| {
        from_display(if context.scene.is_triangle(hit.primitive) {
            Vec3::from_array(hit.barycentric())
        } else {
            let uv = context.scene.surface(ray, &hit).uv;
            let [u, v] = uv.to_array().map(|x| x.rem_euclid(1.0) as f32);
            Vec3::new(u, v, 0.0)
        })
    })
}

fn legend() -> Legend {
    vec![
        vec![
            named(Vec3::X, "A"),
            named(Vec3::Y, "B"),
            named(Vec3::Z, "C of a triangle"),
        ],
        vec![named(Vec3::X, "u"), named(Vec3::Y, "v of other shapes")],
    ]
}

//! A unit sphere rests on a plane: at the distance x from the contact, the plane is open to 1 − (1 + x²)^(−3/2).

use super::{Estimate, lit, path_count};
use glam::Vec3;
use hitscope_core::light::{Environment, Light};
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::scene::{SceneOptions, scene};
use hitscope_core::shape::{Plane, Sphere};
use hitscope_core::{Ray, Scene, TriangleMesh};

/// A white plane and a black sphere of radius `r` on it, which emits light.
pub fn ball_on_plane(r: f32, emission: Vec3) -> Scene {
    let grey = |x, emission| Material {
        diffuse: Some(Vec3::splat(x)),
        emission,
        ..Material::default()
    };
    let attributes = Attributes {
        materials: Assigned::new(
            vec![grey(1.0, Vec3::ZERO), grey(0.0, emission)],
            Runs::default(),
        ),
        ..Attributes::default()
    };
    let mut scene = scene(TriangleMesh::default().with_attributes(attributes));
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let plane = Plane {
        point: Vec3::ZERO,
        normal: Vec3::Z,
    };
    let added = scene.add_group(vec![plane], Runs::default(), options, &progress);
    added.expect("nobody cancels");
    let ball = Sphere {
        centre: Vec3::new(0.0, 0.0, r),
        radius: r,
    };
    let mut black = Runs::default();
    black.begin(0, 1);
    let added = scene.add_group(vec![ball], black, options, &progress);
    added.expect("nobody cancels");
    scene
}

#[test]
fn the_plane_under_a_sphere_is_as_open_as_the_closed_form_says() {
    for size in [1e-6, 1.0, 1e6] {
        let sky = Light::Environment(Environment::Constant(Vec3::ONE));
        let mut context = lit(ball_on_plane(size, Vec3::ZERO), vec![sky]);
        context.lighting.ao_distance = f32::INFINITY;
        for x in [0.1f32, 0.3, 1.0, 3.0, 10.0] {
            let at = Vec3::new(x * size, 0.0, 0.0);
            // From below the sphere.
            let ray = Ray::new(at + 1e-3 * size * Vec3::Z, Vec3::NEG_Z);
            let ray = ray.expect("a ray");
            let open = 1.0 - (1.0 + f64::from(x).powi(2)).powf(-1.5);
            eprintln!("size {size:e}, x = {x}");
            Estimate::of_ray(&context, "path", path_count(), ray).require(open);
            Estimate::of_ray(&context, "direct", path_count(), ray).require(open);
            Estimate::of_ray(&context, "whitted", path_count(), ray).require(open);
            Estimate::of_ray(&context, "ao", path_count(), ray).require(open);
        }
    }
}

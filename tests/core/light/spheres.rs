//! A plane under a sphere of radiance 1 that rests on it: at the distance x from the contact, in radii, a white surface
//! reflects the radiance (1 + x²)^(−3/2).

use super::openness::ball_on_plane;
use super::{Estimate, lit, path_count};
use glam::{UVec2, Vec2, Vec3};
use hitscope_core::Ray;
use hitscope_core::sampler::Sampler;
use std::f64::consts::TAU;

/// The ray that sees the plane at a distance x from the contact, from below the sphere.
fn ray_at(x: f32, size: f32) -> Ray {
    let at = Vec3::new(x * size, 0.0, 0.0);
    let ray = Ray::new(at + 1e-3 * size * Vec3::Z, Vec3::NEG_Z);
    ray.expect("a ray")
}

#[test]
fn a_plane_under_a_bright_sphere_receives_its_form_factor() {
    for size in [1e-6, 1.0, 1e6] {
        let context = lit(ball_on_plane(size, Vec3::ONE), Vec::new());
        for x in [0.1f32, 0.3, 1.0, 3.0, 10.0] {
            let expected = (1.0 + f64::from(x).powi(2)).powf(-1.5);
            eprintln!("size {size:e}, x = {x}");
            for view in ["direct", "path"] {
                let ray = ray_at(x, size);
                Estimate::of_ray(&context, view, path_count(), ray).require(expected);
            }
        }
    }
}

#[test]
fn only_the_visible_part_of_a_sphere_is_sampled() {
    let context = lit(ball_on_plane(1.0, Vec3::ONE), Vec::new());
    let n = path_count();
    let estimate = Estimate::of_ray(&context, "direct", n, ray_at(10.0, 1.0));
    let deviation = estimate.error * f64::from(n).sqrt() / estimate.mean;
    // Uniform directions: the cosine is uniform over a disk that touches the horizon, so its standard deviation is half of
    // its mean. Uniform points: the back isn't lit, and the front by its cosine, at least √(8/3 − 1) = 1.29.
    assert!(deviation < 0.7, "{deviation}");
}

#[test]
fn the_density_of_a_sphere_is_that_of_its_samples() {
    for size in [1e-6, 1.0, 1e6] {
        let scene = ball_on_plane(size, Vec3::ONE);
        let (ball, centre) = (1, size * Vec3::Z);
        let outside = size * Vec3::new(3.0, 0.0, 1.0);
        let density = scene
            .density_from(ball, outside)
            .expect("uniform directions");
        // sin θ = 1/3.
        let expected = 1.0 / (TAU * (1.0 - (8.0f64 / 9.0).sqrt()));
        // The centre and the point are rounded to f32.
        assert!((density / expected - 1.0).abs() < 1e-6, "{density}");
        for inside in [
            centre,
            centre + 0.5 * size * Vec3::X,
            centre + size * Vec3::X,
        ] {
            assert_eq!(scene.density_from(ball, inside), None, "{inside}");
        }
        let context = lit(scene, Vec::new());
        let lights = &context.lighting.lights;
        for k in 0..1000 {
            let mut sampler = Sampler::new(UVec2::new(k, 1), 0);
            let at: Vec2 = sampler.next_2d();
            let sample = lights.sample(
                &context.scene,
                context.lighting.spawn,
                outside,
                at,
                sampler.next_1d(),
            );
            let sample = sample.expect("the sphere is visible");
            // Directions are rounded, so that a ray at the edge may miss.
            if at.x < 0.999 {
                let ray = Ray::new(outside, sample.dir).expect("a ray");
                let hit = context.intersector.closest_hit(&ray).expect("a hit");
                let of_hit = lights.density_of_hit(&context.scene, outside, &ray, &hit);
                assert_eq!(Some(of_hit), sample.density);
            }
        }
    }
}

//! The recorded path of a sample has the sample's colour in the picture.

use crate::golden;
use glam::{UVec2, Vec3};
use hitscope_core::Scene;
use hitscope_core::camera::Projection;
use hitscope_core::integrator::{INTEGRATORS, PathEnd, PathRecord, PathVertex, Sample};
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::light::{DirectionalLight, Environment, Light, Lights};
use hitscope_core::mesh::shapes::{Placement, torus};
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::plan::Plan;
use hitscope_core::render::{Job, render};
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::{Shading, scene};
use std::sync::Arc;

const SIZE: UVec2 = UVec2::new(48, 40);

/// A torus of which three quarters are there, which emits and scatters light. Paths that get inside are long.
fn porous_torus() -> Scene {
    let material = Material {
        diffuse: Some(Vec3::new(0.9, 0.95, 0.8)),
        emission: Vec3::new(0.01, 0.02, 0.03),
        opacity: 0.75,
        ..Material::default()
    };
    scene(torus(24, 12, Placement::UNIT).with_attributes(Attributes {
        materials: Assigned::new(vec![material], Runs::default()),
        ..Attributes::default()
    }))
}

fn job(view: &str, samples: u32, has_sky: bool) -> Job {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    let plan = Plan::new(SIZE, 4, samples);
    let mut job = golden::job(view, Shading::Smooth, projection, plan);
    let context = &mut job.context;
    context.scene = Arc::new(porous_torus());
    context.intersector = Arc::from(context.scene.intersector(default_triangle_kernel()));
    context.second = Arc::clone(&context.intersector);
    let mut others = vec![Light::Directional(DirectionalLight {
        to_light: Vec3::new(0.6, 0.0, 0.8),
        irradiance: Vec3::new(1.5, 1.4, 1.2),
    })];
    if has_sky {
        let sky = Environment::Constant(Vec3::new(0.3, 0.4, 0.5));
        others.push(Light::Environment(sky));
    }
    context.lighting.lights = Arc::new(Lights::new(&context.scene, others));
    job
}

fn pixels() -> impl Iterator<Item = UVec2> {
    (0..SIZE.element_product()).map(|k| UVec2::new(k % SIZE.x, k / SIZE.x))
}

fn record(job: &Job, pixel: UVec2, sample: u32) -> PathRecord {
    let record = job.integrator.record(&job.context, pixel, sample);
    record.expect("the view follows paths")
}

/// The film's number, which drops digits below 2⁻⁶⁴.
fn fixed(x: f32) -> f64 {
    let one = 2f64.powi(64);
    (f64::from(x) * one) as u128 as f64 / one
}

#[test]
fn a_recorded_path_has_the_colour_of_its_sample_bit_for_bit() {
    for view in ["direct", "path"] {
        for has_sky in [false, true] {
            let job = job(view, 1, has_sky);
            let film = render(job.clone(), 2).expect("no panic");
            for pixel in pixels() {
                let radiance = record(&job, pixel, 0).radiance;
                let expected = radiance.to_array().map(|x| fixed(x) as f32);
                let found = film.radiance(pixel).expect("a sample").to_array();
                assert_eq!(found, expected, "{view} {pixel}");
            }
        }
    }
}

#[test]
fn samples_of_a_batch_are_bit_identical_to_single_samples() {
    for view in INTEGRATORS {
        let job = job(view.name, 1, true);
        let context = &job.context;
        let sample = |pixel| {
            let ray = context.camera.ray(pixel, Plan::position(pixel, 1));
            let hit = context.intersector.closest_hit(&ray);
            Sample::new(ray, hit, Sampler::new(pixel, 1))
        };
        let mut together: Vec<Sample> = pixels().map(sample).collect();
        view.radiances(context, &mut together);
        for (pixel, found) in pixels().zip(together) {
            let Sample {
                ray,
                hit,
                mut sampler,
                ..
            } = sample(pixel);
            let alone = view.radiance(context, &ray, hit, &mut sampler);
            let bits = |colour: Vec3| colour.to_array().map(f32::to_bits);
            assert_eq!(bits(found.radiance), bits(alone), "{} {pixel}", view.name);
        }
    }
}

#[test]
fn the_mean_of_recorded_paths_is_the_pictures() {
    let job = job("path", 8, true);
    let film = render(job.clone(), 2).expect("no panic");
    for pixel in pixels() {
        let mut sum = [0.0; 3];
        for sample in 0..8 {
            let radiance = record(&job, pixel, sample).radiance.to_array();
            sum = std::array::from_fn(|k| sum[k] + fixed(radiance[k]));
        }
        let found = film.radiance(pixel).expect("samples").to_array();
        for (found, sum) in found.into_iter().zip(sum) {
            // Sums in f64 round at 2⁻⁵³, the film's mean once to f32.
            let error = (f64::from(found) - sum / 8.0).abs();
            assert!(error <= sum / 8.0 * 2f64.powi(-23), "{pixel}");
        }
    }
}

#[test]
fn the_light_of_a_recorded_path_adds_up_to_its_colour() {
    for view in ["direct", "path"] {
        let job = job(view, 1, true);
        for pixel in pixels() {
            let record = record(&job, pixel, 3);
            let at_surface = |vertex: &PathVertex| [vertex.emission, vertex.direct];
            let light = record.vertices.iter().flat_map(at_surface);
            let sum = light.fold(Vec3::ZERO, |sum, light| sum + light);
            assert_eq!(sum + record.from_afar, record.radiance, "{view} {pixel}");
        }
    }
}

#[test]
fn recorded_vertices_lie_along_the_path() {
    let job = job("path", 1, true);
    let (mut passed, mut dimmed, mut ends) = (0, 0, Vec::new());
    for pixel in pixels() {
        let record = record(&job, pixel, 1);
        let mut from = record.origin;
        let mut throughput = Vec3::ONE;
        for vertex in &record.vertices {
            // Spawned rays have unit directions up to rounding, and start near the surface.
            let way = (vertex.position - from).length();
            assert!((way - vertex.t).abs() < 1e-4, "{way} {vertex:?}");
            if vertex.is_passed {
                passed += 1;
                assert_eq!(vertex.throughput, throughput);
                assert_eq!([vertex.emission, vertex.direct], [Vec3::ZERO; 2]);
            }
            if let Some(ray) = vertex.shadow_ray {
                // Each surface in the way lets a quarter of the light pass.
                let surfaces = (-0.5 * ray.arriving.log2()).round();
                assert_eq!(ray.arriving, 0.25f32.powi(surfaces as i32));
                dimmed += u32::from(surfaces > 0.0);
            }
            (from, throughput) = (vertex.position, vertex.throughput);
        }
        let last = record.vertices.last();
        let is_over = last.is_none_or(|vertex| vertex.throughput == Vec3::ZERO);
        let is_inside = record.end != PathEnd::Left && record.end != PathEnd::Overflow;
        assert!(is_over || !is_inside, "{record:?}");
        ends.push(record.end);
    }
    assert!(passed > 0 && dimmed > 0, "{passed} {dimmed}");
    for end in [PathEnd::Left, PathEnd::RussianRoulette] {
        assert!(ends.contains(&end), "{end:?}");
    }
}

#[test]
fn only_views_that_follow_paths_record_them() {
    for view in INTEGRATORS {
        let expected = ["direct", "path"].contains(&view.name);
        assert_eq!(view.follows_paths(), expected, "{}", view.name);
        let job = golden::job(
            view.name,
            Shading::Flat,
            Projection::Orthographic { height: 2.5 },
            Plan::new(SIZE, 1, 1),
        );
        let record = view.record(&job.context, UVec2::ZERO, 0);
        assert_eq!(record.is_some(), expected, "{}", view.name);
    }
}

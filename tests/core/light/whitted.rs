//! The view *Recursive* against closed forms, and against paths where all surfaces are smooth.

use super::lamps::{loaded, radiance};
use super::{Estimate, lit, path_count};
use glam::{DVec3, UVec2};
use hitscope_core::Ray;
use hitscope_core::integrator::{Context, integrator};
use hitscope_core::sampler::Sampler;
use std::sync::Arc;

/// A branch ends when it carries less light than this.
const INVISIBLE: f64 = 1.0 / 512.0;

fn context(contents: &str) -> Context {
    let loaded = loaded(contents);
    assert_eq!(loaded.report.warnings, [], "{contents}");
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    lit(scene, loaded.lights)
}

fn ray(origin: DVec3, dir: DVec3) -> Ray {
    Ray::new(origin.as_vec3(), dir.as_vec3()).expect("a ray")
}

/// A square emitter of this radiance that reflects nothing, transformed.
fn emitter(radiance: &str, transform: &str) -> String {
    format!(
        r#"<shape type="rectangle"><transform name="to_world">{transform}</transform>
             <bsdf type="diffuse"><rgb name="reflectance" value="0 0 0"/></bsdf>
             <emitter type="area"><rgb name="radiance" value="{radiance}"/></emitter></shape>"#
    )
}

/// The part of light that an interface of relative index `eta` reflects, by Fresnel's equations in terms of both angles.
fn fresnel(sin: f64, eta: f64) -> f64 {
    let (a, b) = (sin.asin(), (sin / eta).asin());
    if sin == 0.0 {
        return ((eta - 1.0) / (eta + 1.0)).powi(2);
    }
    let perpendicular = (a - b).sin() / (a + b).sin();
    let parallel = (a - b).tan() / (a + b).tan();
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// A mirror in the plane z = 0, under an emitter that a ray from the left meets after it.
fn mirror() -> (Context, Ray) {
    let mirror = r#"<shape type="rectangle"><bsdf type="conductor">
                      <rgb name="specular_reflectance" value="0.5 0.25 1"/></bsdf></shape>"#;
    let above = r#"<rotate y="1" angle="180"/><translate x="5" z="5"/>"#;
    let context = context(&format!("{mirror}{}", emitter("2 3 4", above)));
    let ray = ray(DVec3::new(-1.0, 0.0, 1.0), DVec3::new(1.0, 0.0, -1.0));
    (context, ray)
}

#[test]
fn a_mirror_shows_the_emitter_times_its_reflectance_after_one_surface() {
    let (mut context, ray) = mirror();
    let found = radiance(&context, "whitted", &ray).expect("a hit");
    // Fresnel's equations take fewer than 16 roundings.
    let error = (found - DVec3::new(1.0, 0.75, 4.0)).abs().max_element();
    assert!(error < 4.0 * 16.0 / f64::from(1 << 24), "{found}");
    context.lighting.depth_limit = Some(0);
    assert_eq!(radiance(&context, "whitted", &ray), Some(DVec3::ZERO));
    context.lighting.depth_limit = Some(1);
    assert_eq!(radiance(&context, "whitted", &ray), Some(found));
}

#[test]
fn a_mirror_reflects_about_the_normal_that_a_texture_tilts() {
    // Everywhere the normal (0.6, 0, 0.8).
    let mirror = r#"<shape type="rectangle"><bsdf type="normalmap"><bsdf type="conductor"/>
                      <texture name="normalmap" type="checkerboard">
                        <rgb name="color0" value="0.8 0.5 0.9"/><rgb name="color1" value="0.8 0.5 0.9"/>
                      </texture></bsdf></shape>"#;
    // Where the reflected ray goes, along (0.96, 0, 0.28).
    let beside = r#"<rotate y="1" angle="-90"/><translate x="4.8" z="1.4"/>"#;
    let context = context(&format!("{mirror}{}", emitter("1 1 1", beside)));
    let down = ray(DVec3::new(0.1, 0.2, 1.0), DVec3::NEG_Z);
    // Facets shadow each other, by the squared tangents of the tilt and of the reflected ray.
    let (of_tilt, of_ray) = ((0.6f64 / 0.8).powi(2), (0.96f64 / 0.28).powi(2));
    let expected = 2.0 / (1.0 + (1.0 + 0.125 * of_tilt * of_ray).sqrt());
    for view in ["whitted", "path"] {
        let found = radiance(&context, view, &down).expect("a hit").y;
        // The cosine 0.28 is rounded as numbers of size 1 are, about ten times, and enters squared.
        let bound = 2.0 * 10.0 / 0.28 / f64::from(1 << 24);
        assert!(
            (found - expected).abs() < bound,
            "{view}: {found} {expected}"
        );
    }
}

/// A plate of glass in the plane z = 0 with half this thickness.
fn plate(half: f64) -> String {
    format!(
        r#"<shape type="cube"><transform name="to_world"><scale x="10" y="10" z="{half}"/></transform>
             <bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf></shape>"#
    )
}

#[test]
fn a_plate_of_glass_transmits_the_series_of_its_inner_reflections_as_paths_do() {
    let below = r#"<scale value="100"/><translate z="-5"/>"#;
    let context = context(&format!("{}{}", plate(0.01), emitter("1 1 1", below)));
    for degrees in [0.0, 45.0, 80.0f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let dir = DVec3::new(sin, 0.0, -cos);
        let ray = ray(DVec3::new(0.1, 0.2, 0.01) - dir, dir);
        let r = fresnel(sin, 1.5);
        let expected = (1.0 - r) / (1.0 + r);
        let found = radiance(&context, "whitted", &ray).expect("a hit").y;
        // The branch inside ends, and before it at most two that leave the plate.
        let bound = 3.0 * INVISIBLE;
        assert!(
            (found - expected).abs() < bound,
            "{degrees}°: {found} {expected}"
        );
        let paths = Estimate::of_ray(&context, "path", path_count(), ray);
        paths.require(expected);
        assert!(
            (found - paths.mean).abs() < bound + 4.0 * paths.error,
            "{degrees}°"
        );
    }
}

#[test]
fn total_reflection_loses_no_light_and_glass_holds_the_square_of_its_index_more() {
    let beyond = r#"<scale value="50"/><rotate y="1" angle="-90"/><translate x="10.5"/>"#;
    let context = context(&format!("{}{}", plate(0.5), emitter("1 1 1", beyond)));
    // 60° from the normal of the plate, beyond the critical angle of 41.8°, and 30° from that of its edge.
    let dir = DVec3::new(60f64.to_radians().sin(), 0.0, 0.5);
    let ray = ray(DVec3::new(0.0, 0.1, 0.1), dir);
    // The edges reflect a part r to each other, and let the rest pass: (1 − r)(1 + r² + …).
    let expected = 1.5 * 1.5 / (1.0 + fresnel(0.5, 1.0 / 1.5));
    let found = radiance(&context, "whitted", &ray).expect("a hit").y;
    // One branch ends between the edges.
    assert!(
        (found - expected).abs() < 1.5 * 1.5 * INVISIBLE,
        "{found} {expected}"
    );
    Estimate::of_ray(&context, "path", path_count(), ray).require(expected);
}

#[test]
fn opposite_mirrors_and_layers_with_coverage_end() {
    let mirror = |turn: &str| {
        format!(
            r#"<shape type="rectangle"><transform name="to_world">{turn}</transform><bsdf type="conductor"/></shape>"#
        )
    };
    let facing = mirror(r#"<rotate y="1" angle="180"/><translate z="1"/>"#);
    let mask = r#"<shape type="rectangle"><transform name="to_world"><translate z="0.5"/></transform>
                    <bsdf type="mask"><float name="opacity" value="0"/><bsdf type="diffuse"/></bsdf></shape>"#;
    let context = context(&format!("{}{facing}{mask}", mirror("")));
    let down = ray(DVec3::new(0.1, 0.2, 0.75), DVec3::NEG_Z);
    assert_eq!(radiance(&context, "whitted", &down), Some(DVec3::ZERO));
}

#[test]
fn a_layer_with_coverage_lets_the_rest_of_the_light_pass() {
    let mask = r#"<shape type="rectangle"><transform name="to_world"><translate z="0.5"/></transform>
                    <bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="conductor"/></bsdf></shape>"#;
    let context = context(&format!("{mask}{}", emitter("1 2 3", "")));
    let down = ray(DVec3::new(0.1, 0.2, 0.75), DVec3::NEG_Z);
    let found = radiance(&context, "whitted", &down);
    assert_eq!(found, Some(0.75 * DVec3::new(1.0, 2.0, 3.0)));
}

#[test]
fn lights_without_extent_need_no_random_numbers() {
    let lights = r#"<emitter type="point"><point name="position" x="0" y="1" z="2"/><rgb name="intensity" value="1 2 3"/></emitter>
                    <emitter type="directional"><vector name="direction" value="0.5, 0, -1"/><rgb name="irradiance" value="1 1 1"/></emitter>"#;
    let context = context(&format!(r#"<shape type="rectangle"/>{lights}"#));
    let ray = ray(DVec3::new(0.1, 0.2, 1.0), DVec3::NEG_Z);
    let view = integrator("whitted").expect("a view");
    let hit = context.intersector.closest_hit(&ray);
    let of_sample = |sample| {
        let mut sampler = Sampler::new(UVec2::new(3, 5), sample);
        view.radiance(&context, &ray, hit, &mut sampler)
    };
    let first = of_sample(0);
    assert!(first.min_element() > 0.0);
    assert!((1..10).all(|sample| of_sample(sample) == first));
    let paths = Estimate::of_ray(&context, "direct", path_count(), ray);
    paths.require(first.y.into());
}

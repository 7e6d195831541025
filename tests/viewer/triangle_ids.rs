//! Comparison of rasterized and traced triangles, pixel by pixel.
//!
//! The rasterizer draws triangle numbers with the overlay's view; they are compared with the triangles that the
//! renderer's rays hit. They may differ only where a pixel's centre lies on an edge: GPUs snap
//! vertices to a grid of 1/256 pixel.

use crate::harness::{gpu, say};
use glam::{DVec2, DVec3, UVec2, Vec2};
use hitscope::document::embedded_scene;
use hitscope::gpu::adapter::Gpu;
use hitscope::gpu::rasterizer::Rasterizer;
use hitscope::gpu::view::ViewUniform;
use hitscope_core::Scene;
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::kernel::triangle_kernel;
use hitscope_core::obj::{LoadOptions, parse};
use hitscope_core::progress::Progress;
use std::path::Path;

const SIZE: UVec2 = UVec2::new(768, 480);
/// Vertices snap to 1/256 pixel on each axis; an edge moves by up to twice that, plus rounding in f32.
const ON_EDGE_PX: f64 = 4.0 / 256.0;

/// A bumpy closed surface far from the origin.
fn far_blob() -> Scene {
    const RINGS: u32 = 60;
    let mut text = String::new();
    for i in 0..RINGS {
        for k in 0..RINGS {
            let (u, v) = (f64::from(i) * 0.1047, f64::from(k) * 0.1047);
            let r = 1.0 + 0.35 * v.cos() + 0.08 * (5.0 * u).sin() * (4.0 * v).cos();
            let p = [2e6 + r * u.cos(), -7e5 + r * u.sin(), 0.4 * v.sin()];
            text += &format!("v {} {} {}\n", p[0], p[1], p[2]);
        }
    }
    let at = |i: u32, k: u32| i % RINGS * RINGS + k % RINGS + 1;
    for i in 0..RINGS {
        for k in 0..RINGS {
            let quad = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
            text += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    let progress = Progress::default();
    let library = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let loaded = parse(
        text.as_bytes(),
        Path::new("blob"),
        LoadOptions::default(),
        &library,
        &progress,
    );
    Scene::new(loaded.expect("good").mesh, &progress).expect("never cancelled")
}

/// A camera for an overview, one close to the surface, and an orthographic one.
fn cameras(scene: &Scene) -> [Camera; 3] {
    let (middle, r) = (scene.bounds().centre().as_dvec3(), scene.bounds().radius());
    let perspective = Projection::Perspective { fov_y_radians: 0.7 };
    let orthographic = Projection::Orthographic { height: 1.7 * r };
    [
        (DVec3::new(1.3, 1.1, 2.4), DVec3::ZERO, perspective),
        (
            DVec3::new(-0.7, 0.5, 0.9),
            DVec3::new(0.1, 0.1, 0.0),
            perspective,
        ),
        (DVec3::new(2.0, 1.5, -1.7), DVec3::ZERO, orthographic),
    ]
    .map(|(eye, target, projection)| {
        let (eye, target) = (middle + r * eye, middle + r * target);
        Camera::look_at(eye, target, DVec3::Y, projection, SIZE).expect("good")
    })
}

/// The number of the triangle drawn at each pixel, counted from 1; 0 for none.
fn rasterized(rasterizer: &Rasterizer, scene: &Scene, camera: &Camera) -> Vec<u32> {
    let mesh = rasterizer.upload(scene).expect("small");
    let view = ViewUniform::new(camera, &scene.bounds());
    let pixels = rasterizer.draw(&mesh, &view).expect("drawn");
    pixels.into_iter().map(|pixel| pixel.triangle).collect()
}

/// The smallest distance from a pixel's centre to an edge of a triangle (counted from 1).
fn distance_to_edge(scene: &Scene, camera: &Camera, pixel: UVec2, id: u32) -> f64 {
    let Some(triangle) = id.checked_sub(1) else {
        return f64::INFINITY;
    };
    let corners = scene
        .mesh()
        .corners(triangle)
        .map(|p| camera.pixel_of(p.as_dvec3()));
    let [Some(a), Some(b), Some(c)] = corners else {
        return f64::INFINITY;
    };
    let centre = pixel.as_dvec2() + 0.5;
    let to_segment = |(p, q): (DVec2, DVec2)| {
        let along = q - p;
        let part = ((centre - p).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (centre - p - part * along).length()
    };
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(to_segment)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn rasterized_triangles_are_the_triangles_that_rays_hit() {
    let Some(Gpu { device, queue, .. }) = gpu() else {
        return;
    };
    let rasterizer = Rasterizer::new(device, queue);
    let embedded = embedded_scene().scene;
    let blob = far_blob();
    for (name, scene) in [("embedded", &*embedded), ("far blob", &blob)] {
        let intersector = scene.intersector(triangle_kernel("watertight").expect("in the table"));
        for (view, camera) in cameras(scene).into_iter().enumerate() {
            let drawn = rasterized(&rasterizer, scene, &camera);
            let (mut covered, mut different) = (0, 0);
            for (i, drawn) in drawn.into_iter().enumerate() {
                let pixel = UVec2::new(i as u32 % SIZE.x, i as u32 / SIZE.x);
                let ray = camera.ray(pixel, Vec2::splat(0.5));
                let traced = intersector
                    .closest_hit(&ray)
                    .map_or(0, |hit| hit.primitive + 1);
                covered += u32::from(drawn != 0 || traced != 0);
                if drawn != traced {
                    different += 1;
                    let near = |id| distance_to_edge(scene, &camera, pixel, id);
                    let distance = near(drawn).min(near(traced));
                    assert!(
                        distance < ON_EDGE_PX,
                        "{name}, view {view}, pixel {pixel}: {drawn} drawn, {traced} traced, {distance} px from an edge"
                    );
                }
            }
            say(&format!(
                "{name}, view {view}: {different} of {covered} covered pixels differ"
            ));
            assert!(
                covered > SIZE.element_product() / 10,
                "{name}, view {view}: {covered}"
            );
            assert!(
                different * 1000 <= covered,
                "{name}, view {view}: {different} of {covered}"
            );
        }
    }
}

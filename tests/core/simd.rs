//! Every SIMD level, single rays and packets: bit-identical results.

use glam::{DVec3, UVec2, Vec2};
use hitscope_core::camera::Projection;
use hitscope_core::intersector::Intersector;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::shapes::{Placement, sphere, torus};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::simd::SimdLevel;
use hitscope_core::{Camera, Hit, Ray, Scene};

/// A hit's bits, which distinguish −0 from 0 and compare NaN equal to itself.
pub fn bits(hit: &Option<Hit>) -> Option<[u32; 4]> {
    hit.map(|h| [h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.primitive])
}

/// A camera's rays, in blocks of 4 × 4 pixels.
fn camera_rays(eye: DVec3, projection: Projection) -> Vec<Ray> {
    let size = UVec2::splat(64);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
    let camera = camera.expect("a camera");
    let block = |k: u32| UVec2::new(k % 16, k / 16) * 4;
    let pixel = |k: u32| UVec2::new(k % 4, k / 4);
    (0..256)
        .flat_map(|b| (0..16).map(move |p| block(b) + pixel(p)))
        .map(|p| camera.ray(p, Vec2::splat(0.5)))
        .collect()
}

/// Incoherent rays, many along edges: from all sides to vertices, and from vertices to vertices.
fn scattered_rays(scene: &Scene) -> Vec<Ray> {
    let mut random = Random::new(7);
    let positions = scene.mesh().positions();
    let rays = (0..4000).filter_map(|k| {
        let target = positions[random.index(positions.len())];
        let origin = if k % 4 == 0 {
            positions[random.index(positions.len())]
        } else {
            (3.0 * random.in_cube()).as_vec3()
        };
        Ray::new(origin, target - origin).ok()
    });
    rays.collect()
}

fn workloads(scene: &Scene) -> Vec<Vec<Ray>> {
    let perspective = Projection::Perspective { fov_y_radians: 0.8 };
    let parallel = Projection::Orthographic { height: 3.0 };
    let mut ended = camera_rays(DVec3::new(1.5, 2.0, 2.5), perspective);
    for (k, ray) in ended.iter_mut().enumerate() {
        // Intervals end before the mesh or in it, or start in it; a few rays exclude a triangle.
        (ray.t_min, ray.t_max) = ([0.0, 0.0, 2.0][k % 3], [1.0, 3.0, 9.0][k / 3 % 3]);
        ray.exclude = (k % 1000 == 0).then_some(3);
    }
    vec![
        camera_rays(DVec3::new(1.5, 2.0, 2.5), perspective),
        // Inside a closed mesh, and along an axis, where directions contain zeros of either sign.
        camera_rays(DVec3::new(0.1, -0.2, 0.9), perspective),
        camera_rays(DVec3::Z * 4.0, parallel),
        scattered_rays(scene),
        ended,
    ]
}

#[test]
fn every_level_gives_the_scalar_levels_bits_for_single_rays_and_packets() {
    for scene in [
        scene(torus(48, 24, Placement::UNIT)),
        scene(sphere(12, Placement::UNIT)),
    ] {
        let workloads = workloads(&scene);
        for kernel in TRIANGLE_KERNELS.iter() {
            let levels = SimdLevel::available();
            let at = |level: &SimdLevel| scene.intersector_at(kernel, *level);
            let intersectors: Vec<Box<dyn Intersector>> = levels.iter().map(at).collect();
            for (k, rays) in workloads.iter().enumerate() {
                let mut expected = vec![None; rays.len()];
                intersectors[0].closest_hits(rays, &mut expected);
                let mut is_hit = vec![false; rays.len()];
                intersectors[0].any_hits(rays, &mut is_hit);
                for (level, intersector) in levels.iter().zip(&intersectors) {
                    let place = format!("{} at {}, rays {k}", kernel.info.name, level.name());
                    let mut hits = vec![None; rays.len()];
                    intersector.closest_hits(rays, &mut hits);
                    assert!(
                        hits.iter().map(bits).eq(expected.iter().map(bits)),
                        "{place}"
                    );
                    let mut together = vec![None; rays.len()];
                    intersector.coherent_hits(rays, &mut together);
                    let differs = |i: &usize| bits(&together[*i]) != bits(&expected[*i]);
                    let first = (0..rays.len()).find(differs);
                    assert_eq!(first, None, "together, {place}");
                    let mut any = vec![false; rays.len()];
                    intersector.any_hits(rays, &mut any);
                    assert!(any == is_hit, "any, {place}");
                    any.fill(false);
                    intersector.coherent_any_hits(rays, &mut any);
                    assert!(any == is_hit, "any together, {place}");
                }
            }
        }
    }
}

#[test]
fn three_kernels_trace_coherent_rays_in_packets_of_16() {
    let scene = scene(torus(48, 24, Placement::UNIT));
    let together = TRIANGLE_KERNELS
        .iter()
        .map(|kernel| scene.intersector(kernel).rays_together());
    assert_eq!(
        together.filter(|&count| count == 16).count(),
        3,
        "fast, watertight and exact"
    );
}

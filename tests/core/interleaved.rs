//! In trees larger than the caches, interleaved rays are bit-identical to single rays.

use crate::simd::bits;
use glam::Vec3;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::shapes::{Placement, torus};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::simd::SimdLevel;
use hitscope_core::{Ray, Scene};

/// Rays are interleaved in trees whose packed primitives exceed this number of bytes.
const LARGE: usize = 8 << 20;

/// Rays through the scene. Some exclude a triangle, start behind their origin, or end soon.
fn rays(scene: &Scene, count: usize) -> Vec<Ray> {
    let mut random = Random::new(41);
    let positions = scene.mesh().positions();
    let ray = |k: usize| {
        let origin = 2.0 * random.in_cube_f32();
        let through = positions[random.index(positions.len())] + 0.1 * random.in_cube_f32();
        let dir = through - origin;
        let interval = match k % 7 {
            3 => [-1.0, f32::MAX],
            5 => [0.0, 0.9],
            _ => [0.0, f32::MAX],
        };
        let mut ray = Ray::with_interval(origin, dir, interval[0], interval[1]).expect("a ray");
        ray.exclude = (k % 3 == 1).then(|| random.index(positions.len()) as u32);
        ray
    };
    (0..count).map(ray).collect()
}

#[test]
fn interleaved_rays_have_the_hits_of_single_rays() {
    let scene = scene(torus(500, 320, Placement::UNIT));
    let rays = rays(&scene, 3000);
    for kernel in TRIANGLE_KERNELS.iter().filter(|k| k.info.tier.is_some()) {
        for level in SimdLevel::available() {
            let name = format!("{} {}", kernel.info.name, level.name());
            let intersector = scene.intersector_at(kernel, level);
            assert!(intersector.bytes() > LARGE, "{name}");
            let mut hits = vec![None; rays.len()];
            let mut any = vec![false; rays.len()];
            // Batches with fewer rays than interleaved walks, and with more.
            for count in [1, 7, 8, 9, 3000] {
                intersector.closest_hits(&rays[..count], &mut hits[..count]);
                intersector.any_hits(&rays[..count], &mut any[..count]);
                for (ray, (hit, any)) in rays[..count].iter().zip(hits.iter().zip(&any)) {
                    let (alone, _) = intersector.closest_hit_with_cost(ray);
                    assert_eq!(bits(hit), bits(&alone), "{name} {ray:?}");
                    assert_eq!(*any, alone.is_some(), "{name} any {ray:?}");
                }
            }
            let count = hits.iter().flatten().count();
            assert!((1000..2900).contains(&count), "{name}: {count} hits");
        }
    }
}

#[test]
fn a_batch_without_rays_has_no_hits() {
    let scene = scene(torus(500, 320, Placement::UNIT));
    let kernel = TRIANGLE_KERNELS.iter().find(|k| k.info.tier.is_some());
    let intersector = scene.intersector(kernel.expect("a tier"));
    intersector.closest_hits(&[], &mut []);
    intersector.any_hits(&[], &mut []);
    let behind = Ray::with_interval(Vec3::ZERO, Vec3::X, -2.0, -1.0).expect("a ray");
    let mut hits = [None; 9];
    intersector.closest_hits(&[behind; 9], &mut hits);
    assert_eq!(hits, [intersector.closest_hit_with_cost(&behind).0; 9]);
}

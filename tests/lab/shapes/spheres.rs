//! Spheres that are small and far away, and spheres of extreme size.

use super::ray_count;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::kernel::{KernelTable, SPHERE_KERNELS, Tier};
use hitscope_core::random::Random;
use hitscope_core::shape::Sphere;
use hitscope_lab::measure::shapes::{Aim, aimed};
use hitscope_lab::oracle::Oracle as _;

#[test]
fn the_stable_kernel_in_f64_decides_rightly_about_small_and_distant_spheres() {
    for distance in [1e3, 1e6] {
        let mut random = Random::new(9);
        let n = ray_count();
        let mut wrong = vec![0; SPHERE_KERNELS.len()];
        for _ in 0..n {
            let (ray, sphere) = aimed::<Sphere>(&mut random, Aim::Around, distance);
            let expected = !sphere.crossings(&ray).is_empty();
            for (kernel, wrong) in SPHERE_KERNELS.iter().zip(&mut wrong) {
                *wrong += u64::from(kernel.intersect(&ray, sphere).is_some() != expected);
            }
        }
        for (kernel, wrong) in SPHERE_KERNELS.iter().zip(wrong) {
            let is_promised = matches!(kernel.info.tier, Some(Tier::Precise | Tier::Exact));
            let name = kernel.info.name;
            assert!(
                wrong == 0 || !is_promised,
                "{name} at {distance}: {wrong} of {n}"
            );
        }
    }
}

/// A sphere as large as f32 allows, and one as small.
#[test]
fn spheres_of_extreme_size_are_decided_as_the_oracle_does() {
    let exact = Sphere::kernel_of(Tier::Exact);
    for size in [1e-40f32, 1e-20, 1e20, 1e36] {
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let centre = size * random.in_cube().as_vec3();
            let origin = 4.0 * size * random.direction().as_vec3();
            let target = 1.5 * size * random.in_cube().as_vec3();
            let dir: Vec3 = (target - origin) / size;
            let ray = Ray::new(origin, dir).expect("a ray");
            let sphere = Sphere {
                centre,
                radius: 0.7 * size,
            };
            let found = exact.intersect(&ray, sphere);
            let expected = sphere.crossings(&ray);
            assert_eq!(found.is_some(), !expected.is_empty(), "{sphere:?} {ray:?}");
        }
    }
}

//! A ray spawned by the default policy doesn't hit the primitive that it leaves at once.

use super::{Sample, ray_near};
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::{AxisBox, Cuboid, Disk, Plane, Rectangle, Shape, Sphere};
use hitscope_core::spawn::{Departure, default_spawn_policy};

/// Leaves primitives outwards and inwards at hits of each kernel of a tier.
fn spawned_rays_miss<S: Sample + Shape>(size: f32, offset: f32, seed: u64) {
    let mut random = Random::new(seed);
    let mut count = 0;
    for _ in 0..2000 {
        let near = offset * random.direction().as_vec3();
        let shape = S::sample(&mut random, near, size);
        let arrived_by = ray_near(&mut random, near, size, 4.0);
        for tier in [Tier::Watertight, Tier::Precise, Tier::Exact] {
            let kernel = S::kernel_of(tier);
            let Some(hit) = kernel.intersect(&arrived_by, shape.clone()) else {
                continue;
            };
            let surface = shape.surface(&arrived_by, &hit);
            let scattered = (surface.normal + random.direction()).normalize_or(surface.normal);
            // The far side of a sphere is met at the same angle α. Roundings move the ray by up to 14u of the sample's
            // size, so the crossing by 14u / sin α; a radius of 0.1 then turns the normal by 140u / sin α, which is less
            // than sin α.
            let is_steep = scattered.dot(surface.normal) > 1e-2;
            for (dir, is_outwards) in [(scattered, true), (-scattered, false)] {
                let departure = Departure {
                    arrived_by: &arrived_by,
                    hit: &hit,
                    surface: &surface,
                    corners: None,
                    dir: dir.as_vec3(),
                    offset: Vec3::ZERO,
                };
                let ray = default_spawn_policy().spawn(&departure).expect("a ray");
                let again = kernel.intersect(&ray, shape.clone());
                count += 1;
                if is_outwards {
                    assert_eq!(again, None, "{shape:?} {arrived_by:?} {ray:?} {hit:?}");
                } else if let Some(again) = again.filter(|_| offset <= size && is_steep) {
                    // From inside, only the far side is hit.
                    let side = shape.surface(&ray, &again).normal.dot(dir);
                    assert!(side > 0.0, "{shape:?} {ray:?} {again:?} {side:e}");
                }
            }
        }
    }
    assert!(count > 500 || offset > size, "{count}");
}

#[test]
fn rays_that_leave_a_convex_shape_miss_it() {
    for (k, (size, offset)) in [
        (1.0, 0.0),
        (1e-4, 0.0),
        (1e4, 0.0),
        (1.0, 1e2),
        (1.0, 1e8),
        (1e-4, 1e8),
        (1e4, 1e8),
        (1e-4, 1e-8),
        (1e4, 1e-8),
    ]
    .into_iter()
    .enumerate()
    {
        spawned_rays_miss::<Sphere>(size, offset, k as u64);
        spawned_rays_miss::<Cuboid>(size, offset, k as u64);
        spawned_rays_miss::<AxisBox>(size, offset, k as u64);
        spawned_rays_miss::<Plane>(size, offset, k as u64);
        spawned_rays_miss::<Disk>(size, offset, k as u64);
        spawned_rays_miss::<Rectangle>(size, offset, k as u64);
    }
}

#[test]
fn the_origin_lies_outside_after_leaving_outwards() {
    let unit = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let mut random = Random::new(4);
    for _ in 0..2000 {
        let dir = random.direction();
        let arrived_by = Ray::new((3.0 * dir).as_vec3(), (-dir).as_vec3()).expect("a ray");
        let kernel = <Sphere as hitscope_core::kernel::KernelTable>::kernel_of(Tier::Watertight);
        let hit = kernel.intersect(&arrived_by, unit).expect("a hit");
        let departure = Departure {
            arrived_by: &arrived_by,
            hit: &hit,
            surface: &unit.surface(&arrived_by, &hit),
            corners: None,
            dir: dir.as_vec3(),
            offset: Vec3::ZERO,
        };
        let ray = default_spawn_policy().spawn(&departure).expect("a ray");
        // Lifted by Σ|nᵢ|·10u ≤ √3·10u. The point and the sum are rounded by u each, and each coordinate is moved by an ulp
        // of at most 2u.
        let height = ray.origin.as_dvec3().distance(DVec3::ZERO) - 1.0;
        let u = f64::from(f32::EPSILON) / 2.0;
        assert!(height > 0.0 && height < 23.0 * u, "{height:e}");
        assert_eq!(ray.exclude, None);
    }
}

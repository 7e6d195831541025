//! The exact kernel of spheres against the oracle, and the other kernels' wrong decisions.
//!
//! `HITSCOPE_SHAPE_RAYS=1000000` tests that many rays of each kind; by default 50 000.

use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::{KernelTable, SPHERE_KERNELS, Tier};
use hitscope_core::random::Random;
use hitscope_core::ray::ulp_at;
use hitscope_core::shape::Sphere;
use hitscope_lab::oracle::sphere_crossings;

fn ray_count() -> u32 {
    let count = std::env::var("HITSCOPE_SHAPE_RAYS").ok();
    count.and_then(|count| count.parse().ok()).unwrap_or(50_000)
}

/// A ray aimed at a sphere: within its silhouette and a little beyond, or within some ulps of the silhouette.
fn aimed(random: &mut Random, distance: f64, is_tangent: bool) -> (Ray, Sphere) {
    let radius = 2f64.powf(4.0 * random.signed());
    let centre = 4.0 * radius * random.in_cube();
    let origin = centre + distance * radius * random.direction();
    let to = (centre - origin).normalize();
    let side = to.cross(random.direction()).normalize();
    let beside = if is_tangent {
        // From 10⁻³ to the last digit of f64, inside or outside.
        1.0 + 2f64.powi(-10 - random.index(43) as i32) * random.signed()
    } else {
        1.2 * random.unit()
    };
    // The point where the ray passes the centre most closely.
    let along = (distance * distance - beside * beside).max(0.0).sqrt();
    let dir: DVec3 = along * to + beside * side;
    let sphere = Sphere {
        centre: centre.as_vec3(),
        radius: radius as f32,
    };
    let ray = Ray::new(origin.as_vec3(), dir.as_vec3()).expect("a ray");
    (ray, sphere)
}

#[test]
fn the_exact_kernel_decides_about_spheres_as_the_oracle_does() {
    let exact = Sphere::kernel_of(Tier::Exact);
    for (k, (distance, is_tangent)) in [
        (3.0, false),
        (3.0, true),
        (1.0, false),
        (0.5, false),
        (1e3, true),
        (1e6, false),
    ]
    .into_iter()
    .enumerate()
    {
        let mut random = Random::new(k as u64);
        let mut hits = 0;
        for _ in 0..ray_count() {
            let (ray, sphere) = aimed(&mut random, distance, is_tangent);
            let expected = sphere_crossings(&ray, sphere.centre, sphere.radius);
            let found = exact.intersect(&ray, sphere).map(|hit| hit.t);
            hits += u32::from(found.is_some());
            // t is rounded correctly, but f64's rounding comes first here.
            let first = expected.first().map(|&t| t as f32);
            let is_same = match (found, first) {
                (Some(a), Some(b)) => {
                    a == b
                        || (f64::from(a) - expected[0]).abs()
                            <= 0.5 * ulp_at(expected[0]) * (1.0 + 1e-6)
                }
                (a, b) => a == b,
            };
            assert!(is_same, "{sphere:?} {ray:?}: {found:?} {expected:?}");
        }
        assert!(hits > ray_count() / 10, "{distance}: {hits}");
    }
}

#[test]
fn the_stable_kernel_in_f64_decides_rightly_about_small_and_distant_spheres() {
    for distance in [1e3, 1e6] {
        let mut random = Random::new(9);
        let n = ray_count();
        let mut wrong = vec![0; SPHERE_KERNELS.len()];
        for _ in 0..n {
            let (ray, sphere) = aimed(&mut random, distance, false);
            let expected = !sphere_crossings(&ray, sphere.centre, sphere.radius).is_empty();
            for (kernel, wrong) in SPHERE_KERNELS.iter().zip(&mut wrong) {
                *wrong += u32::from(kernel.intersect(&ray, sphere).is_some() != expected);
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
            let expected = sphere_crossings(&ray, centre, 0.7 * size);
            let sphere = Sphere {
                centre,
                radius: 0.7 * size,
            };
            let found = exact.intersect(&ray, sphere);
            assert_eq!(found.is_some(), !expected.is_empty(), "{sphere:?} {ray:?}");
        }
    }
}

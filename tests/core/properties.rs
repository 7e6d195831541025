//! Properties of any triangle and ray: scaling, permuting vertices, reversing the ray, and o + t·d against
//! the point from barycentric coordinates.
//!
//! Each run tries new cases. A failure prints the shrunk case and the seed. PROPTEST_RNG_SEED=… repeats a
//! run, PROPTEST_CASES=… sets the number of cases. Failed cases are stored in `properties.txt` and tried
//! first in later runs; commit that file with the fix.

use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, RngSeed};
use std::hash::{BuildHasher, RandomState};

/// Half an ulp of 1 in f32: the relative error of one rounding.
const U: f64 = 1.0 / (1 << 24) as f64;

fn config() -> ProptestConfig {
    /// In this file's folder.
    const FAILED: &str = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/core/properties.txt"
    );
    let from_environment = ProptestConfig::default();
    let seed = match from_environment.rng_seed {
        RngSeed::Fixed(seed) => seed,
        RngSeed::Random => RandomState::new().hash_one("seed"),
    };
    // Shown only if the test fails.
    eprintln!("PROPTEST_RNG_SEED={seed}");
    ProptestConfig {
        cases: match std::env::var_os("PROPTEST_CASES") {
            Some(_) => from_environment.cases,
            None => 2000,
        },
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(FAILED))),
        ..from_environment
    }
}

fn point(size: f32) -> impl Strategy<Value = Vec3> {
    let coordinate = move || -size..size;
    (coordinate(), coordinate(), coordinate()).prop_map(Vec3::from)
}

/// A triangle of any shape, an origin in front of it at z = 4…8, and a ray aimed at its interior or slightly
/// past it.
fn aimed() -> impl Strategy<Value = ([Vec3; 3], Ray)> {
    let corners = [point(1.0), point(1.0), point(1.0)];
    let origin = (-2.0f32..2.0, -2.0f32..2.0, 4.0f32..8.0).prop_map(Vec3::from);
    let weights = (-0.1f32..1.0, -0.1f32..1.0);
    (corners, origin, weights, 0.1f32..10.0).prop_map(|([a, b, c], origin, (u, v), length)| {
        let target = a + u * (b - a) + v * (c - a);
        let ray = Ray::new(origin, length * (target - origin)).expect("apart");
        ([a, b, c], ray)
    })
}

/// The bits of t, u and v.
fn bits(hit: Option<hitscope_core::Hit>) -> Option<[u32; 3]> {
    hit.map(|hit| [hit.t, hit.u, hit.v].map(f32::to_bits))
}

/// The hit point by barycentric coordinates, exact but for the rounding of u and v.
fn place([a, b, c]: [Vec3; 3], hit: hitscope_core::Hit) -> DVec3 {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    a + f64::from(hit.u) * (b - a) + f64::from(hit.v) * (c - a)
}

/// Bound on the difference in any coordinate between o + t·d and the point by barycentric coordinates, for
/// edge functions of corners sheared along the ray.
///
/// M is the largest coordinate of a corner relative to the origin, L the longest edge, and det twice the
/// triangle's area seen along the ray. Translating and shearing the corners errs by 6uM (one rounding each of
/// the difference, of its sheared error, of the shear, of the product, and of a difference of at most 2M). An
/// edge function of sheared corners, which lie within 2L of the ray, errs by 3u·(2L)²; three of them, over
/// det, times the corners' distance of 2L from the ray: 9·8·u·L³/det. Normalising the weights errs by 3u
/// each, over edges: 6uL ≤ 12uM. t has 9 more roundings, each of at most M.
fn place_bound([a, b, c]: [Vec3; 3], ray: &Ray) -> f64 {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    let (origin, dir) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
    let far = [a, b, c].map(|p| (p - origin).abs().max_element());
    let far = far.into_iter().fold(0.0, f64::max);
    let longest = [b - a, c - b, a - c].map(DVec3::length);
    let longest = longest.into_iter().fold(0.0, f64::max);
    let det = (b - a).cross(c - a).dot(dir).abs() / dir.abs().max_element();
    U * (27.0 * far + 72.0 * longest.powi(3) / det)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn scaling_by_a_power_of_two_scales_t_exactly_and_keeps_u_and_v(
        (corners, ray) in aimed(),
        exponent in -16i32..16,
    ) {
        // Every product and sum scales exactly, as long as nothing under- or overflows.
        let scale = 2f32.powi(exponent);
        for kernel in TRIANGLE_KERNELS.iter() {
            let hit = kernel.intersect(&ray, corners);
            let moved = Ray::new(ray.origin * scale, ray.dir).expect("a ray");
            let scaled = kernel.intersect(&moved, corners.map(|p| p * scale));
            let expected = hit.map(|hit| hitscope_core::Hit { t: hit.t * scale, ..hit });
            prop_assert_eq!(bits(scaled), bits(expected), "{}", kernel.info.name);
        }
    }

    #[test]
    fn scaling_the_direction_by_a_power_of_two_divides_t_exactly_and_keeps_u_and_v(
        (corners, ray) in aimed(),
        exponent in -16i32..16,
    ) {
        let scale = 2f32.powi(exponent);
        for kernel in TRIANGLE_KERNELS.iter() {
            let hit = kernel.intersect(&ray, corners);
            let longer = Ray::new(ray.origin, ray.dir * scale).expect("a ray");
            let expected = hit.map(|hit| hitscope_core::Hit { t: hit.t / scale, ..hit });
            let found = kernel.intersect(&longer, corners).map(|hit| hitscope_core::Hit {
                t: longer.t_as_given(hit.t) as f32,
                ..hit
            });
            prop_assert_eq!(bits(found), bits(expected), "{}", kernel.info.name);
        }
    }

    #[test]
    fn permuting_the_corners_permutes_the_barycentric_coordinates((corners, ray) in aimed()) {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        // Edge functions differ only in sign. Their sum rounds twice and the quotient once: u and v have a
        // relative error of 3u. 1 − u − v rounds twice more: 5u. Two hits: 10u.
        let tolerance = (10.0 * U) as f32;
        for kernel in TRIANGLE_KERNELS.iter().filter(|kernel| kernel.info.promises.is_watertight) {
            let hit = kernel.intersect(&ray, corners);
            for order in ORDERS {
                let other = kernel.intersect(&ray, order.map(|k| corners[k]));
                prop_assert_eq!(other.is_some(), hit.is_some(), "{} {:?}", kernel.info.name, order);
                let (Some(hit), Some(other)) = (hit, other) else { continue };
                for (slot, corner) in order.into_iter().enumerate() {
                    let (found, expected) = (other.barycentric()[slot], hit.barycentric()[corner]);
                    prop_assert!((found - expected).abs() <= tolerance, "{} {} {:?}", found, expected, order);
                }
            }
        }
    }

    #[test]
    fn reversing_the_ray_turns_a_hit_in_front_into_a_miss((corners, ray) in aimed()) {
        let back = Ray::new(ray.origin, -ray.dir).expect("a ray");
        for kernel in TRIANGLE_KERNELS.iter() {
            prop_assert_eq!(kernel.intersect(&back, corners), None, "{}", kernel.info.name);
        }
    }

    #[test]
    fn the_hit_lies_on_the_ray_and_on_the_triangle((corners, ray) in aimed()) {
        for kernel in TRIANGLE_KERNELS.iter().filter(|kernel| kernel.info.promises.is_watertight) {
            let Some(hit) = kernel.intersect(&ray, corners) else { continue };
            let on_ray = ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3();
            let off = (on_ray - place(corners, hit)).abs().max_element();
            let bound = place_bound(corners, &ray);
            prop_assert!(off <= bound, "{} off by {}, bound {}", kernel.info.name, off, bound);
        }
    }
}

//! Where each spawn policy puts the ray's origin.

use glam::Vec3;
use hitscope_core::shape::{Shape as _, Triangle};
use hitscope_core::spawn::{Departure, SPAWN_POLICIES, SpawnPolicy, default_spawn_policy};
use hitscope_core::{Hit, Ray, ray::ulp_at};

/// Half an ulp of 1 in f32.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The ray spawned at (6, 3, z) on a triangle in the plane at `z`, upwards or downwards.
fn leave(policy: &SpawnPolicy, z: f32, side: f32) -> Ray {
    let arrived_by = Ray::new(Vec3::new(6.0, 3.0, z + 4.0), -Vec3::Z).expect("a ray");
    let hit = Hit {
        t: 4.0,
        u: 0.25,
        v: 0.5,
        primitive: 7,
    };
    let corners = [
        Vec3::new(1.0, 2.0, z),
        Vec3::new(9.0, 2.0, z),
        Vec3::new(7.0, 4.0, z),
    ];
    let surface = Triangle(corners).surface(&arrived_by, &hit);
    let dir = Vec3::new(0.5, -0.25, side);
    let departure = Departure::of_triangle(&arrived_by, &hit, &surface, corners, dir);
    policy.spawn(&departure).expect("a ray")
}

#[test]
fn every_policy_lifts_the_origin_by_its_sources_formula() {
    for policy in SPAWN_POLICIES {
        for (z, side) in [0.003_906_25f32, -0.003_906_25, 300.0, -300.0]
            .into_iter()
            .flat_map(|z| [(z, 1.0f32), (z, -1.0)])
        {
            let size = f64::from(z.abs());
            let expected = match policy.name {
                "fixed-epsilon" | "exclusion" => 0.0,
                "scaled-epsilon" => 1500.0 * U * (1.0 + size.max(6.0)),
                "wachter-binder" if size < 1.0 / 32.0 => 1.0 / 65536.0,
                "wachter-binder" => 256.0 * ulp_at(size),
                // The edges are (8, 0), (6, 2) and (2, −2).
                "nvidia" => U * size + 3.0 * U * 16.0,
                // The corner farthest from (6, 3) is 5 away along x.
                "error-bounded" | "combined" => 7.0 * U * (size + 5.0),
                other => panic!("no expected height for {other}"),
            };
            let ray = leave(policy, z, side);
            let height = f64::from(side) * (f64::from(ray.origin.z) - f64::from(z));
            // A coordinate is rounded by half an ulp and may then be moved by one; the height itself is
            // rounded about ten times.
            let most = 1.5 * ulp_at(size + expected) + 10.0 * U * expected;
            let error = (height - expected).abs();
            assert!(
                error <= most,
                "{} at {z}: {height:e}, {expected:e}",
                policy.name
            );
            assert_eq!(
                ray.origin.truncate().to_array(),
                [6.0, 3.0],
                "{}",
                policy.name
            );
            let t_min = if policy.name == "fixed-epsilon" {
                1e-6
            } else {
                0.0
            };
            assert_eq!(
                (ray.t_min, ray.t_max),
                (t_min, f32::INFINITY),
                "{}",
                policy.name
            );
            let excludes = ["exclusion", "combined"].contains(&policy.name);
            assert_eq!(ray.exclude, excludes.then_some(7), "{}", policy.name);
        }
    }
    assert_eq!(default_spawn_policy().name, "combined");
}

#[test]
fn the_fixed_epsilon_starts_at_o_plus_t_d_and_the_others_at_the_barycentric_point() {
    for policy in SPAWN_POLICIES {
        let arrived_by =
            Ray::new(Vec3::new(3.0, -5.0, 4.0), Vec3::new(0.25, 2.0, -1.0)).expect("a ray");
        let hit = Hit {
            t: 4.0,
            u: 0.125,
            v: 0.25,
            primitive: 0,
        };
        let corners = [Vec3::ZERO, Vec3::X * 16.0, Vec3::Y * 32.0];
        let surface = Triangle(corners).surface(&arrived_by, &hit);
        let departure = Departure::of_triangle(&arrived_by, &hit, &surface, corners, Vec3::Z);
        let origin = policy.spawn(&departure).expect("a ray").origin.truncate();
        let expected = match policy.name {
            "fixed-epsilon" => [4.0, 3.0],
            _ => [2.0, 8.0],
        };
        assert_eq!(origin.to_array(), expected, "{}", policy.name);
    }
}

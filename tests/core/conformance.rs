//! Cases that every kernel must answer correctly, one triangle at a time.
//!
//! Properties that only some kernels promise in `INFO` have tests of their own.

use glam::{DVec3, Vec3, Vec3Swizzles};
use hitscope_core::kernel::{Precision, TRIANGLE_KERNELS, TriangleKernel, exact_triangle_kernel};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::obj::{self, LoadOptions};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::ray::RayError;
use hitscope_core::scene::scene;
use hitscope_core::{Hit, Ray};
use std::path::Path;

/// Half an ulp of 1 in f32: the relative error of one rounding.
const U: f64 = 1.0 / (1 << 24) as f64;

/// Asymmetric in every way, so that barycentric coordinates on the wrong corner are noticed.
const CORNERS: [Vec3; 3] = [
    Vec3::new(-1.0, -0.5, 2.0),
    Vec3::new(1.5, -1.0, 2.5),
    Vec3::new(0.25, 1.5, 3.0),
];

fn ray(origin: Vec3, dir: Vec3) -> Ray {
    Ray::new(origin, dir).expect("a ray")
}

fn blend(weights: [f64; 3], corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    weights[0] * a + weights[1] * b + weights[2] * c
}

/// Calls `check` with every kernel and several barycentric coordinates, with the axes permuted and mirrored,
/// and with both windings, so that every branch of a kernel is taken.
fn in_every_pose(check: impl Fn(&TriangleKernel, [Vec3; 3], [f64; 3])) {
    const WEIGHTS: [[f64; 3]; 4] = [
        [0.25, 0.25, 0.5],
        [0.125, 0.5, 0.375],
        [0.625, 0.125, 0.25],
        [0.0625, 0.1875, 0.75],
    ];
    for kernel in TRIANGLE_KERNELS.iter() {
        for pose in 0..48 {
            let corners = CORNERS.map(|p| posed(p, pose));
            for weights in WEIGHTS {
                check(kernel, corners, weights);
                let ([a, b, c], [x, y, z]) = (corners, weights);
                check(kernel, [a, c, b], [x, z, y]);
            }
        }
    }
}

/// One of the 48 ways to permute and mirror the axes.
fn posed(p: Vec3, pose: usize) -> Vec3 {
    let turned = [p, p.yzx(), p.zxy(), p.yxz(), p.xzy(), p.zyx()][pose % 6];
    let sign = |bit: usize| {
        if (pose / 6) >> bit & 1 == 1 {
            -1.0
        } else {
            1.0
        }
    };
    turned * Vec3::new(sign(0), sign(1), sign(2))
}

/// Asserts t, u, v and the hit point for a ray from `origin`. Its direction is `lengths` times the vector to
/// the point with these barycentric coordinates, rounded.
///
/// By Cramer's rule, each numerator and the determinant are sums of six products of three differences. Each
/// product has three roundings of the differences, two of the products and three of the sum: 8u of the
/// product of the lengths. Such a product over det is at most 10 here, where det is 2·area·cos of the angle
/// between ray and normal; rounding the direction adds u. Numerator and determinant have 6 products each:
/// 2·6·8·10·u ≈ 1000u, relative to the coordinates.
fn assert_hit_at(
    kernel: &TriangleKernel,
    corners: [Vec3; 3],
    weights: [f64; 3],
    origin: Vec3,
    lengths: f64,
) {
    let name = kernel.info.name;
    let point = blend(weights, corners);
    let dir = ((point - origin.as_dvec3()) * lengths).as_vec3();
    let ray = ray(origin, dir);
    let hit = kernel.intersect(&ray, corners);
    let hit = hit.unwrap_or_else(|| panic!("{name} misses {corners:?} from {origin}"));

    let size = corners.map(|p| f64::from(p.abs().max_element()));
    let size = size.into_iter().fold(0.0, f64::max);
    let found = hit.barycentric().map(f64::from);
    for (weight, expected) in found.into_iter().zip(weights) {
        assert!(
            (weight - expected).abs() <= 1000.0 * U,
            "{name}: {found:?}, not {weights:?}"
        );
    }
    let (t, expected) = (ray.t_as_given(hit.t), 1.0 / lengths);
    assert!(
        (t - expected).abs() <= 1000.0 * U * expected,
        "{name}: t {t}, not {expected}"
    );
    let off = (blend(found, corners) - point).length();
    assert!(off <= 1000.0 * U * size, "{name}: {off} off the point");
}

#[test]
fn an_interior_hit_from_either_side_has_its_barycentric_coordinates_on_the_right_corners() {
    in_every_pose(|kernel, corners, weights| {
        let point = blend(weights, corners).as_vec3();
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        for side in [1.0, -1.0] {
            let origin = point + side * normal + 0.125 * (b - a);
            assert_hit_at(kernel, corners, weights, origin, 1.0);
        }
    });
}

#[test]
fn t_is_inversely_proportional_to_the_length_of_the_direction() {
    in_every_pose(|kernel, corners, weights| {
        for lengths in [1e-10, 1e-3, 0.25, 7.0, 1e10] {
            assert_hit_at(kernel, corners, weights, Vec3::splat(0.125), lengths);
        }
    });
}

#[test]
fn easy_hits_are_found_at_any_usual_scale() {
    in_every_pose(|kernel, corners, weights| {
        for scale in [1e-6, 1e-3, 1e3, 1e6] {
            let corners = corners.map(|p| p * scale);
            let origin = Vec3::splat(0.125) * scale;
            assert_hit_at(kernel, corners, weights, origin, 1.0);
            assert_hit_at(kernel, corners, weights, origin, f64::from(1.0 / scale));
        }
    });
}

#[test]
fn an_offset_without_rounding_changes_no_bit() {
    in_every_pose(|kernel, corners, weights| {
        if !kernel.info.promises.is_translation_invariant {
            return;
        }
        // CORNERS are multiples of 1/4, so that offsets up to 2²¹ cause no rounding.
        let origin = Vec3::splat(0.25);
        let dir = (blend(weights, corners) - origin.as_dvec3()).as_vec3();
        let here = kernel.intersect(&ray(origin, dir), corners);
        let offset = Vec3::new(131_072.0, -65_536.0, 1_048_576.0);
        let there = kernel.intersect(&ray(origin + offset, dir), corners.map(|p| p + offset));
        assert_eq!(here, there, "{}", kernel.info.name);
        assert!(here.is_some(), "{}", kernel.info.name);
    });
}

#[test]
fn a_ray_past_any_edge_or_corner_is_a_miss() {
    // Beyond an edge one coordinate is negative, beyond a corner two are.
    const OUTSIDE: [[f64; 3]; 6] = [
        [-0.125, 0.5, 0.625],
        [0.5, -0.125, 0.625],
        [0.5, 0.625, -0.125],
        [1.25, -0.125, -0.125],
        [-0.125, 1.25, -0.125],
        [-0.125, -0.125, 1.25],
    ];
    in_every_pose(|kernel, corners, _| {
        for weights in OUTSIDE {
            let dir = blend(weights, corners).as_vec3();
            let hit = kernel.intersect(&ray(Vec3::ZERO, dir), corners);
            assert_eq!(hit, None, "{} {weights:?}", kernel.info.name);
        }
    });
}

#[test]
fn a_triangle_behind_the_origin_is_a_miss() {
    in_every_pose(|kernel, corners, weights| {
        let dir = -blend(weights, corners).as_vec3();
        let hit = kernel.intersect(&ray(Vec3::ZERO, dir), corners);
        assert_eq!(hit, None, "{}", kernel.info.name);
    });
}

#[test]
fn a_ray_parallel_to_the_plane_is_a_miss() {
    // In an axis-aligned plane the determinant is 0 in any order of operations.
    let flat = [
        Vec3::ZERO,
        Vec3::new(2.0, 0.0, 0.0),
        Vec3::new(0.0, 2.0, 0.0),
    ];
    for kernel in TRIANGLE_KERNELS.iter() {
        for pose in 0..48 {
            let corners = flat.map(|p| posed(p, pose));
            for height in [0.0, 0.5] {
                for dir in [Vec3::X, Vec3::Y, Vec3::new(1.0, 0.75, 0.0)] {
                    let from = posed(Vec3::new(-1.0, 0.25, height), pose);
                    let hit = kernel.intersect(&ray(from, posed(dir, pose)), corners);
                    assert_eq!(hit, None, "{} pose {pose}", kernel.info.name);
                }
            }
        }
    }
}

#[test]
fn the_interval_is_open_at_both_ends() {
    in_every_pose(|kernel, corners, weights| {
        let dir = blend(weights, corners).as_vec3();
        // Watertight kernels compare the exact t with the interval, before rounding.
        let is_right = kernel.info.promises.is_watertight;
        let measure = if is_right {
            exact_triangle_kernel()
        } else {
            kernel
        };
        let t = measure
            .intersect(&ray(Vec3::ZERO, dir), corners)
            .expect("a hit")
            .t;
        let hit = |t_min, t_max| {
            let ray = Ray::with_interval(Vec3::ZERO, dir, t_min, t_max).expect("a ray");
            kernel.intersect(&ray, corners).map(|hit| hit.t)
        };
        // f64 kernels compare t before rounding it to f32.
        if kernel.info.precision == Precision::F32 && !is_right {
            assert_eq!(hit(t, 9.0), None);
            assert_eq!(hit(0.0, t), None);
        }
        assert_eq!(hit(t.next_up(), 9.0), None);
        assert_eq!(hit(0.0, t.next_down()), None);
        assert_eq!(hit(t.next_down(), t.next_up()), Some(t));
        let found = kernel.intersect(&ray(Vec3::ZERO, dir), corners);
        assert_eq!(hit(-1.0, 9.0), found.map(|hit| hit.t));
    });
}

#[test]
fn an_interval_with_negative_t_finds_hits_behind_the_origin() {
    in_every_pose(|kernel, corners, weights| {
        let dir = -blend(weights, corners).as_vec3();
        let ray = Ray::with_interval(Vec3::ZERO, dir, -2.0, 2.0).expect("a ray");
        let hit = kernel.intersect(&ray, corners).expect("a hit behind");
        assert!((f64::from(hit.t) + 1.0).abs() <= 1000.0 * U, "{}", hit.t);
    });
}

#[test]
fn a_triangle_with_a_nan_is_a_miss() {
    in_every_pose(|kernel, corners, weights| {
        let ray = ray(Vec3::ZERO, blend(weights, corners).as_vec3());
        for slot in 0..9 {
            let mut corners = corners;
            corners[slot / 3][slot % 3] = f32::NAN;
            assert_eq!(
                kernel.intersect(&ray, corners),
                None,
                "{} {slot}",
                kernel.info.name
            );
        }
    });
}

#[test]
fn degenerate_and_non_finite_triangles_are_dropped_at_load() {
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv nan 0 0\nf 1 2 4\nf 1 2 2\nf 1 2 5\nf 1 2 3\n";
    let no_library = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let progress = Progress::default();
    let loaded = obj::parse(
        text.as_bytes(),
        Path::new("x.obj"),
        LoadOptions::default(),
        &no_library,
        &progress,
    );
    let loaded = loaded.expect("one good triangle");
    let mesh = loaded.mesh;
    assert_eq!(mesh.triangles().len(), 1);
    assert_eq!(mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(
        (
            loaded.report.dropped.zero_area,
            loaded.report.dropped.non_finite
        ),
        (2, 1)
    );
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene(mesh.clone()).intersector(kernel);
        let hit = intersector.closest_hit(&ray(Vec3::new(0.25, 0.25, 1.0), Vec3::NEG_Z));
        assert_eq!(
            hit.map(|hit| hit.primitive),
            Some(0),
            "{}",
            kernel.info.name
        );
    }
}

#[test]
fn rays_with_a_non_finite_component_or_a_zero_direction_are_rejected() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for slot in 0..3 {
            let mut v = Vec3::ONE;
            v[slot] = bad;
            assert_eq!(Ray::new(v, Vec3::ONE), Err(RayError::OriginNotFinite));
            assert_eq!(Ray::new(Vec3::ONE, v), Err(RayError::DirectionNotFinite));
        }
    }
    for zero in [Vec3::ZERO, -Vec3::ZERO, Vec3::new(0.0, -0.0, 0.0)] {
        assert_eq!(Ray::new(Vec3::ONE, zero), Err(RayError::DirectionZero));
    }
}

#[test]
fn every_hit_is_finite_and_in_range_even_for_extreme_numbers() {
    const EXTREMES: [f32; 10] = [
        0.0,
        -0.0,
        1e-45,
        -1e-38,
        1e-20,
        1.0,
        -1.0,
        1e20,
        -3e38,
        f32::MAX,
    ];
    let mut random = Random::new(1);
    let mut any = || Vec3::from_array([(); 3].map(|()| EXTREMES[random.index(EXTREMES.len())]));
    let mut hits = vec![0; TRIANGLE_KERNELS.len()];
    for _ in 0..20_000 {
        let (origin, dir, corners) = (any(), any(), [any(), any(), any()]);
        let Ok(ray) = Ray::new(origin, dir) else {
            continue;
        };
        for (kernel, hits) in TRIANGLE_KERNELS.iter().zip(&mut hits) {
            if let Some(Hit { t, u, v, .. }) = kernel.intersect(&ray, corners) {
                // t was positive before it was rounded to f32.
                let is_ahead = t > 0.0 || kernel.info.precision != Precision::F32 && t == 0.0;
                let is_good =
                    is_ahead && t < f32::INFINITY && u >= 0.0 && v >= 0.0 && u <= 1.0 && v <= 1.0;
                assert!(
                    is_good,
                    "{} t {t} u {u} v {v}: {ray:?} {corners:?}",
                    kernel.info.name
                );
                *hits += 1;
            }
        }
    }
    assert!(hits.iter().all(|&n| n > 0), "{hits:?}");
    // The same numbers through the tree: no panic, no endless loop.
    let triangles: Vec<[Vec3; 3]> = (0..200).map(|_| [any(), any(), any()]).collect();
    let scene = scene(soup(&triangles));
    for intersector in TRIANGLE_KERNELS
        .iter()
        .map(|kernel| scene.intersector(kernel))
    {
        for _ in 0..500 {
            if let Ok(ray) = Ray::new(any(), any()) {
                let hit = intersector.closest_hit(&ray);
                assert!(hit.is_none_or(|hit| hit.t >= 0.0 && hit.t < f32::INFINITY));
            }
        }
    }
}

/// Source: the BadCases test of M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed.
#[test]
fn accurate_and_exact_kernels_miss_a_triangle_of_zero_area() {
    let corners = [-79.049614, -87.09227, -79.209015].map(|y| Vec3::new(-1113.4546, y, -56.24319));
    let ray = ray(
        Vec3::new(-1081.4792, 99.999954, 87.77011),
        Vec3::new(-32.1073, -183.35587, -144.60764),
    );
    for kernel in TRIANGLE_KERNELS.iter() {
        let promises = kernel.info.promises;
        if promises.is_accurate || promises.is_exact {
            assert_eq!(
                kernel.intersect(&ray, corners),
                None,
                "{}",
                kernel.info.name
            );
        }
    }
}

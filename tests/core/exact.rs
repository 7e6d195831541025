//! Edge cases of the exact kernel: the interval's ends, f32's largest number, equal t, the smallest
//! triangles.
//!
//! No test can distinguish the following from the variant named:
//! - half the filter's bounds on edge functions and depths: they are derived for the worst case. Over 10⁷
//!   steps of hill climbing towards the largest error, no edge function whose sign was at stake erred by more
//!   than 0.27 of its bound, and no depth by more than 0.46 (2026-11);
//! - no allowance in `Judge::earliest`: rounding is monotone, so that a depth before the rounded start of the
//!   interval is also before the exact start;
//! - no cap of a hit's t at f32's largest number: t errs by at most 2⁻³² and rounds to infinity only from
//!   2⁻²⁵ beyond that number.

use glam::Vec3;
use hitscope_core::kernel::{exact_answer, exact_triangle_kernel};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::Triangle;
use hitscope_core::{Hit, Ray};

const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

/// The kernel's hit of a single triangle, after checking that a tree gives the same.
fn closest(ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
    let alone = exact_triangle_kernel().intersect(ray, corners);
    let intersector = scene(soup(&[corners])).intersector(exact_triangle_kernel());
    assert_eq!(intersector.closest_hit(ray), alone, "{ray:?}");
    assert_eq!(intersector.any_hit(ray), alone.is_some(), "{ray:?}");
    let all = intersector.all_hits(ray);
    assert_eq!(all.first().map(|crossing| crossing.hit), alone, "{ray:?}");
    assert_eq!(intersector.count_hits(ray), all.len(), "{ray:?}");
    alone
}

#[test]
fn a_hit_at_either_end_of_the_interval_is_a_miss() {
    let down = |t_min: f32, t_max: f32| {
        let ray = Ray::with_interval(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z, t_min, t_max);
        closest(&ray.expect("a ray"), TRIANGLE).map(|hit| hit.t)
    };
    assert_eq!(down(0.0, 1.0), None);
    assert_eq!(down(1.0, 2.0), None);
    assert_eq!(down(0.0, 1.0f32.next_up()), Some(1.0));
    assert_eq!(down(1.0f32.next_down(), 2.0), Some(1.0));
    assert_eq!(down(-1.0, 1.0), None);
    assert_eq!(down(-1.0, 1.0f32.next_up()), Some(1.0));
}

#[test]
fn a_hit_beyond_the_largest_f32_is_a_miss() {
    // t is 2¹⁶ times the distance.
    let far = |z: f32| {
        let ray = Ray::new(Vec3::new(0.0, 0.0, -z), Vec3::Z * 2f32.powi(-16)).expect("a ray");
        assert_eq!(ray.scale, 0);
        let size = 2f32.powi(100);
        let corners = [
            Vec3::new(-1.0, -1.0, 0.0),
            Vec3::new(2.0, 0.0, 0.0),
            Vec3::Y * 3.0,
        ];
        exact_triangle_kernel().intersect(&ray, corners.map(|p| p * size))
    };
    let limit = 2f32.powi(112);
    for beyond in [limit, limit.next_up(), 2.0 * limit, 2f32.powi(126)] {
        assert_eq!(far(beyond), None, "{beyond:e}");
    }
    assert_eq!(
        far(limit.next_down()).map(|hit| hit.t),
        None,
        "t is the largest f32, where the interval ends"
    );
    let nearer = limit.next_down().next_down();
    assert_eq!(far(nearer).map(|hit| hit.t), Some(f32::MAX.next_down()));
}

#[test]
fn at_equal_t_the_lowest_primitive_is_hit_even_if_the_fractions_of_t_round_differently() {
    // The rays hit the corner that both triangles share at t = p/q. Each triangle's integers give t as a
    // different unreduced fraction. f64 rounds one up and the other down, as t lies near the middle of two
    // f64 numbers.
    let cases: [(f32, f32, [[f32; 6]; 2]); 6] = [
        (
            16_632_947.0,
            98_121.0,
            [
                [-450.0, 259.0, -449.0, 0.0, -376.0, 850.0],
                [537.0, -528.0, -597.0, 669.0, -322.0, 707.0],
            ],
        ),
        (
            16_162_422.0,
            99_101.0,
            [
                [60.0, -487.0, -353.0, 406.0, 522.0, 323.0],
                [-61.0, -211.0, 550.0, 163.0, -561.0, 981.0],
            ],
        ),
        (
            12_411_443.0,
            86_755.0,
            [
                [684.0, 845.0, -535.0, -351.0, 834.0, 956.0],
                [364.0, -144.0, -885.0, -824.0, 390.0, -711.0],
            ],
        ),
        (
            9_152_036.0,
            66_455.0,
            [
                [-945.0, 709.0, 773.0, -702.0, 267.0, 460.0],
                [525.0, 69.0, 205.0, -947.0, -371.0, -400.0],
            ],
        ),
        (
            15_415_987.0,
            44_353.0,
            [
                [-120.0, 800.0, 153.0, -551.0, 173.0, 907.0],
                [-31.0, -129.0, 436.0, 573.0, 944.0, 530.0],
            ],
        ),
        (
            16_303_187.0,
            92_195.0,
            [
                [-74.0, 326.0, -589.0, -660.0, 190.0, 651.0],
                [178.0, -600.0, 583.0, 554.0, -299.0, 48.0],
            ],
        ),
    ];
    for (p, q, others) in cases {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z * q).expect("a ray");
        let [first, second] =
            others.map(|[a, b, c, d, e, f]| [Vec3::Z * p, Vec3::new(a, b, c), Vec3::new(d, e, f)]);
        for triangles in [[first, second], [second, first]] {
            let intersector = scene(soup(&triangles)).intersector(exact_triangle_kernel());
            let hit = intersector.closest_hit(&ray).expect("the corner is hit");
            assert_eq!(hit.primitive, 0, "{p}/{q}");
            let crossings = intersector.all_hits(&ray);
            assert_eq!(crossings.len(), 1, "{p}/{q}");
            assert_eq!(crossings[0].also, [1], "{p}/{q}");
        }
    }
}

#[test]
fn t_u_and_v_are_more_accurate_than_f32_even_if_lengths_differ_by_a_factor_of_100_000() {
    // The rays hit the planes z = 1 + ax + by at t = 1; all coordinates are exact. Barycentric coordinates
    // are fractions of integers below 2⁵³.
    for size in [1.0f32, 1024.0, 16_384.0, 131_072.0] {
        for slope in [1.0f32 / 64.0, 3.0, -5.0 / 16.0] {
            let (a, b) = (slope, 0.25 * slope);
            let corner =
                |x: f32, y: f32| Vec3::new(x * size, y * size, 1.0 + a * x * size + b * y * size);
            let corners = [corner(-3.0, -1.0), corner(2.0, -2.0), corner(1.0, 5.0)];
            let ray = Ray::new(Vec3::ZERO, Vec3::Z).expect("a ray");
            let [t, u, v] = exact_answer(&ray, &Triangle(corners)).expect("a hit");
            // From the edge functions of (−3, −1), (2, −2), (1, 5).
            let det = 8.0 + 12.0 + 14.0;
            let expected = [1.0, 14.0 / det, 8.0 / det];
            let errors = [t - expected[0], u - expected[1], v - expected[2]];
            let most = [2f64.powi(-32), 2f64.powi(-31), 2f64.powi(-31)];
            for (error, most) in errors.into_iter().zip(most) {
                assert!(error.abs() <= most, "{size} {slope}: {errors:?}");
            }
        }
    }
}

#[test]
fn tiny_triangles_give_the_same_decisions_as_enlarged_ones() {
    // f32 holds only a few digits of products of such lengths, or none. The loss is at most f32's smallest
    // normal number, which the filter's bounds include.
    let count = |ray: &Ray, corners: [Vec3; 3]| {
        let intersector = scene(soup(&[corners])).intersector(exact_triangle_kernel());
        intersector.count_hits(ray)
    };
    let mut random = Random::new(1);
    let mut hits = 0;
    for _ in 0..12_000 {
        let corners = [(); 3].map(|()| random.in_cube_f32());
        let [_, b, c] = corners;
        let origin = random.in_cube_f32() - 2.0 * Vec3::Z;
        let on_edge = b.as_dvec3().lerp(c.as_dvec3(), random.unit());
        let dir = (on_edge - origin.as_dvec3()).as_vec3();
        let at = |scale: f32| {
            let ray = Ray::new(scale * origin, dir).expect("a ray");
            count(&ray, corners.map(|p| scale * p))
        };
        let expected = at(1.0);
        hits += expected;
        for exponent in [-64, -66, -68, -72] {
            assert_eq!(
                at(2f32.powi(exponent)),
                expected,
                "2^{exponent} {corners:?} {origin} {dir}"
            );
        }
    }
    assert!((3_000..9_000).contains(&hits), "{hits}");
}

#[test]
fn at_the_apex_of_a_large_fan_the_work_is_in_proportion_to_its_triangles() {
    const COUNT: usize = 20_000;
    let rim = |k: usize| {
        let angle = k as f32 * std::f32::consts::TAU / COUNT as f32;
        Vec3::new(angle.cos(), angle.sin(), 0.1 * angle.sin())
    };
    // The apex isn't at the origin, where fewer digits would do.
    let apex = Vec3::new(0.25, 0.125, 0.75);
    let triangles: Vec<[Vec3; 3]> = (0..COUNT).map(|k| [apex, rim(k), rim(k + 1)]).collect();
    let intersector = scene(soup(&triangles)).intersector(exact_triangle_kernel());
    let eye = Vec3::new(1.25, -0.5, 2.75);
    let ray = Ray::new(eye, apex - eye).expect("a ray");
    assert_eq!(ray.origin + ray.dir, apex, "the ray meets the apex exactly");
    let (hit, cost) = intersector.closest_hit_with_cost(&ray);
    assert_eq!(hit.map(|hit| hit.primitive), Some(0));
    // Comparing each pair would take 2e8 decisions.
    let decisions = cost.in_integers as usize;
    assert!(decisions <= 8 * COUNT, "{decisions} decisions");
    let all = intersector.all_hits(&ray);
    assert_eq!((all.len(), all[0].also.len()), (1, COUNT - 1));
}

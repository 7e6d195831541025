//! Tests that show errors of the lecture's printed programs, which the kernels don't have.

use glam::Vec3;
use hitscope_core::kernel::{KernelTable as _, TRIANGLE_KERNELS, triangle_kernel};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::random::Random;
use hitscope_core::shape::{AxisBox, Triangle};
use hitscope_core::{Hit, Ray, TriangleMesh};
use hitscope_lab::measure::cases::triangle_cases;
use hitscope_lab::measure::contestants::contestants;
use hitscope_lab::measure::lecture;
use hitscope_lab::measure::triangles;

const CORNERS: [Vec3; 3] = [
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(5.0, 1.0, 0.0),
    Vec3::new(1.0, 5.0, 0.0),
];

/// A ray to the point with barycentric coordinates 1/4, 1/2, 1/4.
fn over_the_middle() -> Ray {
    Ray::new(Vec3::new(3.0, 2.0, 4.0), Vec3::NEG_Z).expect("a ray")
}

#[test]
fn the_programs_normal_is_opposite_to_the_slides_and_ours_follows_the_right_hand_rule() {
    // The slide has (v1 − v0) × (v2 − v0), by the right-hand rule; the program has c × b with b = B − A, c = C − A.
    assert_eq!(lecture::program_normal(CORNERS), Vec3::NEG_Z);
    let mesh: TriangleMesh = soup(&[CORNERS]);
    assert_eq!(mesh.geometric_normal(0), Vec3::Z);
}

#[test]
fn the_programs_beta_belongs_to_c_and_ours_to_b() {
    let ray = over_the_middle();
    let printed = lecture::plane_projection(&ray, CORNERS).expect("a hit nevertheless");
    assert_eq!((printed.u, printed.v), (0.25, 0.5));
    for kernel in TRIANGLE_KERNELS.iter() {
        let hit = kernel.intersect(&ray, CORNERS).expect("a hit");
        assert_eq!((hit.u, hit.v), (0.5, 0.25), "{}", kernel.info.name);
    }
}

#[test]
fn the_slides_tolerance_accepts_hits_behind_the_origin_and_the_programs_rejects_long_directions() {
    assert!(
        lecture::passes_slide(-5.0),
        "|t| < ε doesn't reject hits behind the origin"
    );
    assert!(!lecture::passes_slide(5e-7));
    let origin = over_the_middle().origin;
    // As given by a user, without rescaling by `Ray::new`.
    let long = Ray {
        dir: Vec3::NEG_Z * 1e10,
        ..over_the_middle()
    };
    assert_eq!(lecture::plane_projection(&long, CORNERS), None);
    for kernel in TRIANGLE_KERNELS.iter() {
        let behind = Ray::new(origin, Vec3::Z).expect("a ray");
        assert_eq!(
            kernel.intersect(&behind, CORNERS),
            None,
            "{}",
            kernel.info.name
        );
        let long = Ray::new(origin, Vec3::NEG_Z * 1e10).expect("a ray");
        let hit = kernel.intersect(&long, CORNERS).expect("a hit");
        assert_eq!(long.t_as_given(hit.t) as f32, 4e-10, "{}", kernel.info.name);
    }
}

#[test]
fn the_lectures_edge_planes_cull_one_side_and_yield_nan_on_an_edges_line_and_ours_do_neither() {
    let up = Ray::new(Vec3::new(3.0, 2.0, -4.0), Vec3::Z).expect("a ray");
    let down = over_the_middle();
    let is_hit = |ray: &Ray| lecture::edge_planes(ray, CORNERS).is_some();
    assert_ne!(is_hit(&up), is_hit(&down), "one of the sides is culled");
    // From the line of AB, in the triangle's plane: t and the edge's normal are NaN, for which both t < ε and
    // P·n + s < 0 are false. The program reports a hit of NaN values.
    let on_line = Ray::new(Vec3::new(9.0, 1.0, 0.0), Vec3::new(0.5, 1.0, 0.0)).expect("a ray");
    let printed = lecture::edge_planes(&on_line, CORNERS).expect("a false hit");
    assert!(printed.t.is_nan() && printed.u.is_nan());
    for kernel in TRIANGLE_KERNELS.iter() {
        for ray in [&up, &down] {
            assert!(
                kernel.intersect(ray, CORNERS).is_some(),
                "{}",
                kernel.info.name
            );
        }
        assert_eq!(
            kernel.intersect(&on_line, CORNERS),
            None,
            "{}",
            kernel.info.name
        );
    }
}

#[test]
fn the_lectures_box_test_of_single_pairs_never_misses_and_ours_does() {
    let bounds = AxisBox {
        min: Vec3::ZERO,
        max: Vec3::ONE,
    };
    let passing = Ray::new(Vec3::new(-1.0, 3.0, 0.5), Vec3::new(1.0, 0.1, 0.1)).expect("a ray");
    assert!(
        lecture::slabs(&passing, &bounds).is_some(),
        "each pair of planes alone has near ≤ far"
    );
    for kernel in AxisBox::kernels() {
        assert_eq!(kernel.intersect(&passing, bounds), None);
    }
    // Both find the same t where the ray meets the box.
    let hitting = Ray::new(Vec3::new(-1.0, 0.5, 0.5), Vec3::new(1.0, 0.1, 0.1)).expect("a ray");
    let printed = lecture::slabs(&hitting, &bounds).expect("a hit");
    assert_eq!(printed.t, 1.0);
}

#[test]
fn the_parametric_form_without_a_is_correct_only_with_a_at_the_origin() {
    let ray = over_the_middle();
    assert_eq!(lecture::parametric(&ray, CORNERS), None);
    let moved = Ray::new(ray.origin - CORNERS[0], ray.dir).expect("a ray");
    let at_origin = CORNERS.map(|p| p - CORNERS[0]);
    let hit = lecture::parametric(&moved, at_origin).expect("a hit");
    assert_eq!((hit.u, hit.v), (0.5, 0.25));
    let kernel = triangle_kernel("parametric").expect("in the table");
    let hit = kernel.intersect(&ray, CORNERS).expect("a hit");
    assert_eq!((hit.u, hit.v), (0.5, 0.25));
}

#[test]
fn a_plane_relative_to_the_worlds_origin_cancels_far_away_and_ours_relative_to_a_corner_does_not() {
    let case = triangle_cases()
        .into_iter()
        .find(|case| case.name == "offset-1e5")
        .expect("in the matrix");
    let cells = triangles::measure(&case, &contestants::<Triangle>(), 2_000, 1);
    let p50 = |name: &str| {
        let cell = cells
            .iter()
            .find(|cell| cell.kernel == name)
            .expect("measured");
        cell.t_ulps.expect("hits").p50
    };
    assert!(p50("plane-projection as printed") > 1_000.0);
    assert!(p50("plane-projection") < 10.0);
}

#[test]
fn interpolation_with_any_kernels_coordinates_returns_the_hit_point() {
    let mut random = Random::new(3);
    let mut checked = 0;
    for _ in 0..1_000 {
        let corners = [(); 3].map(|()| random.in_cube_f32());
        let [a, b, c] = corners;
        let target = 0.5 * a + 0.125 * b + 0.375 * c;
        let origin = 3.0 * random.in_cube_f32();
        let ray = Ray::new(origin, target - origin).expect("a ray");
        // Barycentric coordinates of slivers and grazing rays are ill-conditioned: measured by the lab, not tested.
        let normal = (b - a).cross(c - a);
        let cosine = normal.normalize().dot(ray.dir.normalize()).abs();
        if normal.length() < 0.25 || cosine < 0.1 {
            continue;
        }
        for kernel in TRIANGLE_KERNELS.iter() {
            let hit: Hit = kernel.intersect(&ray, corners).expect("a hit");
            let [l1, l2, l3] = hit.barycentric();
            let off = (l1 * a + l2 * b + l3 * c - target).length();
            // Edges of 2, distances of 5, over a cosine of 0.1 and an area of 0.125: some 1000u.
            assert!(off < 1e-4, "{} {off}", kernel.info.name);
        }
        checked += 1;
    }
    assert!(checked > 500, "{checked}");
}

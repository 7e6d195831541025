//! Tests of placed rays against integer arithmetic.

use super::*;
use hitscope_core::TriangleMesh;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;

fn scene(origin: DVec3) -> Scene {
    let mesh = soup(&[[Vec3::ZERO, Vec3::Y, Vec3::Z]]);
    Scene::new(mesh.with_origin(origin), &Progress::default()).expect("never cancelled")
}

fn given(origin: DVec3, dir: DVec3) -> GivenRay {
    GivenRay {
        origin,
        dir,
        t_min: 0.0,
        t_max: f64::INFINITY,
    }
}

/// A number times 2^`exponent`, which must be whole.
fn whole(x: f64, exponent: i32) -> i128 {
    let x = x * 2f64.powi(exponent);
    assert_eq!(x, x.trunc(), "too few digits to compare with");
    x as i128
}

/// The largest distance per coordinate at a t, in units of 2⁻⁸⁰, exactly.
fn distance(given: &GivenRay, placed: &PlacedRay, frame: DVec3, t: f64) -> i128 {
    let axis = |k: usize| {
        let exact = whole(given.origin[k], 80) - whole(frame[k], 80)
            + whole(t, 20) * whole(given.dir[k], 60);
        let (origin, dir) = (
            f64::from(placed.ray.origin[k]),
            f64::from(placed.ray.dir[k]),
        );
        let traced = whole(origin, 80) + whole(t - placed.start, 20) * whole(dir, 60);
        (exact - traced).abs()
    };
    axis(0).max(axis(1)).max(axis(2))
}

#[test]
fn rays_from_anywhere_are_rounded_as_finely_as_the_mesh_and_at_most_by_the_reported_rounding() {
    let origin = DVec3::new(500_000.0, 4_649_776.0, 0.1);
    let scene = scene(origin);
    let frames = Frames::new(&scene, default_triangle_kernel(), u64::MAX);
    let mut random = Random::new(9);
    let rounded = |x: f64, exponent: i32| (x * 2f64.powi(exponent)).round() * 2f64.powi(-exponent);
    let mut moved = 0;
    for k in 0..4_000 {
        let dir = random.direction();
        let dir = DVec3::from_array(dir.to_array().map(|x| rounded(x, 40)));
        let t = 2f64.powi(k % 30);
        let target = origin + random.in_cube();
        let start = (target - t * dir).to_array().map(|x| rounded(x, 20));
        let given = given(DVec3::from_array(start), dir);
        let placed = frames.place(&given).expect("a ray");
        assert_eq!(placed.frame, FrameKind::Mesh, "0.1 is no f32 number");
        // Allows for rounding errors of the reported value itself.
        let reported = (placed.rounding * (1.0 + 1e-12) * 2f64.powi(80)) as i128;
        let [entry, exit] = Ball::around(&scene).reach(given.origin - origin, dir);
        let inset = 2f64.powi(-18);
        for t in [entry + inset, (entry + exit) / 2.0, exit - inset] {
            let t = rounded(t, 20).max(0.0);
            let found = distance(&given, &placed, origin, t);
            assert!(
                found <= reported,
                "{given:?} {placed:?} at {t}: {found} {reported}"
            );
        }
        // In and near the ball, coordinates relative to the mesh's origin are below 4: the start is rounded by
        // 2⁻²³, the direction by 2⁻²⁵ over at most 2 lengths. `WORTHWHILE` allows four times as much.
        assert!(
            placed.rounding < 4.0 * 2f64.powi(-22),
            "{given:?} {placed:?}"
        );
        moved += usize::from(placed.start != 0.0);
    }
    assert!(moved > 2_000, "{moved}");
}

#[test]
fn the_files_frame_is_used_if_it_rounds_less_and_fits_in_memory() {
    let scene = scene(DVec3::new(1000.0, 1.0, 1.0));
    let ray = given(DVec3::new(0.0, 1.0 - 1e-9, 1.5), DVec3::X);
    let tiny = given(DVec3::new(0.0, 1e-9, 1.5), DVec3::X);
    let with = |max_memory| Frames::new(&scene, default_triangle_kernel(), max_memory);
    let place = |max_memory, ray| {
        let placed = with(max_memory).place(ray).expect("a ray");
        (placed.frame, placed.rounding)
    };
    assert_eq!(place(u64::MAX, &tiny).0, FrameKind::File);
    assert!(place(u64::MAX, &tiny).1 < 1e-16);
    let (frame, rounding) = place(0, &tiny);
    assert_eq!(frame, FrameKind::Mesh);
    assert!((rounding - 1e-9).abs() < 1e-15, "{rounding}");
    // This one is the tiny number relative to the mesh's origin.
    assert_eq!(place(u64::MAX, &ray).0, FrameKind::Mesh);
}

#[test]
fn invalid_rays_are_refused() {
    let scene = scene(DVec3::splat(1000.0));
    let frames = Frames::new(&scene, default_triangle_kernel(), u64::MAX);
    let ray = given(DVec3::ZERO, DVec3::X);
    let place = |ray: GivenRay| frames.place(&ray).map(|placed| placed.rounding);
    let dir = |dir| place(GivenRay { dir, ..ray });
    assert_eq!(dir(DVec3::ZERO), Err(RayError::DirectionZero));
    assert_eq!(dir(DVec3::INFINITY), Err(RayError::DirectionNotFinite));
    for origin in [DVec3::NAN, DVec3::NEG_INFINITY] {
        assert_eq!(
            place(GivenRay { origin, ..ray }),
            Err(RayError::OriginNotFinite)
        );
    }
    for (t_min, t_max) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN)] {
        assert_eq!(
            place(GivenRay {
                t_min,
                t_max,
                ..ray
            }),
            Err(RayError::IntervalEmpty)
        );
    }
    // An origin beyond the range of f32, whose ray passes near the mesh.
    let far = place(given(DVec3::new(-1e39, 1000.25, 1000.25), DVec3::X));
    assert!(far.is_ok(), "{far:?}");
}

#[test]
fn a_mesh_without_triangles_is_missed_wherever_the_ray_starts() {
    let scene = Scene::new(TriangleMesh::default(), &Progress::default()).expect("never cancelled");
    let frames = Frames::new(&scene, default_triangle_kernel(), u64::MAX);
    for origin in [DVec3::ZERO, DVec3::splat(0.1), DVec3::splat(1e30)] {
        let placed = frames
            .place(&given(origin, DVec3::splat(0.1)))
            .expect("a ray");
        assert!(placed.rounding.is_finite(), "{placed:?}");
        assert!(!frames.intersector(&placed).any_hit(&placed.ray));
    }
}

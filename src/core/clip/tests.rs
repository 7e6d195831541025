//! Tests of clips: exact cases, both sides of planes, and numbers at the ends of f32.

use super::*;
use crate::random::Random;
use glam::Vec3;

fn ray(origin: Vec3, dir: Vec3) -> Ray {
    Ray::new(origin, dir).expect("a ray")
}

fn plane(normal: DVec3, offset: f64) -> Clip {
    Clip::plane(normal, offset).expect("a plane")
}

/// Both sides of a plane.
fn sides(normal: DVec3, offset: f64) -> [Clip; 2] {
    [plane(normal, offset), plane(-normal, -offset)]
}

fn keeps(clip: &Clip, ray: &Ray, t: f32) -> bool {
    clip.cut(ray).is_some_and(|cut| cut.kept.contains(t))
}

#[test]
fn planes_and_boxes_cut_rays_where_they_cross_them() {
    let down = ray(Vec3::new(0.0, 0.0, 3.0), -2.0 * Vec3::Z);
    // The planes are 1e-6 and 2e-6 thick in t.
    let (inside, outside) = (5e-7, 6e-6);
    // z ≤ 1 from t = 1 on.
    let cut = plane(DVec3::Z, 1.0).cut(&down).expect("a part");
    assert_eq!(cut.ray.t_min, cut.kept.after);
    assert_eq!(cut.ray.t_max, f32::INFINITY);
    assert!(cut.kept.contains(1.0 - inside) && !cut.kept.contains(1.0 - outside));
    // −1 ≤ z ≤ 1 to t = 2.
    let slab = Clip::axis_box(DVec3::splat(-1.0), DVec3::ONE).expect("a box");
    let cut = slab.cut(&down).expect("a part");
    assert!(cut.kept.contains(2.0 + inside) && !cut.kept.contains(2.0 + outside));
    let beside = ray(Vec3::new(2.0, 0.0, 3.0), -Vec3::Z);
    assert_eq!(slab.cut(&beside), None);
    // What isn't in the ray's interval isn't added.
    let short = Ray { t_max: 0.5, ..down };
    assert_eq!(slab.cut(&short), None);
}

#[test]
fn the_origin_decides_about_rays_parallel_to_a_plane() {
    for z in [0.5, 1.0, 1.5] {
        let along = ray(Vec3::new(0.0, 0.0, z), Vec3::new(1.0, -0.0, 0.0));
        let [below, above] = sides(DVec3::Z, 1.0).map(|clip| clip.cut(&along).is_some());
        assert_eq!([below, above], [z <= 1.0, z >= 1.0], "{z}");
    }
}

#[test]
fn each_f32_t_is_on_a_side_of_a_plane_and_on_both_only_near_it() {
    let mut random = Random::new(1);
    let vector = |random: &mut Random, scale: f64| (scale * random.in_cube()).as_vec3();
    for k in 0..200_000 {
        let scale = [1e-30, 1e-4, 1.0, 1e5, 1e30][k % 5];
        let origin = vector(&mut random, scale);
        let mut dir = vector(&mut random, 1.0);
        let mut normal = random.in_cube();
        if k % 3 == 0 {
            (dir, normal) = (dir.round(), (2.0 * normal).round());
        }
        let offset = scale * random.in_cube().x;
        let (Ok(given), true) = (Ray::new(origin, dir), normal != DVec3::ZERO) else {
            continue;
        };
        let [first, second] = sides(normal, offset);
        let t = normal.dot(origin.as_dvec3()) - offset;
        let t = (-t / normal.dot(dir.as_dvec3())) as f32;
        let near = [
            t.next_down(),
            t,
            t.next_up(),
            0.0,
            -1.0,
            1.0,
            f32::MAX,
            f32::MIN,
        ];
        for t in near.into_iter().filter(|t| t.is_finite()) {
            let line = Ray {
                t_min: f32::NEG_INFINITY,
                ..given
            };
            let kept = [&first, &second].map(|clip| keeps(clip, &line, t));
            assert!(kept[0] || kept[1], "{given:?} {normal} {offset} {t}");
            if kept == [true; 2] {
                let along = f64::from(t) * given.dir.as_dvec3();
                let distance = normal.dot(origin.as_dvec3() + along) - offset;
                let reach = origin.as_dvec3().abs() + along.abs();
                let size = normal.abs().dot(reach) + offset.abs();
                // Eighteen roundings, or a thousandth of the origin's distance.
                let bound = 2e-6 * size + 1.1e-3 * (offset - normal.dot(origin.as_dvec3())).abs();
                assert!(distance.abs() <= bound, "{given:?} {normal} {offset} {t}");
            }
        }
    }
}

#[test]
fn a_point_in_a_plane_is_kept_by_both_sides_and_by_two_boxes_with_a_common_face() {
    for (p, normal, offset) in [
        (DVec3::ZERO, DVec3::Z, 0.0),
        (DVec3::ONE, DVec3::new(1.0, -2.0, 1.0), 0.0),
        (DVec3::ONE, DVec3::new(0.0, -3.0, 1.0), -2.0),
        (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.3, 0.7, 0.11), 0.2),
    ] {
        let kept = sides(normal, offset).map(|clip| clip.keeps(p));
        let is_inside = (normal.dot(p) - offset).abs() < 1e-9;
        assert_eq!(kept == [true; 2], is_inside, "{p}");
        assert!(kept[0] || kept[1], "{p}");
        assert!(!plane(normal, offset).keeps(DVec3::NAN));
    }
    let cell = |x: f64| {
        let min = DVec3::new(x, 0.0, 0.0);
        Clip::axis_box(min, min + 1.0).expect("a box")
    };
    let through = ray(Vec3::new(-1.0, 0.5, 0.5), Vec3::X);
    for x in 0..7u8 {
        let x = f64::from(x) / 4.0 + 0.25;
        let count = [0.0, 1.0].map(|start| {
            let (cell, p) = (cell(start), DVec3::new(x, 0.5, 0.5));
            assert_eq!(cell.keeps(p), keeps(&cell, &through, x as f32 + 1.0), "{x}");
            u8::from(cell.keeps(p))
        });
        assert_eq!(count[0] + count[1], if x == 1.0 { 2 } else { 1 }, "{x}");
    }
}

#[test]
fn impossible_clips_are_refused_and_rays_with_a_nan_keep_nothing() {
    assert_eq!(Clip::plane(DVec3::ZERO, 1.0), Err(ClipError::NormalZero));
    let infinite = DVec3::new(1.0, f64::INFINITY, 0.0);
    assert_eq!(Clip::plane(infinite, 1.0), Err(ClipError::NotFinite));
    assert_eq!(Clip::plane(DVec3::NAN, 1.0), Err(ClipError::NotFinite));
    assert_eq!(Clip::plane(DVec3::X, f64::NAN), Err(ClipError::NotFinite));
    let tiny = DVec3::X * 1e-300;
    assert_eq!(Clip::plane(tiny, 1e30), Err(ClipError::NotFinite));
    let flat = Clip::axis_box(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
    assert_eq!(flat, Err(ClipError::BoxEmpty));
    let nan = Clip::axis_box(DVec3::NAN, DVec3::ONE);
    assert_eq!(nan, Err(ClipError::NotFinite));
    let good = ray(Vec3::ONE, Vec3::X);
    for bad in [
        Ray {
            origin: Vec3::NAN,
            ..good
        },
        Ray {
            dir: Vec3::NAN,
            ..good
        },
    ] {
        assert!(
            sides(DVec3::X, 0.0)
                .iter()
                .all(|clip| clip.cut(&bad).is_none())
        );
    }
}

#[test]
fn normals_of_any_length_give_the_same_plane() {
    let down = ray(Vec3::new(0.0, 0.0, 3.0), -Vec3::Z);
    let expected = plane(DVec3::Z, 1.0).cut(&down);
    for scale in [-1000, -20, 2, 1000].map(|power| 2f64.powi(power)) {
        assert_eq!(
            plane(DVec3::Z * scale, scale).cut(&down),
            expected,
            "{scale}"
        );
    }
}

#[test]
fn a_moved_clip_keeps_moved_points() {
    let by = DVec3::new(1e3, -2.0, 0.5);
    let slab = Clip::axis_box(DVec3::ZERO, DVec3::ONE).expect("a box");
    let moved = slab.moved(by).expect("finite");
    for p in [
        DVec3::splat(0.5),
        DVec3::splat(1.5),
        DVec3::ONE,
        DVec3::ZERO,
    ] {
        assert_eq!(moved.keeps(p + by), slab.keeps(p), "{p}");
    }
    let both = slab.and(plane(DVec3::X, 0.25));
    assert!(both.keeps(DVec3::splat(0.2)) && !both.keeps(DVec3::splat(0.3)));
    assert_eq!(both.half_spaces().len(), 7);
}

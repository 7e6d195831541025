//! Crossings against intervals computed in f64, and of unbounded operands.

use super::{crossings, intersector, scene_of};
use crate::shapes::ray_near;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::{Cylinder, Plane, Quadric, Sphere};

/// The interval of a line inside a ball, in f64.
fn inside_ball(ray: &Ray, sphere: &Sphere) -> Option<[f64; 2]> {
    let (d, f) = (
        ray.dir.as_dvec3(),
        ray.origin.as_dvec3() - sphere.centre.as_dvec3(),
    );
    let nearest = f - d * (f.dot(d) / d.length_squared());
    let r = f64::from(sphere.radius);
    let half = ((r * r - nearest.length_squared()) / d.length_squared()).sqrt();
    let middle = -f.dot(d) / d.length_squared();
    (half > 0.0).then_some([middle - half, middle + half])
}

/// The ends in a tree of two operations, ((a, b), c), found by testing the middle of every gap between ends.
fn expected(intervals: &[Option<[f64; 2]>; 3], [inner, outer]: [CsgOperation; 2]) -> Vec<f64> {
    let apply = |operation, a: bool, b: bool| match operation {
        CsgOperation::Union => a || b,
        CsgOperation::Intersection => a && b,
        CsgOperation::Difference => a && !b,
    };
    let is_inside = |t: f64| {
        let at = |k: usize| intervals[k].is_some_and(|[start, end]| start < t && t < end);
        apply(outer, apply(inner, at(0), at(1)), at(2))
    };
    let mut ends: Vec<f64> = intervals.iter().flatten().flatten().copied().collect();
    ends.sort_by(f64::total_cmp);
    let beyond = |k: usize| match k {
        0 => ends[0] - 1.0,
        k if k == ends.len() => ends[k - 1] + 1.0,
        k => 0.5 * (ends[k - 1] + ends[k]),
    };
    let turns = |k: &usize| is_inside(beyond(*k)) != is_inside(beyond(k + 1));
    (0..ends.len()).filter(turns).map(|k| ends[k]).collect()
}

#[test]
fn crossings_are_those_of_the_combined_intervals() {
    /// A bound for chords longer than `CHORD`. The fast kernel errs most: it computes half a chord h by
    /// h² = r² − (l·l − s²), where l and s are at most 5. With u = 2⁻²⁴, l·l errs by 3u·25 and s by 5.5u·5, so s² by
    /// 275u; hence h by 350u / 2h < 8.4e-5. s itself, the middle of the chord, errs by 28u.
    const ERROR: f64 = 1e-4;
    const CHORD: f64 = 0.25;
    let mut random = Random::new(1);
    for tier in [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact] {
        let mut count = 0;
        for _ in 0..300 {
            let spheres = [(); 3].map(|()| Sphere {
                centre: (0.6 * random.in_cube()).as_vec3(),
                radius: 0.3 + 0.7 * random.unit() as f32,
            });
            let operations = [random.index(3), random.index(3)].map(|k| CsgOperation::ALL[k]);
            let [a, b, c] = spheres.map(Solid::of);
            let inner = Solid::combined(operations[0], vec![a, b]);
            let scene = scene_of(vec![Solid::combined(operations[1], vec![inner, c])]);
            let intersector = intersector(&scene, tier);
            for _ in 0..20 {
                let ray = ray_near(&mut random, Vec3::ZERO, 1.0, 4.0);
                let intervals = [0, 1, 2].map(|k| inside_ball(&ray, &spheres[k]));
                let expected = expected(&intervals, operations);
                let is_clear = intervals.iter().flatten().all(|[a, b]| b - a > CHORD)
                    && expected
                        .windows(2)
                        .all(|pair| pair[1] - pair[0] > 2.0 * ERROR);
                let found = intersector.all_hits(&ray);
                if is_clear && expected.iter().all(|&t| t > 0.0) {
                    assert_eq!(found.len(), expected.len(), "{tier:?} {ray:?} {spheres:?}");
                    for (crossing, t) in found.iter().zip(&expected) {
                        let error = (f64::from(crossing.hit.t) - t).abs();
                        assert!(error < ERROR, "{tier:?} {error}");
                    }
                    count += expected.len();
                }
                let nearest = intersector.closest_hit(&ray);
                assert_eq!(nearest, found.first().map(|crossing| crossing.hit));
                assert_eq!(intersector.any_hit(&ray), nearest.is_some());
            }
        }
        assert!(count > 3000, "{tier:?}: {count}");
    }
}

#[test]
fn half_spaces_and_quadrics_are_solids_and_subtracted_normals_point_outwards() {
    let ground = Plane {
        point: Vec3::ZERO,
        normal: Vec3::Z,
    };
    let [mut bowl, mut rod] = [[0.0; 10]; 2];
    // z = x² + y² and x² + y² = 1/4.
    (bowl[0], bowl[1], bowl[8]) = (1.0, 1.0, -0.5);
    (rod[0], rod[1], rod[9]) = (1.0, 1.0, -0.25);
    let quadric = |coefficients| Quadric {
        coefficients,
        centre: Vec3::ZERO,
        half: Vec3::ONE,
    };
    let drilled = Solid::combined(
        CsgOperation::Difference,
        vec![Solid::of(ground), Solid::of_quadric(quadric(rod))],
    );
    let filled = Solid::of_quadric(quadric(bowl));
    for tier in [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact] {
        let scene = scene_of(vec![drilled.clone()]);
        assert!(scene.groups()[0].bounds().is_empty());
        let drilled = intersector(&scene, tier);
        let down = [0.0, 0.0, -1.0];
        assert_eq!(
            crossings(&*drilled, [0.25, 0.0, 2.0], down),
            [3.0],
            "{tier:?}"
        );
        assert_eq!(
            crossings(&*drilled, [0.75, 0.0, 2.0], down),
            [2.0],
            "{tier:?}"
        );
        let across = Ray::new(Vec3::new(0.0, 0.0, -0.5), Vec3::X).expect("a ray");
        let hit = drilled.closest_hit(&across).expect("the wall of the hole");
        assert_eq!(hit.t, 0.5);
        let normal = scene.surface(&across, &hit).normal;
        // All numbers are exact.
        assert_eq!(normal, DVec3::NEG_X);

        let scene = scene_of(vec![filled.clone()]);
        let filled = intersector(&scene, tier);
        // The ray enters through the box's upper side and leaves where z = x².
        let slanted = [0.5, 0.0, -1.0];
        for (origin, expected) in [
            ([0.0, 0.0, 2.0], vec![1.0, 12f64.sqrt() - 2.0]),
            ([0.0, 0.0, 0.5], vec![6f64.sqrt() - 2.0]),
        ] {
            let found = crossings(&*filled, origin, slanted);
            assert_eq!(found.len(), expected.len(), "{tier:?} {found:?}");
            for (t, expected) in found.iter().zip(expected) {
                // Ten roundings of numbers below 4, of 2⁻²³ each, over the slope of the equation at its root, 1.2.
                let error = (f64::from(*t) - expected).abs();
                assert!(error < 1e-6, "{tier:?} {t} {expected}");
            }
        }
    }
}

#[test]
fn a_crossing_far_beyond_the_scene_changes_nothing_near_it() {
    let mut bowl = [0.0; 10];
    (bowl[0], bowl[1], bowl[8]) = (1.0, 1.0, -0.5);
    let bowl = Quadric {
        coefficients: bowl,
        centre: Vec3::ZERO,
        half: Vec3::ONE,
    };
    // The ray also crosses the unbounded surface at 10³².
    let nearly_down = [6.1e-17, 0.0, -1.0];
    for tier in [Tier::Precise, Tier::Exact] {
        let scene = scene_of(vec![Solid::of_quadric(bowl)]);
        let found = crossings(&*intersector(&scene, tier), [0.5, 0.0, 2.0], nearly_down);
        assert_eq!(found, [1.0, 1.75], "{tier:?}");
    }
}

#[test]
fn an_open_surface_encloses_nothing() {
    let open = Cylinder {
        p0: Vec3::ZERO,
        p1: Vec3::Z,
        radius: 1.0,
        is_capped: false,
    };
    let scene = scene_of(vec![Solid::of(open)]);
    let exact = intersector(&scene, Tier::Exact);
    assert_eq!(
        crossings(&*exact, [-2.0, 0.0, 0.5], [1.0, 0.0, 0.0]),
        [0.0; 0]
    );
}

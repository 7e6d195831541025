//! Combined solids: crossings against intervals computed in f64, and rays along coinciding and touching surfaces.

use super::ray_near;
use glam::{DVec3, Vec3};
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::kernel::Tier;
use hitscope_core::mesh::{Runs, TriangleMesh};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::{Cone, Cuboid, Cylinder, LineDetail, Plane, Quadric, Sphere, Torus};
use hitscope_core::{Intersector, Ray, Scene};

const OPERATIONS: [CsgOperation; 3] = [
    CsgOperation::Union,
    CsgOperation::Intersection,
    CsgOperation::Difference,
];

fn scene_of(solids: Vec<Solid>) -> Scene {
    let mut scene = scene(TriangleMesh::default());
    let added = scene.add_solids(solids, Runs::default(), &Progress::default());
    added.expect("nobody cancels");
    scene
}

fn intersector(scene: &Scene, tier: Tier) -> Box<dyn Intersector> {
    let kernel = hitscope_core::group::kernel_named(tier.name());
    scene.intersector(kernel.expect("a tier"))
}

fn cube(min: Vec3, max: Vec3) -> Cuboid {
    let half = 0.5 * (max - min);
    Cuboid {
        centre: 0.5 * (min + max),
        axes: [half.x * Vec3::X, half.y * Vec3::Y, half.z * Vec3::Z],
    }
}

/// t of all crossings.
fn crossings(intersector: &dyn Intersector, origin: [f32; 3], dir: [f32; 3]) -> Vec<f32> {
    let ray = Ray::new(origin.into(), dir.into()).expect("a ray");
    let hits = intersector.all_hits(&ray);
    hits.iter().map(|crossing| crossing.hit.t).collect()
}

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
            let operations = [random.index(3), random.index(3)].map(|k| OPERATIONS[k]);
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
fn a_point_that_only_touches_an_operand_is_no_surface() {
    let ball = Sphere {
        centre: Vec3::Y,
        radius: 1.0,
    };
    let below = cube(Vec3::new(-2.0, -3.0, -2.0), Vec3::new(2.0, -1.0, 2.0));
    let tube = Torus {
        centre: Vec3::ZERO,
        axis: Vec3::Y,
        major: 4.0,
        minor: 1.0,
    };
    let both = vec![Solid::of(below), Solid::of(ball)];
    for (solid, y) in [
        (Solid::combined(CsgOperation::Union, both), 0.0),
        // The ray touches the tube along its top circle twice.
        (Solid::of(tube), 1.0),
    ] {
        let scene = scene_of(vec![solid]);
        let exact = intersector(&scene, Tier::Exact);
        let along_x = crossings(&*exact, [-8.0, y, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(along_x, [0.0; 0]);
    }
}

#[test]
fn coinciding_faces_are_decided_exactly() {
    let whole = cube(Vec3::ZERO, Vec3::ONE);
    let upper = cube(Vec3::new(0.0, 0.0, 0.5), Vec3::new(1.0, 1.0, 1.0));
    let next = cube(Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 1.0, 2.0));
    let along_z = |operation, solids| {
        let scene = scene_of(vec![Solid::combined(operation, solids)]);
        let exact = intersector(&scene, Tier::Exact);
        crossings(&*exact, [0.25, 0.75, -1.0], [0.0, 0.0, 1.0])
    };
    let two = |a: Cuboid, b: Cuboid| vec![Solid::of(a), Solid::of(b)];
    assert_eq!(
        along_z(CsgOperation::Difference, two(whole, upper)),
        [1.0, 1.5]
    );
    assert_eq!(
        along_z(CsgOperation::Difference, two(whole, whole)),
        [0.0; 0]
    );
    assert_eq!(along_z(CsgOperation::Union, two(whole, next)), [1.0, 3.0]);
    assert_eq!(
        along_z(CsgOperation::Intersection, two(whole, next)),
        [0.0; 0]
    );
    assert_eq!(
        along_z(CsgOperation::Intersection, two(whole, upper)),
        [1.5, 2.0]
    );
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
fn a_ray_through_the_apex_of_a_cone_crosses_it() {
    let cone = Cone {
        p0: Vec3::ZERO,
        p1: Vec3::Z,
        radius: 1.0,
        is_capped: true,
    };
    let scene = scene_of(vec![Solid::of(cone)]);
    let exact = intersector(&scene, Tier::Exact);
    assert_eq!(
        crossings(&*exact, [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]),
        [2.0, 3.0]
    );
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
fn where_surfaces_coincide_the_one_that_faces_the_ray_counts() {
    // The ray goes down a hole that ends where another cube begins.
    let whole = cube(Vec3::new(-1.0, -1.0, 0.0), Vec3::ONE);
    let hole = cube(Vec3::new(-0.5, -0.5, -1.0), Vec3::new(0.5, 0.5, 2.0));
    let below = cube(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 0.0));
    let [whole, hole, below] = [whole, hole, below].map(Solid::of);
    let drilled = Solid::combined(CsgOperation::Difference, vec![whole, hole]);
    let scene = scene_of(vec![Solid::combined(
        CsgOperation::Union,
        vec![drilled, below],
    )]);
    let ray = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
    let hit = intersector(&scene, Tier::Exact)
        .closest_hit(&ray)
        .expect("the bottom");
    assert_eq!(hit.t, 3.0);
    assert_eq!(scene.surface(&ray, &hit).normal, DVec3::Z);
}

#[test]
fn a_coinciding_surface_that_bounds_nothing_is_not_hit() {
    // The ray enters both boxes at z = 1; the first one is cut away there.
    let cut = cube(Vec3::new(-1.0, -1.0, 0.0), Vec3::ONE);
    let left = Plane {
        point: Vec3::ZERO,
        normal: Vec3::X,
    };
    let ball = Sphere {
        centre: Vec3::new(0.5, 0.0, 0.5),
        radius: 0.5,
    };
    let half = vec![Solid::of(cut), Solid::of(left)];
    let half = Solid::combined(CsgOperation::Intersection, half);
    let scene = scene_of(vec![Solid::combined(
        CsgOperation::Union,
        vec![half, Solid::of(ball)],
    )]);
    let ray = Ray::new(Vec3::new(0.5, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
    let hit = intersector(&scene, Tier::Exact)
        .closest_hit(&ray)
        .expect("the ball");
    // The third operand.
    assert_eq!((hit.t, hit.v), (2.0, 2.0));
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

#[test]
fn lines_end_at_the_seam_of_two_operands() {
    let whole = cube(-Vec3::ONE, Vec3::ONE);
    let dent = Sphere {
        centre: Vec3::Z,
        radius: 0.51,
    };
    let both = vec![Solid::of(whole), Solid::of(dent)];
    let scene = scene_of(vec![Solid::combined(CsgOperation::Difference, both)]);
    let detail = LineDetail {
        segments: 64,
        around: scene.bounds(),
    };
    let (mut nearest, mut sees_dent) = (f64::INFINITY, false);
    scene.groups()[0].lines(0, &detail, &mut |line| {
        for point in line {
            let p = point.position;
            sees_dent |= p.z < 0.99 && p.length() < 0.9;
            // The middle line of the upper side.
            if p.z == 1.0 && p.y == 0.0 {
                nearest = nearest.min(p.x.abs());
            }
        }
    });
    // The line of length 2 has 64 pieces, of which the one at the seam is halved ten times; points are rounded to f32.
    let slack = 2.0 / 64.0 / 1024.0 + 1e-6;
    assert!((nearest - 0.51).abs() < slack, "{nearest}");
    assert!(sees_dent);
}

#[test]
fn the_size_of_a_packed_solid_includes_its_operands() {
    let ball = |x: f32| {
        Solid::of(Sphere {
            centre: x * Vec3::X,
            radius: 1.0,
        })
    };
    let bytes = |count: u8| {
        let balls = (0..count).map(|x| ball(x.into())).collect();
        let scene = scene_of(vec![Solid::combined(CsgOperation::Union, balls)]);
        intersector(&scene, Tier::Watertight).bytes()
    };
    let [one, two, three] = [1, 2, 3].map(bytes);
    assert_eq!(three - two, two - one);
    // The operand itself, its packed sphere of four numbers, and its tree.
    assert!(two - one > 100, "{}", two - one);
}

#[test]
fn many_solids_in_a_tree_give_the_nearest_of_each() {
    let mut random = Random::new(5);
    let dented = |random: &mut Random| {
        let centre = (4.0 * random.in_cube()).as_vec3();
        let ball = |centre, radius| Solid::of(Sphere { centre, radius });
        let dent = centre + 0.3 * random.direction().as_vec3();
        Solid::combined(
            CsgOperation::Difference,
            vec![ball(centre, 0.3), ball(dent, 0.2)],
        )
    };
    let solids: Vec<Solid> = (0..60).map(|_| dented(&mut random)).collect();
    let all = scene_of(solids.clone());
    let each: Vec<Scene> = solids
        .iter()
        .map(|solid| scene_of(vec![solid.clone()]))
        .collect();
    for tier in [Tier::Watertight, Tier::Exact] {
        let together = intersector(&all, tier);
        let alone: Vec<_> = each.iter().map(|scene| intersector(scene, tier)).collect();
        for _ in 0..500 {
            let ray = ray_near(&mut random, Vec3::ZERO, 4.0, 2.0);
            let hits = alone.iter().filter_map(|one| one.closest_hit(&ray));
            let nearest = hits.map(|hit| hit.t).min_by(f32::total_cmp);
            assert_eq!(together.closest_hit(&ray).map(|hit| hit.t), nearest);
        }
    }
}

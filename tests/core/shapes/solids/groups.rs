//! Groups of solids: their tree, memory and wireframe.

use super::{cube, intersector, scene_of};
use crate::shapes::ray_near;
use glam::Vec3;
use hitscope_core::Scene;
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::{LineDetail, Sphere};

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
        view: None,
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
fn a_difference_of_equal_shapes_has_no_lines() {
    let ball = || {
        Solid::of(Sphere {
            centre: Vec3::new(0.3, -0.2, 0.7),
            radius: 1.1,
        })
    };
    let lines_of = |operation: CsgOperation| {
        let scene = scene_of(vec![Solid::combined(operation, vec![ball(), ball()])]);
        let detail = LineDetail {
            segments: 64,
            around: scene.bounds(),
            view: None,
        };
        let mut count = 0;
        scene.groups()[0].lines(0, &detail, &mut |_| count += 1);
        count
    };
    assert_eq!(lines_of(CsgOperation::Difference), 0);
    assert!(lines_of(CsgOperation::Union) > 0);
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

//! Tests of crossings: intervals against exact numbers, and known answers.

use super::super::algebraic::Algebraic;
use super::super::crossing::{AlgebraCounters, Crossing, CrossingSolver};
use super::super::dyadic::Dyadic;
use super::super::pieces::Pieces;
use super::shapes::{Cylinder, Sphere, Torus};
use crate::random::Random;
use crate::ray::Ray;
use glam::Vec3;
use std::cmp::Ordering;

fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
    let (lo, hi) = (f32::NEG_INFINITY, f32::INFINITY);
    Ray::with_interval(origin.into(), dir.into(), lo, hi).expect("a ray")
}

/// Checks that intervals and exact numbers agree about one ray, and adds to the counters.
fn check<P: Pieces>(shape: &P, ray: &Ray, work: &mut AlgebraCounters) -> Vec<Crossing> {
    let mut solver = CrossingSolver::new(ray);
    let mut found = solver.crossings(shape);
    work.pieces += solver.work.pieces;
    work.exact_pieces += solver.work.exact_pieces;
    work.exact_roots += solver.work.exact_roots;
    let mut exact = solver.exact_crossings(shape);
    assert_eq!(found.len(), exact.len(), "{ray:?}");
    for (a, b) in found.iter_mut().zip(&mut exact) {
        assert_eq!(a.part(), b.part(), "{ray:?}");
        assert_eq!(a.is_tangent(), b.is_tangent(), "{ray:?}");
        let (bounds, t) = (a.t(), b.t());
        assert!(
            bounds.lo <= t.hi && t.lo <= bounds.hi,
            "{ray:?}: {bounds:?} {t:?}"
        );
        assert_eq!(
            solver.t_in_f32(shape, a),
            solver.t_in_f32(shape, b),
            "{ray:?}"
        );
    }
    found
}

/// A ray from a random origin, at one of many distances, to a random point near the shape.
fn random_ray(random: &mut Random, size: f64) -> Ray {
    loop {
        let target = random.in_cube() * size * 1.5;
        let origin = random.in_cube() * size * 10f64.powi(random.index(5) as i32);
        let dir = (target - origin) * 2f64.powi(random.index(8) as i32 - 4);
        let start = if random.index(4) == 0 {
            0.25
        } else {
            f32::NEG_INFINITY
        };
        let ray = Ray::with_interval(origin.as_vec3(), dir.as_vec3(), start, f32::INFINITY);
        // Numbers of unusual size may underflow to a zero direction, or overflow.
        if let Ok(ray) = ray {
            return ray;
        }
    }
}

fn share_undecided(work: AlgebraCounters) -> f64 {
    (work.exact_pieces + work.exact_roots) as f64 / work.pieces as f64
}

#[test]
fn intervals_agree_with_exact_numbers_about_spheres() {
    let mut random = Random::new(10);
    let mut work = AlgebraCounters::default();
    let mut hit_count = 0;
    for _ in 0..60_000 {
        let sphere = Sphere {
            centre: random.in_cube().as_vec3(),
            radius: random.unit() as f32,
        };
        let ray = random_ray(&mut random, 1.0);
        hit_count += usize::from(!check(&sphere, &ray, &mut work).is_empty());
    }
    assert!(hit_count > 5000, "{hit_count}");
    assert!(share_undecided(work) < 0.001, "{work:?}");
}

#[test]
fn intervals_agree_with_exact_numbers_about_tori() {
    let mut random = Random::new(11);
    let mut work = AlgebraCounters::default();
    let mut by_count = [0; 5];
    for _ in 0..15_000 {
        let torus = Torus {
            centre: random.in_cube().as_vec3(),
            axis: random.in_cube().as_vec3(),
            major: 1.0,
            minor: (0.01 + random.unit()) as f32,
        };
        let ray = random_ray(&mut random, 1.0);
        by_count[check(&torus, &ray, &mut work).len()] += 1;
    }
    assert!(by_count[2] > 1000 && by_count[4] > 100, "{by_count:?}");
    assert!(share_undecided(work) < 0.02, "{work:?}");
}

#[test]
fn intervals_agree_with_exact_numbers_about_cylinders() {
    let mut random = Random::new(12);
    let mut work = AlgebraCounters::default();
    for case in 0..15_000 {
        let axis = if case % 3 == 0 {
            Vec3::Z
        } else {
            random.in_cube().as_vec3()
        };
        let cylinder = Cylinder {
            base: random.in_cube().as_vec3(),
            axis,
            radius: random.unit() as f32,
        };
        let mut ray = random_ray(&mut random, 1.0);
        if case % 5 == 0 {
            ray.dir = axis;
        }
        check(&cylinder, &ray, &mut work);
    }
    assert!(share_undecided(work) < 0.1, "{work:?}");
}

/// A ray on integers: its tangency and equal roots are exact.
fn integer_ray(random: &mut Random, size: usize) -> Ray {
    let mut point = || [(); 3].map(|()| random.index(2 * size + 1) as f32 - size as f32);
    let origin = point();
    let dir = loop {
        let dir = point();
        if dir != [0.0; 3] {
            break dir;
        }
    };
    ray(origin, dir)
}

#[test]
fn tangent_and_nearly_tangent_rays_are_decided_as_exact_numbers_decide_them() {
    let mut random = Random::new(13);
    let mut work = AlgebraCounters::default();
    let mut tangent_count = 0;
    for case in 0..12_000 {
        let mut ray = integer_ray(&mut random, 4);
        match case % 3 {
            0 => {}
            1 => ray.origin.x = ray.origin.x.next_up(),
            _ => ray.dir.y = ray.dir.y.next_down(),
        }
        let sphere = Sphere {
            centre: Vec3::X,
            radius: 1.0 + (case % 2) as f32,
        };
        let torus = Torus {
            centre: Vec3::ZERO,
            axis: Vec3::Z,
            major: 3.0,
            minor: 1.0,
        };
        let cylinder = Cylinder {
            base: -Vec3::Y,
            axis: 2.0 * Vec3::Y,
            radius: 2.0,
        };
        let mut found = check(&sphere, &ray, &mut work);
        found.extend(check(&cylinder, &ray, &mut work));
        if case % 3 == 0 {
            found.extend(check(&torus, &ray, &mut work));
        }
        tangent_count += found
            .iter()
            .filter(|crossing| crossing.is_tangent())
            .count();
    }
    assert!(tangent_count > 100, "{tangent_count}");
    assert!(work.exact_pieces > 500, "{work:?}");
}

#[test]
fn plain_rays_are_decided_by_intervals() {
    let mut random = Random::new(14);
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let torus = Torus {
        centre: Vec3::ZERO,
        axis: Vec3::Z,
        major: 1.0,
        minor: 0.25,
    };
    let mut works = [AlgebraCounters::default(); 2];
    for _ in 0..100_000 {
        let ray = random_ray(&mut random, 1.0);
        let mut solver = CrossingSolver::new(&ray);
        solver.crossings(&sphere);
        works[0].pieces += solver.work.pieces;
        works[0].exact_pieces += solver.work.exact_pieces + solver.work.exact_roots;
        let mut solver = CrossingSolver::new(&ray);
        solver.crossings(&torus);
        works[1].pieces += solver.work.pieces;
        works[1].exact_pieces += solver.work.exact_pieces + solver.work.exact_roots;
    }
    assert!(
        share_undecided(works[0]) < 0.001 && share_undecided(works[1]) < 0.02,
        "{works:?}"
    );
}

#[test]
fn huge_tiny_and_far_shapes_are_decided_as_exact_numbers_decide_them() {
    let mut random = Random::new(15);
    let mut work = AlgebraCounters::default();
    for _ in 0..300 {
        for size in [1e-44, 1e-38, 1e-30, 1e-10, 1e10, 1e30, 1e37] {
            let sphere = Sphere {
                centre: (random.in_cube() * size).as_vec3(),
                radius: size as f32,
            };
            let ray = random_ray(&mut random, size);
            check(&sphere, &ray, &mut work);
            let torus = Torus {
                centre: sphere.centre,
                axis: Vec3::new(1.0, 2.0, -3.0),
                major: sphere.radius,
                minor: 0.3 * sphere.radius,
            };
            check(&torus, &ray, &mut work);
        }
    }
}

#[test]
fn crossings_at_one_t_are_merged_into_the_lowest_part() {
    // Through the rim, where the side and a cap meet.
    let cylinder = Cylinder {
        base: Vec3::ZERO,
        axis: Vec3::Z,
        radius: 1.0,
    };
    let mut work = AlgebraCounters::default();
    let found = check(
        &cylinder,
        &ray([0.0, 0.0, -1.0], [1.0, 0.0, 1.0]),
        &mut work,
    );
    assert_eq!(found.iter().map(Crossing::part).collect::<Vec<_>>(), [0]);
    let found = check(
        &cylinder,
        &ray([-2.0, 0.0, 0.5], [1.0, 0.0, 0.5]),
        &mut work,
    );
    assert_eq!(found.iter().map(Crossing::part).collect::<Vec<_>>(), [0]);
    // Along the axis the side has no crossing.
    let found = check(
        &cylinder,
        &ray([0.5, 0.0, 4.0], [0.0, 0.0, -1.0]),
        &mut work,
    );
    assert_eq!(found.iter().map(Crossing::part).collect::<Vec<_>>(), [2, 1]);
}

#[test]
fn the_rays_interval_is_open_and_compared_exactly() {
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    for (start, end, count) in [
        (1.0, 3.0, 0),
        (1.0f32.next_down(), 3.0f32.next_up(), 2),
        (1.0f32.next_down(), 3.0, 1),
        (1.0, 3.0f32.next_up(), 1),
        (f32::NEG_INFINITY, f32::INFINITY, 2),
        (1.5, 2.5, 0),
    ] {
        let ray = Ray::with_interval(Vec3::X * -2.0, Vec3::X, start, end).unwrap();
        let found = check(&sphere, &ray, &mut AlgebraCounters::default());
        assert_eq!(found.len(), count, "{start} {end}");
    }
}

#[test]
fn crossings_of_different_shapes_are_compared_exactly() {
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let torus = Torus {
        centre: Vec3::ZERO,
        axis: 2.0 * Vec3::Z,
        major: 0.75,
        minor: 0.25,
    };
    let slightly_larger = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0f32.next_up(),
    };
    // The outer equator of the torus lies on the sphere, at an irrational t.
    let ray = ray([-3.0, -1.0, 0.0], [3.0, 1.25, 0.0]);
    let mut solver = CrossingSolver::new(&ray);
    let mut on_sphere = solver.crossings(&sphere);
    let mut on_torus = solver.crossings(&torus);
    let mut on_larger = solver.crossings(&slightly_larger);
    assert_eq!(
        [on_sphere.len(), on_torus.len(), on_larger.len()],
        [2, 4, 2]
    );
    let [a, b, c] = [&mut on_sphere[0], &mut on_torus[0], &mut on_larger[0]];
    assert_eq!(solver.compare((&sphere, a), (&torus, b)), Ordering::Equal);
    assert_eq!(
        solver.compare((&sphere, a), (&slightly_larger, c)),
        Ordering::Greater
    );
    let t = solver.t_in_f64(&sphere, a);
    assert_eq!(solver.t_in_f64(&torus, b), t);
    for (number, order) in [(t - 1e-15, Ordering::Greater), (t + 1e-15, Ordering::Less)] {
        assert_eq!(solver.compare_with_number(&sphere, a, number), order);
        let mut ratio = Algebraic::ratio(&Dyadic::from(number), &Dyadic::from(1)).unwrap();
        assert_eq!(solver.compare_with(&torus, b, &mut ratio), order);
    }
}

#[test]
fn crossings_closer_than_any_float_are_kept_apart_and_in_order() {
    let centre = Vec3::X * 1e6;
    let torus = Torus {
        centre,
        axis: Vec3::Z,
        major: 1e-11,
        minor: 0.25e-11,
    };
    let ray = ray([0.0; 3], [1.0, 0.0, 0.0]);
    let mut found = check(&torus, &ray, &mut AlgebraCounters::default());
    assert_eq!(found.len(), 4);
    let mut solver = CrossingSolver::new(&ray);
    for i in 0..3 {
        let [a, b] = &mut found[i..i + 2] else {
            panic!("two crossings");
        };
        assert_eq!(solver.compare((&torus, a), (&torus, b)), Ordering::Less);
        assert_eq!(solver.t_in_f64(&torus, a), 1e6);
        let expected = if i < 2 {
            Ordering::Less
        } else {
            Ordering::Greater
        };
        assert_eq!(solver.compare_with_number(&torus, a, 1e6), expected);
    }
}

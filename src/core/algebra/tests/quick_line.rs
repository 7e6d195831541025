//! Tests of roots in plain f64 against exact numbers.

use super::super::crossing::CrossingSolver;
use super::super::interval_roots::RootIntervals;
use super::super::pieces::Pieces;
use super::super::quick_line::QuickLine;
use crate::random::Random;
use crate::ray::Ray;
use crate::shape::Sphere;
use glam::DVec3;
use std::cmp::Ordering;
use std::fmt::Debug;

/// A sphere, and a line that passes its surface at a distance of 1 to 10⁻¹⁵ radii on either side, from up to 10⁵ radii away.
fn near_miss(random: &mut Random) -> Option<(Sphere, Ray)> {
    let scale = 2f64.powi(random.index(81) as i32 - 40);
    let radius = (scale * (0.1 + random.unit())) as f32;
    let sphere = Sphere {
        centre: (scale * random.in_cube()).as_vec3(),
        radius,
    };
    let across = random.direction();
    let along = random.direction().cross(across);
    let gap = 10f64.powi(-(random.index(16) as i32)) * (random.unit() - 0.5);
    let beside = sphere.centre.as_dvec3() + f64::from(radius) * (1.0 + gap) * across;
    let away = f64::from(radius) * 10f64.powi(random.index(6) as i32) * random.unit();
    let origin: DVec3 = beside - away * along;
    let dir = along * 2f64.powi(random.index(41) as i32 - 20);
    let (start, end) = (f32::NEG_INFINITY, f32::INFINITY);
    let ray = Ray::with_interval(origin.as_vec3(), dir.as_vec3(), start, end);
    Some((sphere, ray.ok()?))
}

/// Requires that the bounds of quick roots contain the exact crossings, one each.
pub(super) fn require_exact<P: Pieces + Debug>(shape: &P, ray: &Ray, roots: &RootIntervals) {
    let mut solver = CrossingSolver::new(ray);
    let mut exact = solver.exact_crossings(shape);
    assert_eq!(exact.len(), roots.len(), "{shape:?} {ray:?}");
    for (crossing, bounds) in exact.iter_mut().zip(roots.iter()) {
        let mut order = |t: f64| solver.compare_with_number(shape, crossing, t);
        assert_ne!(order(bounds.lo), Ordering::Less, "{shape:?} {ray:?}");
        assert_ne!(order(bounds.hi), Ordering::Greater, "{shape:?} {ray:?}");
    }
}

#[test]
fn quick_roots_contain_the_exact_roots_of_nearly_tangent_lines() {
    let mut random = Random::new(40);
    let mut decided = [0; 3];
    for _ in 0..60_000 {
        let Some((sphere, ray)) = near_miss(&mut random) else {
            continue;
        };
        let Some(roots) = sphere.quick_roots(&QuickLine::of(&ray)) else {
            continue;
        };
        decided[roots.len()] += 1;
        require_exact(&sphere, &ray, &roots);
    }
    assert!(decided[0] > 20_000 && decided[2] > 20_000, "{decided:?}");
}

#[test]
fn the_first_crossing_is_the_first_of_all_crossings() {
    let mut random = Random::new(41);
    let mut hit_count = 0;
    for _ in 0..20_000 {
        let Some((sphere, line)) = near_miss(&mut random) else {
            continue;
        };
        // Half of the intervals start near the sphere, or in it.
        let middle = (sphere.centre - line.origin).dot(line.dir) / line.dir.length_squared();
        let start = if random.index(2) == 0 { 0.0 } else { middle };
        let Ok(ray) = Ray::with_interval(line.origin, line.dir, start, f32::INFINITY) else {
            continue;
        };
        let mut solver = CrossingSolver::new(&ray);
        let all = solver.exact_crossings(&sphere);
        let first = solver.first(&sphere);
        assert_eq!(first.is_some(), !all.is_empty(), "{sphere:?} {ray:?}");
        if let (Some(mut first), Some(mut exact)) = (first, all.into_iter().next()) {
            hit_count += 1;
            let t = solver.t_in_f32(&sphere, &mut first);
            assert_eq!(
                t,
                solver.t_in_f32(&sphere, &mut exact),
                "{sphere:?} {ray:?}"
            );
        }
    }
    assert!(hit_count > 5000, "{hit_count}");
}

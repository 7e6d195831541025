//! Tests of crossings with rectangles and disks in plain f64 against exact numbers.

use super::super::pieces::Pieces;
use super::super::quick_line::QuickLine;
use super::quick_line::require_exact;
use crate::random::Random;
use crate::ray::Ray;
use crate::shape::{Disk, Rectangle, Span};
use glam::DVec3;
use std::fmt::Debug;

/// A centre and half axes, and a line that crosses their plane near the border of the rectangle or the ellipse.
///
/// The lengths of the half axes are from 10⁻²⁴ to 10²⁴, and the half axes may be almost parallel. The crossing is 1 to
/// 10⁻¹⁵ half axes inside or outside of the border. The line may be almost parallel to the plane.
fn near_border(random: &mut Random, is_ellipse: bool) -> Option<(Span, Ray)> {
    let scale = 10f64.powi(random.index(49) as i32 - 24);
    let small = |random: &mut Random| 10f64.powi(-(random.index(8) as i32));
    let u = scale * random.direction();
    let skew = small(random);
    let v = (1.0 - skew) * u * random.unit() + skew * scale * random.direction();
    let distance = 10f64.powi(random.index(6) as i32 - 2);
    let span = Span {
        centre: (scale * distance * random.in_cube()).as_vec3(),
        u: u.as_vec3(),
        v: v.as_vec3(),
    };
    let gap = 1.0 + 10f64.powi(-(random.index(16) as i32)) * (random.unit() - 0.5);
    let angle = random.unit() * std::f64::consts::TAU;
    let (a, b) = match is_ellipse {
        true => (gap * angle.cos(), gap * angle.sin()),
        false if angle < std::f64::consts::PI => (gap, 2.0 * random.unit() - 1.0),
        false => (2.0 * random.unit() - 1.0, -gap),
    };
    let [centre, u, v] = [span.centre, span.u, span.v].map(glam::Vec3::as_dvec3);
    let in_plane = u.normalize_or(DVec3::X);
    let dir = in_plane + small(random) * random.direction();
    let target = centre + a * u + b * v;
    let origin = target - scale * 10f64.powi(random.index(6) as i32) * random.unit() * dir;
    let dir = dir * 2f64.powi(random.index(21) as i32 - 10);
    let (start, end) = (f32::NEG_INFINITY, f32::INFINITY);
    let ray = Ray::with_interval(origin.as_vec3(), dir.as_vec3(), start, end);
    Some((span, ray.ok()?))
}

fn compare<P: Pieces + Debug>(is_ellipse: bool, shape: impl Fn(Span) -> P) {
    let mut random = Random::new(42);
    let mut decided = [0; 2];
    for _ in 0..60_000 {
        let Some((span, ray)) = near_border(&mut random, is_ellipse) else {
            continue;
        };
        let shape = shape(span);
        let Some(roots) = shape.quick_roots(&QuickLine::of(&ray)) else {
            continue;
        };
        decided[roots.len()] += 1;
        require_exact(&shape, &ray, &roots);
    }
    assert!(decided[0] > 10_000 && decided[1] > 10_000, "{decided:?}");
}

#[test]
fn quick_crossings_near_the_border_of_a_rectangle_are_the_exact_ones() {
    compare(false, Rectangle);
}

#[test]
fn quick_crossings_near_the_border_of_a_disk_are_the_exact_ones() {
    compare(true, Disk);
}

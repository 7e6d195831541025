//! Points of surfaces, uniform by area.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A point of a primitive, with the surface coordinates that a hit there has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledPoint {
    /// The point.
    pub position: DVec3,
    /// [`Hit::u`](crate::Hit::u).
    pub u: f32,
    /// [`Hit::v`](crate::Hit::v).
    pub v: f32,
}

/// A point of the unit disk, uniform by area for uniform points of the unit square. It maps squares about the centre to
/// disks, so that neighbours stay neighbours.
///
/// Source: Shirley, Chiu, "A Low Distortion Map Between Disk and Square", Journal of Graphics Tools 2(3), 1997.
pub(crate) fn in_disk(at: DVec2) -> DVec2 {
    let at = 2.0 * at - 1.0;
    if at == DVec2::ZERO {
        return at;
    }
    let (radius, angle) = if at.x.abs() > at.y.abs() {
        (at.x, FRAC_PI_4 * (at.y / at.x))
    } else {
        (at.y, FRAC_PI_2 - FRAC_PI_4 * (at.x / at.y))
    };
    let (sin, cos) = libm::sincos(angle);
    radius * DVec2::new(cos, sin)
}

/// A direction, uniform over the sphere for uniform points of the unit square.
pub(crate) fn on_sphere(at: DVec2) -> DVec3 {
    let z = 1.0 - 2.0 * at.x;
    let radius = (4.0 * at.x * (1.0 - at.x)).max(0.0).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * at.y);
    DVec3::new(radius * cos, radius * sin, z)
}

/// The weights of the second and third corner of a triangle, uniform by area for uniform points of the unit square.
///
/// Source: Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
pub(crate) fn in_triangle(at: DVec2) -> DVec2 {
    if at.x < at.y {
        DVec2::new(0.5 * at.x, at.y - 0.5 * at.x)
    } else {
        DVec2::new(at.x - 0.5 * at.y, 0.5 * at.y)
    }
}

/// Which of several parts a number in [0, 1) falls in if each part has a share of its area, and the number stretched to
/// [0, 1) within that part. `None` if no area is positive.
pub(crate) fn part_by_area(areas: &[f64], at: f64) -> Option<(usize, f64)> {
    let total: f64 = areas.iter().sum();
    let mut before = 0.0;
    let mut found = None;
    for (part, &area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.0) {
        let within = (at * total - before) / area;
        // Rounding may leave the number beyond the last part.
        found = Some((part, within.clamp(0.0, 1.0 - f64::EPSILON)));
        if within < 1.0 {
            break;
        }
        before += area;
    }
    found
}

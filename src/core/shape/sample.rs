//! Points of surfaces, uniform by area.

use super::SurfacePoint;
use glam::{DVec2, DVec3, Vec2};
use std::f32::consts::FRAC_PI_4;

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

/// The surface at a sampled point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledSurface {
    /// The surface.
    pub surface: SurfacePoint,
    /// [`Hit::u`](crate::Hit::u).
    pub u: f32,
    /// [`Hit::v`](crate::Hit::v).
    pub v: f32,
    /// The density of the point per solid angle, if directions are uniform; `None` if points are uniform by area.
    pub density: Option<f64>,
}

/// A point of the unit disk, uniform by area for uniform points of the unit square. It maps squares about the centre to
/// disks, so that neighbours stay neighbours.
///
/// Source: Shirley, Chiu, "A Low Distortion Map Between Disk and Square", Journal of Graphics Tools 2(3), 1997.
///
/// Also the point's distance from the centre, up to its sign.
pub(crate) fn in_disk(at: Vec2) -> (Vec2, f32) {
    // Multiples of 2⁻²³ stay exact.
    let at = 2.0 * at - 1.0;
    let is_wide = at.x.abs() > at.y.abs();
    let (radius, other) = if is_wide { (at.x, at.y) } else { (at.y, at.x) };
    let ratio = if radius == 0.0 { 0.0 } else { other / radius };
    let [sin, cos] = within_eighth(FRAC_PI_4 * ratio).map(|x| radius * x);
    let point = if is_wide { [cos, sin] } else { [sin, cos] };
    (point.into(), radius)
}

/// Sine and cosine of an angle of at most π/4, to 2⁻²³: Taylor's series, whose next terms are below 2e-9 and 3e-8.
fn within_eighth(x: f32) -> [f32; 2] {
    let y = x * x;
    let series = |terms: [f32; 5]| terms.into_iter().fold(0.0, |sum, term| sum * y + term);
    let sin = series([1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0]);
    let cos = series([1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0]);
    [x * sin, cos]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_disk_keep_the_distance_of_the_square_they_come_from() {
        for k in 0..4096 {
            let at = Vec2::new((k % 64) as f32, (k / 64) as f32) / 64.0;
            let (point, radius) = in_disk(at);
            let expected = (2.0 * at - 1.0).abs().max_element();
            assert_eq!(radius.abs(), expected);
            // Sine and cosine err by up to 2⁻²³ each.
            assert!((point.length() - expected).abs() < 4e-7, "{at}");
        }
    }

    #[test]
    fn sines_and_cosines_within_an_eighth_of_a_turn_are_exact_to_a_unit_in_the_last_place() {
        for k in -1000..=1000 {
            let x = FRAC_PI_4 * k as f32 / 1000.0;
            let (sin, cos) = libm::sincos(x.into());
            for (found, exact) in within_eighth(x).into_iter().zip([sin, cos]) {
                assert!((f64::from(found) - exact).abs() <= 2f64.powi(-23), "{x}");
            }
        }
    }
}

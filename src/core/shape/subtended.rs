//! The cone of directions in which a sphere appears.
//!
//! Source: Shirley, Wang, Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM Transactions on
//! Graphics 15(1), 1996; the form that keeps all digits of small angles: Pharr, Jakob, Humphreys, Physically Based
//! Rendering, 4th edition, 2023, 6.2.4.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The cone of directions in which a sphere appears from a point outside of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SubtendedCone {
    /// The unit direction to the centre.
    axis: DVec3,
    /// The sine of the half-angle.
    sin_max: f64,
    /// 1 − the cosine of the half-angle.
    one_minus_cos_max: f64,
}

impl SubtendedCone {
    /// `way` leads from the point to the centre. `None` if the point isn't outside by more than `slack`.
    pub fn new(way: DVec3, radius: f64, slack: f64) -> Option<Self> {
        let distance = way.length();
        // A NaN is outside of nothing.
        (distance - radius > slack).then(|| {
            let sin_max = radius / distance;
            // Of this product, no digits are lost near the sphere.
            let cos_max = ((distance - radius) * (distance + radius)).sqrt() / distance;
            Self {
                axis: way / distance,
                sin_max,
                one_minus_cos_max: sin_max * sin_max / (1.0 + cos_max),
            }
        })
    }

    /// The density per solid angle of directions that are uniform over the cone.
    pub fn density(&self) -> f64 {
        1.0 / (TAU * self.one_minus_cos_max)
    }

    /// The sphere's normal where a direction first meets it. Directions are uniform over the cone for uniform points `at`
    /// of the unit square.
    ///
    /// ```text
    ///         .---.
    ///  p θ --(--α c  )    the direction leaves p at the angle θ from the axis; the normal there has the angle α from it
    ///         '---'
    /// ```
    pub fn normal(&self, at: DVec2) -> DVec3 {
        let one_minus_cos = at.x * self.one_minus_cos_max;
        let (cos, squared_sin) = (1.0 - one_minus_cos, one_minus_cos * (2.0 - one_minus_cos));
        // The squared distance from the axis, of which 1 is the edge of the visible part.
        let off_axis = (squared_sin / (self.sin_max * self.sin_max)).min(1.0);
        let cos_at_centre = squared_sin / self.sin_max + cos * (1.0 - off_axis).sqrt();
        let sin_at_centre = (1.0 - cos_at_centre * cos_at_centre).max(0.0).sqrt();
        let (u, v) = self.axis.any_orthonormal_pair();
        let (sin, cos) = (TAU * at.y).sin_cos();
        sin_at_centre * (cos * u + sin * v) - cos_at_centre * self.axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solid_angle_is_that_of_a_cone_of_any_width() {
        for (radius, distance) in [(1.0, 2.0), (1e-9, 1.0), (1e6, 3e6), (1.0, 1.0 + 1e-9)] {
            let cone = SubtendedCone::new(distance * DVec3::X, radius, 0.0).expect("outside");
            // 2π(1 − cos θ) = 4π sin²(θ/2); the sine of θ keeps its digits but near 90°.
            let half = 0.5 * f64::asin(radius / distance);
            let expected = 2.0 * TAU * half.sin().powi(2);
            // asin loses half of the digits near 90°.
            let error = (1.0 / cone.density() / expected - 1.0).abs();
            assert!(error < 1e-7, "{radius} {distance}: {error}");
        }
    }

    #[test]
    fn points_inside_or_at_the_sphere_have_no_cone() {
        for distance in [0.0, 0.5, 1.0, 1.0 + 1e-7, f64::NAN] {
            let cone = SubtendedCone::new(distance * DVec3::Y, 1.0, 1e-6);
            assert!(cone.is_none(), "{distance}");
        }
    }

    #[test]
    fn directions_are_uniform_over_the_cone_and_meet_the_near_side() {
        for scale in [1e-6, 1.0, 1e6] {
            for distance in [1.001, 1.5, 10.0, 1e4] {
                let (way, radius) = (scale * distance * DVec3::new(0.6, 0.0, 0.8), scale);
                let cone = SubtendedCone::new(way, radius, 0.0).expect("outside");
                let one_minus_cos_max = 1.0 / (TAU * cone.density());
                for k in 0..100 {
                    let at = DVec2::new(f64::from(k) / 100.0, f64::from(k) * 0.618);
                    let normal = cone.normal(at);
                    assert!((normal.length() - 1.0).abs() < 1e-12);
                    let to_point = way + radius * normal;
                    // The near side faces the point.
                    assert!(normal.dot(to_point) <= 1e-9 * to_point.length());
                    // |a × b|²/|a||b|(1 + cos) is 1 − cos without cancellation.
                    let dir = to_point.normalize();
                    let axis = way.normalize();
                    let found = dir.cross(axis).length_squared() / (1.0 + dir.dot(axis));
                    let expected = at.x * one_minus_cos_max;
                    // Points are rounded by 2⁻⁵² of their distance, some 1e-12 radii at most; near the axis, sin α has
                    // half of the digits.
                    assert!(
                        (found - expected).abs() < 1e-6 * one_minus_cos_max,
                        "{scale} {distance} {at}: {found} {expected}"
                    );
                }
            }
        }
    }
}

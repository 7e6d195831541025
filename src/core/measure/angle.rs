//! Angles.
//!
//! Source: Kahan, "How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?", 2006, §12: the
//!   formula that is accurate for angles near 0 and near π, too, where an arc cosine loses half of the digits.

use glam::DVec3;

/// The angle in radians at `middle` between the directions to two other points, from 0 to π; `None` if one of them is
/// the middle itself, or isn't finite.
pub fn angle_at(middle: DVec3, [first, second]: [DVec3; 2]) -> Option<f64> {
    angle_between(first - middle, second - middle)
}

/// The angle in radians between two directions of any length, from 0 to π; `None` if one of them is zero or isn't
/// finite. It errs by a few units of 2⁻⁵³.
pub fn angle_between(a: DVec3, b: DVec3) -> Option<f64> {
    let (a, b) = (unit(a)?, unit(b)?);
    Some(2.0 * (a - b).length().atan2((a + b).length()))
}

/// The unit vector along a vector of any length.
fn unit(v: DVec3) -> Option<DVec3> {
    (v / v.abs().max_element()).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    #[test]
    fn known_angles_are_found_for_arms_of_any_length() {
        for scale in [1e-200, 1.0, 1e200] {
            for (a, b, angle) in [
                (DVec3::X, DVec3::Y, FRAC_PI_2),
                (DVec3::X, DVec3::new(1.0, 1.0, 0.0), FRAC_PI_4),
                (DVec3::Z, -3.0 * DVec3::Z, PI),
                (DVec3::ONE, 2.0 * DVec3::ONE, 0.0),
            ] {
                let found = angle_between(scale * a, b).expect("two arms");
                assert!((found - angle).abs() < 1e-15, "{a} {b} {found}");
            }
        }
        let corner = angle_at(DVec3::ONE, [DVec3::ONE + DVec3::X, DVec3::ONE - DVec3::Y]);
        assert_eq!(corner, Some(FRAC_PI_2));
    }

    #[test]
    fn angles_near_0_and_pi_keep_their_digits() {
        for tiny in [1e-3, 1e-8, 1e-12] {
            let found = angle_between(DVec3::X, DVec3::new(1.0, tiny, 0.0)).expect("two arms");
            assert!((found / tiny.atan() - 1.0).abs() < 1e-3, "{tiny} {found}");
            let opposite = angle_between(DVec3::X, DVec3::new(-1.0, tiny, 0.0)).expect("arms");
            assert!((PI - opposite - tiny.atan()).abs() < 1e-15, "{tiny}");
        }
    }

    #[test]
    fn an_arm_without_direction_has_no_angle() {
        assert_eq!(angle_between(DVec3::ZERO, DVec3::X), None);
        assert_eq!(angle_between(DVec3::X, DVec3::NAN), None);
        assert_eq!(angle_at(DVec3::ONE, [DVec3::ONE, DVec3::X]), None);
    }
}

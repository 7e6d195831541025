//! The brightest light that a picture can hold.

use glam::DVec3;
use std::ops::RangeInclusive;

/// The largest radiance or irradiance of a light in a colour channel: 2⁴⁸, about 2.8e14. A pixel has at most
/// 2¹⁶ samples, whose sum the [film](crate::film) cuts at 2⁶⁴: below the limit, it never does.
pub const MAX_BRIGHTNESS: f32 = (1_u64 << 48) as f32;

/// The range of useful exposures, in stops: the lowest shows [`MAX_BRIGHTNESS`] as white, the highest shows 2⁻⁶⁴, the
/// darkest light that a film holds.
pub const EXPOSURES: RangeInclusive<f32> = -48.0..=64.0;

/// Checks the radiance or the irradiance of a light.
///
/// # Errors
/// A channel is negative, NaN, or above [`MAX_BRIGHTNESS`]. The message is a predicate without subject.
pub fn check_brightness(rgb: DVec3) -> Result<(), String> {
    check(rgb, MAX_BRIGHTNESS, too_bright)
}

/// Checks the intensity of a point, which is divided by the square of a distance, so that it may be larger.
///
/// # Errors
/// A channel is negative, NaN, or too large for f32. The message is a predicate without subject.
pub(crate) fn check_intensity(rgb: DVec3) -> Result<(), String> {
    check(rgb, f32::MAX, || {
        "is too large for 32-bit numbers, which end at 3.4e38".to_owned()
    })
}

fn check(rgb: DVec3, most: f32, too_large: fn() -> String) -> Result<(), String> {
    let channels = rgb.to_array();
    if channels.iter().any(|x| x.is_nan()) {
        return Err("isn't a number".to_owned());
    }
    if channels.iter().any(|&x| x < 0.0) {
        return Err("must not be negative".to_owned());
    }
    if channels.iter().any(|&x| x > most.into()) {
        return Err(too_large());
    }
    Ok(())
}

/// The message about light above [`MAX_BRIGHTNESS`].
pub(crate) fn too_bright() -> String {
    format!("is too bright: a picture holds at most {MAX_BRIGHTNESS:.1e} per colour channel")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_exposures_ends_at_the_brightest_and_the_darkest_light_of_a_picture() {
        let (darkest, brightest) = (2f32.powi(-64), MAX_BRIGHTNESS);
        assert_eq!(EXPOSURES.start().exp2() * brightest, 1.0);
        assert_eq!(EXPOSURES.end().exp2() * darkest, 1.0);
    }

    #[test]
    fn light_is_refused_with_the_reason() {
        let limit = f64::from(MAX_BRIGHTNESS);
        for (channel, expected) in [
            (0.0, None),
            (limit, None),
            (-1e-30, Some("negative")),
            (f64::NAN, Some("isn't a number")),
            (2.0 * limit, Some("at most 2.8e14")),
            (f64::INFINITY, Some("at most 2.8e14")),
        ] {
            let found = check_brightness(DVec3::new(1.0, channel, 0.0)).err();
            match (found, expected) {
                (None, None) => {}
                (Some(found), Some(part)) => assert!(found.contains(part), "{found}"),
                (found, expected) => panic!("{channel}: {found:?}, not {expected:?}"),
            }
        }
        assert_eq!(check_intensity(DVec3::splat(1e38)), Ok(()));
        assert!(check_intensity(DVec3::splat(1e39)).is_err());
    }
}

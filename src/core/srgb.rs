//! Conversion between linear RGB and sRGB.

use glam::{DVec3, Vec3};
use std::sync::LazyLock;

/// Linear RGB from sRGB values, which are clamped to 0…1; NaN stays NaN.
///
/// Source: IEC 61966-2-1.
pub fn from_display(srgb: Vec3) -> Vec3 {
    let linear = |s: f32| {
        if s <= 0.040_45 {
            s / 12.92
        } else {
            ((s + 0.055) / 1.055).powf(2.4)
        }
    };
    Vec3::from_array(srgb.clamp(Vec3::ZERO, Vec3::ONE).to_array().map(linear))
}

/// sRGB value from a linear one, which is clamped to 0…1; NaN stays NaN. The inverse of [`from_display`].
///
/// Source: IEC 61966-2-1.
pub fn to_display(linear: f32) -> f32 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

/// Linear RGB of an 8-bit sRGB texel.
pub fn from_texel(texel: [u8; 3]) -> Vec3 {
    static LINEAR: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|x| from_display(Vec3::splat(x as f32 / 255.0)).x));
    Vec3::from_array(texel.map(|x| LINEAR[usize::from(x)]))
}

/// The luminance of red, green and blue of brightness 1.
///
/// Source: ITU-R BT.709.
pub(crate) const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The luminance of linear RGB.
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(LUMINANCE.as_vec3())
}

/// The luminance of linear RGB in f64, which is positive for every colour but black.
pub(crate) fn luminance_f64(rgb: Vec3) -> f64 {
    rgb.as_dvec3().dot(LUMINANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transfer_functions_are_inverses_of_each_other() {
        for i in 0..=255 {
            let s = i as f32 / 255.0;
            let back = to_display(from_display(Vec3::splat(s)).x);
            assert_eq!((back * 255.0).round(), i as f32);
        }
        assert!((from_display(Vec3::splat(0.5)).x - 0.214_041).abs() < 1e-6);
    }

    #[test]
    fn a_texel_is_decoded_like_a_colour() {
        let texel = from_texel([0, 128, 255]);
        let expected = from_display(Vec3::new(0.0, 128.0, 255.0) / 255.0);
        assert!((texel - expected).length() < 1e-6);
    }
}

//! How much light is a colour, as displays and pictures spell it?

use glam::Vec3;
use std::sync::LazyLock;

/// Linear RGB of a colour that is to be seen as these sRGB values in 0…1; outside, clamped.
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

/// sRGB value in 0…1 of a linear one, clamped. The inverse of [`from_display`].
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

/// [`from_display`] of a texel.
pub fn from_texel(texel: [u8; 3]) -> Vec3 {
    static LINEAR: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|x| from_display(Vec3::splat(x as f32 / 255.0)).x));
    Vec3::from_array(texel.map(|x| LINEAR[usize::from(x)]))
}

//! Sample positions within a pixel.
//!
//! The first sample is the pixel's centre, which is also the ray that a click inspects. The others follow
//! the R2 sequence, shifted per pixel by a hash to decorrelate neighbours. A position depends only on pixel
//! and sample index, never on threads or time.
//!
//! Source: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 (R2).

use glam::{UVec2, Vec2};

/// 2⁶⁴/φ₂ and 2⁶⁴/φ₂², φ₂ = 1.3247… the plastic number, the root of x³ = x + 1.
const STEP: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1c];

/// Position of a sample in its pixel, each coordinate in [0, 1); (0.5, 0.5) is the centre.
pub fn sample_position(pixel: UVec2, sample: u32) -> Vec2 {
    if sample == 0 {
        return Vec2::splat(0.5);
    }
    let seed = mix(u64::from(pixel.x) << 32 | u64::from(pixel.y));
    let shift = [seed, mix(seed)];
    let coordinate = |axis: usize| {
        let bits = shift[axis].wrapping_add(STEP[axis].wrapping_mul(u64::from(sample)));
        // An f32 below 1 holds 24 bits exactly.
        (bits >> 40) as f32 / (1u32 << 24) as f32
    };
    Vec2::new(coordinate(0), coordinate(1))
}

/// A bijective hash of 64-bit words (a finaliser).
///
/// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators",
/// OOPSLA 2014; constants: D. Stafford's variant 13.
pub fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sample_is_at_the_pixels_centre() {
        assert_eq!(sample_position(UVec2::new(7, 9), 0), Vec2::splat(0.5));
    }

    #[test]
    fn samples_fill_the_pixel_evenly() {
        let mut cells = [0; 16];
        for sample in 1..=64 {
            let p = sample_position(UVec2::new(3, 5), sample);
            assert!(p.min_element() >= 0.0 && p.max_element() < 1.0);
            cells[(p.y * 4.0) as usize * 4 + (p.x * 4.0) as usize] += 1;
        }
        assert!(cells.iter().all(|&n| (2..=6).contains(&n)), "{cells:?}");
    }

    #[test]
    fn the_steps_are_powers_of_the_plastic_number() {
        let plastic = 1.324_717_957_244_746_f64;
        for (step, power) in STEP.into_iter().zip([1, 2]) {
            let fraction = step as f64 / 2f64.powi(64);
            assert!(
                (fraction - plastic.powi(-power)).abs() < 1e-12,
                "{fraction}"
            );
        }
    }
}

//! Sample positions within a pixel, and the random numbers of a sample.
//!
//! The first position is the pixel's centre, which is also the ray that a click inspects. The others follow
//! the R2 sequence, shifted per pixel by a hash to decorrelate neighbours. Positions and random numbers depend only on
//! pixel and sample index, never on threads or time.
//!
//! Sources: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 (R2);
//! B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.

use glam::{UVec2, Vec2};
use sobol_burley::parts;
use std::sync::LazyLock;

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

/// The random numbers of one sample, four at a time. Each four are a point of an Owen-scrambled Sobol sequence in four
/// dimensions, scrambled and shuffled anew for each pixel and each four.
///
/// The samples of a pixel are well spread in each dimension, and in the two that [`next_2d`](Self::next_2d) draws.
/// Nothing is computed before a number is drawn.
#[derive(Clone, Debug)]
pub struct Sampler {
    index: u32,
    seed: u32,
    /// The next four.
    four: u32,
    numbers: [f32; 4],
    /// How many of `numbers` are drawn.
    drawn: usize,
}

/// The number of points in one sequence; a pixel's further samples are of another sequence.
const SEQUENCE: u32 = 1 << 16;

impl Sampler {
    /// The numbers of a sample of a pixel.
    #[inline]
    pub fn new(pixel: UVec2, sample: u32) -> Self {
        let pixel = u64::from(pixel.x) << 32 | u64::from(pixel.y);
        let seed = mix(mix(!pixel) ^ u64::from(sample / SEQUENCE));
        Self {
            index: sample % SEQUENCE,
            seed: seed as u32,
            four: 0,
            numbers: [0.0; 4],
            drawn: 4,
        }
    }

    /// A number in [0, 1).
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        if self.drawn == 4 {
            self.fill();
        }
        let number = self.numbers[self.drawn];
        self.drawn += 1;
        number
    }

    /// A point in the unit square, without its right and upper edge.
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        if self.drawn > 2 {
            self.fill();
        }
        let point = Vec2::new(self.numbers[self.drawn], self.numbers[self.drawn + 1]);
        self.drawn += 2;
        point
    }

    /// A number if it is used; else 0, and none is drawn.
    #[inline]
    pub fn next_1d_if(&mut self, is_used: bool) -> f32 {
        if is_used { self.next_1d() } else { 0.0 }
    }

    /// A point if it is used; else 0, and none is drawn.
    #[inline]
    pub fn next_2d_if(&mut self, is_used: bool) -> Vec2 {
        if is_used { self.next_2d() } else { Vec2::ZERO }
    }

    fn fill(&mut self) {
        let seed = mix(u64::from(self.seed) << 32 | u64::from(self.four)) as u32;
        self.numbers = point(self.index, seed);
        self.four += 1;
        self.drawn = 0;
    }
}

/// The point of an index below [`SEQUENCE`]: that of [`sobol_burley::sample_4d`], bit for bit. A table adds the direction
/// numbers of four bits of the index at a time, in place of one.
fn point(index: u32, seed: u32) -> [f32; 4] {
    let index = parts::owen_scramble_rev(index.reverse_bits(), parts::hash(seed ^ SHUFFLE));
    let mut sobol = [0; 4];
    for (digit, sums) in SUMS.iter().enumerate() {
        let sum = sums[(index >> (28 - 4 * digit)) as usize % 16];
        sobol = std::array::from_fn(|k| sobol[k] ^ sum[k]);
    }
    let seed = seed.wrapping_mul(SPREAD);
    let scramble = parts::hash_int4(SCRAMBLES.map(|scramble| scramble ^ seed).into());
    let scrambled = parts::owen_scramble_int4_rev(sobol.into(), scramble);
    scrambled.reverse_bits().to_f32_norm()
}

// The numbers by which `sobol_burley` tells seeds and dimensions apart.
const SHUFFLE: u32 = 0x79c6_8e4a;
const SPREAD: u32 = 0x9c8f_2d3b;
const SCRAMBLES: [u32; 4] = [0x912f_69ba, 0x174f_18ab, 0x691e_72ca, 0xb40c_c1b8];

/// For each of the four hexadecimal digits of an index, from the one that is reversed last, the sums of direction numbers in
/// four dimensions.
static SUMS: LazyLock<[[[u32; 4]; 16]; 4]> = LazyLock::new(|| {
    let sum = |digit: usize, value: usize| {
        let index = (value as u32) << (28 - 4 * digit);
        [0, 1, 2, 3].map(|dimension| parts::sobol_rev(index, dimension))
    };
    std::array::from_fn(|digit| std::array::from_fn(|value| sum(digit, value)))
});

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
    fn the_points_of_256_samples_are_spread_over_the_square() {
        for skipped in 0..8 {
            let mut cells = [0; 64];
            for sample in 0..256 {
                let mut sampler = Sampler::new(UVec2::new(3, 5), sample);
                (0..skipped).for_each(|_| _ = sampler.next_2d());
                let p = sampler.next_2d();
                assert!(p.min_element() >= 0.0 && p.max_element() < 1.0);
                cells[(p.y * 8.0) as usize * 8 + (p.x * 8.0) as usize] += 1;
            }
            // The first two dimensions are a net, with exactly 4 in each cell. Of independent points, one cell in 40
            // would have none or more than 8.
            let is_even = |&n: &i32| {
                if skipped % 2 == 0 {
                    n == 4
                } else {
                    (1..=8).contains(&n)
                }
            };
            assert!(cells.iter().all(is_even), "{skipped}: {cells:?}");
        }
    }

    #[test]
    fn points_are_those_of_the_library() {
        for index in (0..SEQUENCE).step_by(37) {
            for seed in [0, 1, u32::MAX, index.wrapping_mul(SPREAD)] {
                let expected = sobol_burley::sample_4d(index, 0, seed);
                assert_eq!(point(index, seed), expected, "{index} {seed}");
            }
        }
    }

    #[test]
    fn each_pixel_and_each_sample_has_other_numbers() {
        let first = |sample| Sampler::new(UVec2::ONE, sample).next_2d();
        assert_ne!(first(0), first(1));
        assert_ne!(first(0), first(SEQUENCE));
        assert_ne!(first(0), Sampler::new(UVec2::X, 0).next_2d());
        assert_eq!(first(0), first(0));
        let mut sampler = Sampler::new(UVec2::ONE, 1);
        let drawn: Vec<f32> = (0..1000).map(|_| sampler.next_1d()).collect();
        let mean = drawn.iter().sum::<f32>() / 1000.0;
        // Five standard errors of independent numbers.
        assert!(
            (mean - 0.5).abs() < 5.0 * (1.0f32 / 12_000.0).sqrt(),
            "{mean}"
        );
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

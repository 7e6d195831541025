//! The sum of a pixel's samples, in integers, so that the order of additions doesn't matter.

use crate::srgb::luminance_f64;
use glam::{DVec3, Vec3};

/// The source of a sample's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// A surface.
    Surface,
    /// Light from infinitely far away.
    Environment,
    /// The background, which isn't light.
    Background,
}

/// The sum of a pixel's samples. The order in which samples are added doesn't matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleSum {
    /// Linear RGB in units of 2⁻⁶⁴.
    rgb: [u128; 3],
    /// Squared luminance, for the variance.
    square: SquareSum,
    /// Number of samples that show no surface.
    misses: u32,
    /// Number of samples that show the background.
    backgrounds: u32,
}

/// Binary digits of a [`SampleSum`] after the point.
const PLACES: i32 = 64;

/// The value 1 in [`SampleSum`], and the end of its range.
pub(super) const ONE: f64 = (1_u128 << PLACES) as f64;

impl SampleSum {
    /// Adds a sample in linear RGB, and returns whether it was finite. One that isn't is left out, and a negative number
    /// counts as 0.
    ///
    /// Digits below 2⁻⁶⁴ are dropped, and sums end at 2⁶⁴.
    pub fn add(&mut self, radiance: Vec3) -> bool {
        if !radiance.is_finite() {
            return false;
        } else if radiance == Vec3::ZERO {
            return true;
        }
        let radiance = radiance.max(Vec3::ZERO);
        let rgb = radiance.to_array().map(|x| fixed(x.into()));
        let is_whole = |x: f32| x >= WHOLE || x == 0.0;
        let luminance = if radiance.to_array().into_iter().all(is_whole) {
            luminance_f64(radiance)
        } else {
            // The luminance of the numbers that the mean is computed from.
            luminance_of(rgb.map(|x| x as f64 / ONE))
        };
        self.merge(&Self {
            rgb,
            square: SquareSum::new(luminance * luminance),
            ..Self::default()
        });
        true
    }

    /// Adds a sample like [`add`](Self::add), and counts samples that don't show a surface.
    pub fn add_seen(&mut self, radiance: Vec3, seen: Seen) -> bool {
        self.misses += u32::from(seen != Seen::Surface);
        self.backgrounds += u32::from(seen == Seen::Background);
        self.add(radiance)
    }

    /// Adds another sum.
    pub(super) fn merge(&mut self, other: &Self) {
        for (sum, part) in self.rgb.iter_mut().zip(other.rgb) {
            *sum = sum.saturating_add(part);
        }
        self.square.merge(other.square);
        self.misses += other.misses;
        self.backgrounds += other.backgrounds;
    }

    /// Whether any of `count` samples shows a surface.
    pub(super) fn shows_surface(&self, count: u32) -> bool {
        self.misses < count
    }

    /// The part of `count` samples that shows the background.
    pub(super) fn background_part(&self, count: u32) -> f32 {
        self.backgrounds as f32 / count as f32
    }

    /// The mean of `count` samples.
    pub(super) fn mean(&self, count: u32) -> Vec3 {
        Vec3::from_array(self.means(count).map(|x| x as f32))
    }

    fn means(&self, count: u32) -> [f64; 3] {
        let unit = 1.0 / (ONE * f64::from(count));
        self.rgb.map(|sum| sum as f64 * unit)
    }

    /// The variance of the luminance of a single sample, estimated from `count` samples; 0 for fewer than 2.
    ///
    /// As long as the sum is below 2⁶⁴, its error is a few units of 2⁻⁵² of the mean's square, and 2⁻¹²⁸ for each
    /// sample.
    pub(super) fn variance(&self, count: u32) -> f64 {
        if count < 2 {
            return 0.0;
        }
        let n = f64::from(count);
        let mean = luminance_of(self.means(count));
        let square = self.square.value() / n;
        (square - mean * mean).max(0.0) * n / (n - 1.0)
    }
}

fn luminance_of(rgb: [f64; 3]) -> f64 {
    crate::srgb::LUMINANCE.dot(DVec3::from_array(rgb))
}

/// A sum of squares in 256 bits. Squares of numbers from 2⁻⁶⁴ to 2⁶⁴ fit, as do their sums if the sum of the numbers
/// themselves does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct SquareSum {
    whole: u128,
    /// In units of 2⁻¹²⁸.
    fraction: u128,
}

impl SquareSum {
    const MAX: Self = Self {
        whole: u128::MAX,
        fraction: u128::MAX,
    };

    /// A number that isn't negative. Digits below 2⁻¹²⁸ are dropped, and numbers end at 2¹²⁸.
    fn new(x: f64) -> Self {
        if x >= ONE * ONE {
            return Self::MAX;
        }
        let (digits, exponent) = parts(x);
        Self {
            whole: shifted(digits, exponent),
            fraction: shifted(digits, exponent + 128),
        }
    }

    fn merge(&mut self, other: Self) {
        let (fraction, carry) = self.fraction.overflowing_add(other.fraction);
        let whole = self.whole.checked_add(other.whole);
        *self = match whole.and_then(|whole| whole.checked_add(carry.into())) {
            Some(whole) => Self { whole, fraction },
            None => Self::MAX,
        };
    }

    fn value(self) -> f64 {
        self.whole as f64 + self.fraction as f64 / (ONE * ONE)
    }
}

/// A number that isn't negative, in units of 2⁻⁶⁴. Faster than the conversion of the standard library.
fn fixed(x: f64) -> u128 {
    if x >= ONE {
        return u128::MAX;
    }
    let (digits, exponent) = parts(x);
    shifted(digits, exponent + PLACES)
}

/// The least number from which on [`fixed`] drops none of the 24 binary digits of an f32.
const WHOLE: f32 = 1.0 / (1_u64 << (PLACES - 24)) as f32;

/// The digits and the exponent of a number that isn't negative. Those of 0 and subnormal numbers are wrong, but too
/// small to matter.
fn parts(x: f64) -> (u128, i32) {
    let bits = x.to_bits();
    let digits = bits & ((1 << 52) - 1) | 1 << 52;
    (digits.into(), (bits >> 52) as i32 - 1075)
}

/// `digits` · 2^`by`, in which digits beyond both ends of the integer are dropped.
fn shifted(digits: u128, by: i32) -> u128 {
    match by {
        0..128 => digits << by,
        -127..0 => digits >> -by,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brightness::MAX_BRIGHTNESS;
    use crate::random::Random;

    fn sum_of(samples: impl IntoIterator<Item = Vec3>) -> SampleSum {
        let mut sum = SampleSum::default();
        samples.into_iter().for_each(|sample| _ = sum.add(sample));
        sum
    }

    #[test]
    fn the_mean_of_equal_samples_is_that_sample() {
        let grey = Vec3::splat(0.215_861);
        assert_eq!(sum_of([grey; 4]).mean(4), grey);
    }

    #[test]
    fn non_finite_samples_are_rejected_and_bright_ones_are_not_clamped() {
        let mut sum = SampleSum::default();
        assert!(!sum.add(Vec3::new(0.0, f32::NAN, 0.0)));
        assert!(!sum.add(Vec3::new(0.0, f32::INFINITY, 0.0)));
        assert!(sum.add(Vec3::splat(-1.0)));
        assert_eq!(sum, SampleSum::default());
        assert!(sum.add(Vec3::new(1e9, 1e-9, 3.0)));
        assert_eq!(sum.mean(1), Vec3::new(1e9, 1e-9, 3.0));
        (0..3).for_each(|_| _ = sum.add(Vec3::splat(f32::MAX)));
        // The end of the range, 2⁶⁴.
        assert_eq!(sum.mean(1), Vec3::splat(ONE as f32));
    }

    #[test]
    fn no_sum_of_the_brightest_light_is_cut() {
        let samples = vec![Vec3::splat(MAX_BRIGHTNESS); 1 << 16];
        // The sum is 2⁶⁴ less one unit of the sums, which the mean rounds away.
        let mean = sum_of(samples).mean(1 << 16);
        assert_eq!(mean, Vec3::splat(MAX_BRIGHTNESS));
    }

    #[test]
    fn the_order_of_samples_of_any_brightness_does_not_change_their_sum() {
        let mut random = Random::new(4);
        let mut samples = [(); 100].map(|()| {
            let exponent = random.index(130) as i32 - 65;
            Vec3::from_array([(); 3].map(|()| random.unit() as f32 * 2f32.powi(exponent)))
        });
        let sum = sum_of(samples);
        samples.reverse();
        assert_eq!(sum_of(samples), sum);
        samples.sort_by(|a, b| a.x.total_cmp(&b.x));
        assert_eq!(sum_of(samples), sum);
    }

    #[test]
    fn fixed_numbers_are_those_of_the_standard_conversion() {
        let mut random = Random::new(7);
        for exponent in -160..=65 {
            for _ in 0..20 {
                let x = f64::from((random.unit() + 1.0) as f32) * 2f64.powi(exponent);
                assert_eq!(fixed(x), (x * ONE) as u128, "{x}");
            }
        }
        assert_eq!((fixed(0.0), fixed(f64::INFINITY)), (0, u128::MAX));
        assert_eq!((fixed(0.0), fixed(WHOLE.into())), (0, 1 << 24));
    }

    #[test]
    fn the_variance_is_that_of_single_samples_at_any_luminance() {
        // Of 1, 2, 3, 6: deviations −2, −1, 0, 3, and 14/3. The sum ends at 2⁶⁴, and 2⁻⁶⁴ is a unit.
        for exponent in -64..=60 {
            let scale = 2f32.powi(exponent);
            let sum = sum_of([1.0, 2.0, 3.0, 6.0].map(|x| Vec3::splat(scale * x)));
            let variance = sum.variance(4) / f64::from(scale).powi(2);
            // 53 digits, rounded a few times; and each of four squares may lose a unit of 2⁻¹²⁸.
            let unit = 2f64.powi(-128 - 2 * exponent);
            assert!(
                (variance - 14.0 / 3.0).abs() < 1e-12 + 4.0 / 3.0 * unit,
                "2^{exponent}: {variance}"
            );
        }
        assert_eq!(sum_of([Vec3::splat(0.25); 2]).variance(1), 0.0);
        // Equal samples, whose luminance isn't an f32.
        let grey = sum_of([Vec3::new(0.1, 0.7, 0.3); 9]);
        assert!(grey.variance(9) < 1e-15, "{}", grey.variance(9));
    }

    #[test]
    fn half_of_all_samples_at_the_brightest_light_have_its_variance() {
        let sample = |k: u32| {
            Vec3::splat(if k.is_multiple_of(2) {
                MAX_BRIGHTNESS
            } else {
                0.0
            })
        };
        let n = 1 << 16;
        let found = sum_of((0..n).map(sample)).variance(n);
        let half = f64::from(MAX_BRIGHTNESS) / 2.0;
        let expected = half * half * f64::from(n) / f64::from(n - 1);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
    }
}

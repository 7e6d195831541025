//! Fractions of arbitrary-precision integers, and their correct rounding.

use dashu_int::ops::{BitTest, Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;
use std::fmt;

/// An exact rational number with a positive denominator, not always in lowest terms.
#[derive(Clone, Debug)]
pub struct Fraction {
    numerator: IBig,
    denominator: IBig,
}

impl Fraction {
    /// `numerator / denominator`; `None` for a denominator of zero.
    pub fn new(numerator: IBig, denominator: IBig) -> Option<Self> {
        match denominator.cmp(&IBig::ZERO) {
            Ordering::Equal => None,
            Ordering::Greater => Some(Self {
                numerator,
                denominator,
            }),
            Ordering::Less => Some(Self {
                numerator: -numerator,
                denominator: -denominator,
            }),
        }
    }

    /// The exact value of a finite number; `None` for NaN and infinities.
    pub fn from_f64(x: f64) -> Option<Self> {
        let (mantissa, exponent) = decode(x)?;
        Self::new(IBig::from(mantissa), IBig::ONE).map(|fraction| fraction.scaled(exponent))
    }

    /// The product with 2^`exponent`.
    #[must_use]
    pub fn scaled(self, exponent: i32) -> Self {
        let shift = exponent.unsigned_abs() as usize;
        if exponent >= 0 {
            Self {
                numerator: self.numerator << shift,
                denominator: self.denominator,
            }
        } else {
            Self {
                numerator: self.numerator,
                denominator: self.denominator << shift,
            }
        }
    }

    /// The difference of two fractions.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        Self {
            numerator: &self.numerator * &other.denominator - &other.numerator * &self.denominator,
            denominator: &self.denominator * &other.denominator,
        }
    }

    /// The sum of two fractions.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            numerator: &self.numerator * &other.denominator + &other.numerator * &self.denominator,
            denominator: &self.denominator * &other.denominator,
        }
    }

    /// Numerator and denominator.
    pub(super) fn parts(&self) -> [&IBig; 2] {
        [&self.numerator, &self.denominator]
    }

    /// The same number in lowest terms.
    #[must_use]
    pub fn reduced(&self) -> Self {
        let divisor = IBig::from((&self.numerator).gcd(&self.denominator));
        Self {
            numerator: &self.numerator / &divisor,
            denominator: &self.denominator / &divisor,
        }
    }

    /// The nearest f64, ties to even.
    pub fn to_f64(&self) -> f64 {
        self.round(f64::MANTISSA_DIGITS, -1074)
    }

    /// The nearest f32, ties to even.
    pub fn to_f32(&self) -> f32 {
        self.round(f32::MANTISSA_DIGITS, -149) as f32
    }

    /// Rounds to `digits` binary digits, the last of which is worth at least 2^`lowest`.
    fn round(&self, digits: u32, lowest: i64) -> f64 {
        let (size, denominator) = (
            (&self.numerator).unsigned_abs(),
            (&self.denominator).unsigned_abs(),
        );
        if size == UBig::ZERO {
            return 0.0;
        }
        // A quotient with two or three extra digits, and whether there is a remainder.
        let digits = i64::from(digits);
        let shift = digits + 2 - (size.bit_len() as i64 - denominator.bit_len() as i64);
        let (size, denominator) = if shift >= 0 {
            (size << shift as usize, denominator)
        } else {
            (size, denominator << -shift as usize)
        };
        let quotient = &size / &denominator;
        let is_inexact = &quotient * &denominator != size;

        // Drop the extra digits, and more of them if the number is subnormal.
        let drop = (quotient.bit_len() as i64 - digits).max(lowest + shift);
        let quotient = u64::try_from(quotient).expect("at most 56 digits");
        if drop > 60 {
            return 0.0;
        }
        let half = 1u64 << (drop - 1);
        let (kept, rest) = (quotient >> drop, quotient & (2 * half - 1));
        let is_up = rest > half || (rest == half && (is_inexact || kept & 1 == 1));
        let kept = kept + u64::from(is_up);

        // In two steps, so that neither power of two exceeds the range of f64.
        let exponent = drop - shift;
        let power = |e: i64| 2f64.powi(e.clamp(-1074, 1100) as i32);
        let value = kept as f64 * power(exponent / 2) * power(exponent - exponent / 2);
        if self.numerator < IBig::ZERO {
            -value
        } else {
            value
        }
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        let left = &self.numerator * &other.denominator;
        left.cmp(&(&other.numerator * &self.denominator))
    }
}

impl fmt::Display for Fraction {
    /// In lowest terms, such as `3/4` or `2`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            numerator,
            denominator,
        } = self.reduced();
        if denominator == IBig::ONE {
            write!(f, "{numerator}")
        } else {
            write!(f, "{numerator}/{denominator}")
        }
    }
}

/// `mantissa · 2^exponent` of a finite number.
pub(super) fn decode(x: f64) -> Option<(i64, i32)> {
    if !x.is_finite() {
        return None;
    }
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (size, exponent) = match exponent {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, exponent - 1075),
    };
    Some((if x < 0.0 { -size } else { size }, exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all magnitudes, including subnormals.
    fn numbers(count: u64) -> impl Iterator<Item = f64> {
        let finite = |i| {
            Some(f64::from_bits(hitscope_core::sampler::mix(i))).filter(|x: &f64| x.is_finite())
        };
        (0..count).filter_map(finite)
    }

    #[test]
    fn a_number_equals_its_fraction() {
        for x in numbers(10_000).chain([0.0, 1.0, -0.1, f64::MIN_POSITIVE / 8.0, 5e-324, f64::MAX])
        {
            assert_eq!(Fraction::from_f64(x).expect("finite").to_f64(), x);
        }
        assert!(Fraction::from_f64(f64::NAN).is_none());
        assert!(Fraction::from_f64(f64::INFINITY).is_none());
    }

    #[test]
    fn quotients_round_like_ieee_division() {
        let list: Vec<f64> = numbers(30_000).collect();
        let mut checked = 0;
        for pair in list.chunks_exact(2) {
            let [a, b] = [pair[0], pair[1]].map(|x| Fraction::from_f64(x).expect("finite"));
            let quotient =
                Fraction::new(&a.numerator * &b.denominator, &b.numerator * &a.denominator);
            let Some(quotient) = quotient.filter(|_| (pair[0] / pair[1]).is_finite()) else {
                continue;
            };
            assert_eq!(quotient.to_f64(), pair[0] / pair[1], "{pair:?}");
            let narrow = [pair[0] as f32, pair[1] as f32];
            let [a, b] = narrow.map(|x| Fraction::from_f64(x.into()));
            if let (Some(a), Some(b)) = (a, b) {
                let quotient =
                    Fraction::new(&a.numerator * &b.denominator, &b.numerator * &a.denominator);
                if let Some(quotient) = quotient.filter(|_| (narrow[0] / narrow[1]).is_finite()) {
                    assert_eq!(quotient.to_f32(), narrow[0] / narrow[1], "{narrow:?}");
                }
            }
            checked += 1;
        }
        assert!(checked > 7_000, "{checked}");
    }

    #[test]
    fn ties_round_to_even() {
        let half_way =
            |k: i64| Fraction::new(IBig::from(2 * k + 1), IBig::from(2)).expect("not zero");
        let even = 1i64 << 24;
        assert_eq!(half_way(even).to_f32(), even as f32);
        assert_eq!(half_way(even + 1).to_f32(), (even + 2) as f32);
    }

    #[test]
    fn fractions_print_in_lowest_terms() {
        let fraction = |n: i32, d: i32| {
            Fraction::new(n.into(), d.into())
                .expect("not zero")
                .to_string()
        };
        assert_eq!(fraction(6, -8), "-3/4");
        assert_eq!(fraction(8, 4), "2");
        assert_eq!(fraction(0, 5), "0");
    }
}

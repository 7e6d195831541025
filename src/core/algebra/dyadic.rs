//! Exact numbers: an integer times a power of two.

use super::interval::Interval;
use super::ring::Ring;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, UnsignedAbs};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// `mantissa·2^exponent`. The mantissa may have any number of bits; equal numbers may differ in it.
///
/// Every finite f32 and f64 is one, and sums and products of them are.
#[derive(Clone, Debug)]
pub struct Dyadic {
    pub mantissa: IBig,
    pub exponent: i32,
}

/// A floating-point format to round to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Format {
    /// Bits of a normal number's significand.
    digits: i32,
    /// Exponent of the smallest positive number.
    lowest: i32,
    /// Exponent of the smallest power of two that is too large.
    limit: i32,
    /// Whether the last bit of a number's significand is 0.
    pub is_even: fn(f64) -> bool,
}

pub(super) const F64: Format = Format {
    digits: 53,
    lowest: -1074,
    limit: 1024,
    is_even: |x| x.to_bits() & 1 == 0,
};

pub(super) const F32: Format = Format {
    digits: 24,
    lowest: -149,
    limit: 128,
    is_even: |x| (x as f32).to_bits() & 1 == 0,
};

impl Format {
    /// The exact middle between two neighbouring numbers. An infinity stands for the power of two that is
    /// too large for the format, as in IEEE 754's rounding.
    pub fn middle(&self, a: f64, b: f64) -> Dyadic {
        let limit = Dyadic::power(self.limit);
        let value = |x: f64| match x {
            f64::INFINITY => limit.clone(),
            f64::NEG_INFINITY => -limit.clone(),
            _ => x.into(),
        };
        (value(a) + value(b)).halved()
    }

    /// Whether `b` is the number that follows `a`.
    pub fn are_neighbours(&self, a: f64, b: f64) -> bool {
        let next = if self.digits == F64.digits {
            a.next_up()
        } else {
            f64::from((a as f32).next_up())
        };
        // From the largest negative number, the next is −0.
        next == b
    }
}

impl Dyadic {
    pub fn new(mantissa: IBig, exponent: i32) -> Self {
        Self { mantissa, exponent }
    }

    /// `2^exponent`.
    pub fn power(exponent: i32) -> Self {
        Self::new(IBig::ONE, exponent)
    }

    pub fn halved(self) -> Self {
        Self::new(self.mantissa, self.exponent - 1)
    }

    /// The number times `2^power`.
    pub fn scaled(&self, power: i32) -> Self {
        Self::new(self.mantissa.clone(), self.exponent + power)
    }

    pub fn sign(&self) -> Ordering {
        self.mantissa.cmp(&IBig::ZERO)
    }

    /// The exponent of the largest power of two that isn't larger than the absolute value; 0 for 0.
    pub fn magnitude(&self) -> i32 {
        self.mantissa.bit_len() as i32 - 1 + self.exponent
    }

    /// `mantissa` in units of `2^exponent`, which must be an integer.
    pub fn in_units_of(&self, exponent: i32) -> IBig {
        if self.mantissa == IBig::ZERO {
            return IBig::ZERO;
        }
        &self.mantissa << usize::try_from(self.exponent - exponent).expect("a finer unit")
    }

    /// The nearest number of a format, as f64; of two equally near ones, the even one.
    pub(super) fn rounded(&self, format: Format) -> f64 {
        if self.mantissa == IBig::ZERO {
            return 0.0;
        }
        let top = self.magnitude() + 1;
        if top > format.limit {
            return match self.sign() {
                Ordering::Less => f64::NEG_INFINITY,
                _ => f64::INFINITY,
            };
        }
        let size = self.mantissa.clone().unsigned_abs();
        let last = (top - format.digits).max(format.lowest);
        let digits = match usize::try_from(last - self.exponent) {
            Err(_) => size << (self.exponent - last).unsigned_abs() as usize,
            Ok(0) => size,
            Ok(dropped) => {
                let kept = &size >> dropped;
                let is_over_half = size.bit(dropped - 1)
                    && (kept.bit(0) || size.trailing_zeros() != Some(dropped - 1));
                if is_over_half { kept + 1u8 } else { kept }
            }
        };
        let digits = u64::try_from(digits).expect("54 digits at most") as f64;
        // Two steps, so that neither power of two leaves the range of f64. The result is exact.
        let x = digits * 2f64.powi(last / 2) * 2f64.powi(last - last / 2);
        let x = if format.limit == F32.limit {
            f64::from(x as f32)
        } else {
            x
        };
        if self.sign() == Ordering::Less { -x } else { x }
    }

    /// The narrowest interval of f64 around the number.
    pub fn enclosure(&self) -> Interval {
        let x = self.rounded(F64);
        if x.is_infinite() {
            return Interval::WHOLE;
        }
        match self.cmp(&x.into()) {
            Ordering::Less => Interval {
                lo: x.next_down(),
                hi: x,
            },
            Ordering::Equal => Interval::point(x),
            Ordering::Greater => Interval {
                lo: x,
                hi: x.next_up(),
            },
        }
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        self.sign()
            .cmp(&other.sign())
            .then_with(|| self.minus(other).sign())
    }
}

impl From<f64> for Dyadic {
    /// Exact. An infinity becomes 2¹⁰²⁴ and a NaN a number beyond it, so that no input can panic.
    fn from(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (size, exponent) = match exponent {
            0 => (fraction, -1074),
            _ => (fraction | 1 << 52, exponent - 1075),
        };
        if size == 0 {
            return Self::new(IBig::ZERO, 0);
        }
        // Short mantissas keep the products short.
        let zeros = size.trailing_zeros();
        let size = IBig::from(size >> zeros);
        Self::new(if x < 0.0 { -size } else { size }, exponent + zeros as i32)
    }
}

impl From<f32> for Dyadic {
    fn from(x: f32) -> Self {
        f64::from(x).into()
    }
}

impl From<i32> for Dyadic {
    fn from(x: i32) -> Self {
        Self::new(x.into(), 0)
    }
}

impl Ring for Dyadic {
    fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return other.clone();
        } else if other.is_zero() {
            return self.clone();
        }
        let exponent = self.exponent.min(other.exponent);
        let mantissa = match self.exponent.cmp(&other.exponent) {
            Ordering::Less => &self.mantissa + other.in_units_of(exponent),
            Ordering::Equal => &self.mantissa + &other.mantissa,
            Ordering::Greater => self.in_units_of(exponent) + &other.mantissa,
        };
        Self::new(mantissa, exponent)
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(&-other.clone())
    }

    fn times(&self, other: &Self) -> Self {
        Self::new(
            &self.mantissa * &other.mantissa,
            self.exponent + other.exponent,
        )
    }

    fn square(&self) -> Self {
        self.times(self)
    }

    fn is_zero(&self) -> bool {
        self.mantissa == IBig::ZERO
    }

    fn doubled(&self) -> Self {
        self.scaled(1)
    }
}

impl Add for Dyadic {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.plus(&other)
    }
}

impl Sub for Dyadic {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.minus(&other)
    }
}

impl Mul for Dyadic {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.times(&other)
    }
}

impl Neg for Dyadic {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.mantissa, self.exponent)
    }
}

//! One number as a lane.

use super::{LANES, Lane, LaneMask, Number, Stored};
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdWiden, f32x8, f64x8};

impl LaneMask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

macro_rules! scalar_lane {
    ($number:ty, $widened:expr) => {
        impl Lane for $number {
            type Token = ();
            type Mask = bool;
            type Number = $number;
            #[inline(always)]
            fn splat(_: (), x: $number) -> Self {
                x
            }
            #[inline(always)]
            fn token(self) {}
            #[inline(always)]
            fn abs(self) -> Self {
                <$number>::abs(self)
            }
            #[inline(always)]
            fn flip(self, sign: Self) -> Self {
                if sign.is_sign_negative() { -self } else { self }
            }
            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn greater(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            #[inline(always)]
            fn widened(self, factors: [Self; 4]) -> Self {
                $widened(self, factors)
            }
        }
    };
}

scalar_lane!(f32, |_, factors: [f32; 4]| difference_of_products(factors));
scalar_lane!(f64, |x, _| x);

/// `a·b − c·d` in f64, where products of two f32 are exact, so that the sign is right. Rounding to f32 keeps the
/// sign.
pub(super) fn difference_of_products(factors: [f32; 4]) -> f32 {
    let [a, b, c, d] = factors.map(f64::from);
    let difference = a * b - c * d;
    let least = f64::from(f32::MIN_POSITIVE);
    if difference != 0.0 && difference.abs() < least {
        least.copysign(difference) as f32
    } else {
        difference as f32
    }
}

impl Number for f32 {
    type Lanes<S: Simd> = f32x8<S>;
    const U: Self = f32::EPSILON / 2.0;
    const LEAST_NORMAL: Self = f32::MIN_POSITIVE;
    const HOLDS_PRODUCTS: bool = false;
    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }
    #[inline(always)]
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> f32x8<S> {
        f32x8::load_array_ref(token, from)
    }
    #[inline(always)]
    fn store<S: Simd>(lanes: f32x8<S>) -> [f32; LANES] {
        lanes.to_array()
    }
}

impl Number for f64 {
    type Lanes<S: Simd> = f64x8<S>;
    const U: Self = f64::EPSILON / 2.0;
    const LEAST_NORMAL: Self = f64::MIN_POSITIVE;
    const HOLDS_PRODUCTS: bool = true;
    #[inline(always)]
    fn to_f32(self) -> f32 {
        self as f32
    }
    #[inline(always)]
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> f64x8<S> {
        let (low, high) = f32x8::load_array_ref(token, from).widen();
        low.combine(high)
    }
    #[inline(always)]
    fn store<S: Simd>(lanes: f64x8<S>) -> [f64; LANES] {
        lanes.to_array()
    }
}

impl<N: Number> Stored<N> for f32 {
    #[inline(always)]
    fn number(self) -> N {
        N::from(self)
    }
    #[inline(always)]
    fn lanes<S: Simd>(token: S, from: &[Self; LANES]) -> N::Lanes<S> {
        N::load(token, from)
    }
}

/// Exact for numbers that f32 holds.
impl Stored<f32> for f64 {
    #[inline(always)]
    fn number(self) -> f32 {
        self.to_f32()
    }
    #[inline(always)]
    fn lanes<S: Simd>(token: S, from: &[Self; LANES]) -> f32x8<S> {
        let mut narrowed = [0.0; LANES];
        let mut i = 0;
        while i < LANES {
            narrowed[i] = from[i].to_f32();
            i += 1;
        }
        f32x8::load_array(token, narrowed)
    }
}

impl Stored<f64> for f64 {
    #[inline(always)]
    fn number(self) -> f64 {
        self
    }
    #[inline(always)]
    fn lanes<S: Simd>(token: S, from: &[Self; LANES]) -> f64x8<S> {
        f64x8::load_array_ref(token, from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_that_hides_a_sign_is_resolved_in_f64() {
        // 1e-30 · 1e-30 underflows in f32, not in f64.
        let (a, b) = (1e-30f32, 1e-30f32);
        assert_eq!(a * b, 0.0);
        assert_eq!((a * b).widened([a, b, 0.0, 0.0]), f32::MIN_POSITIVE);
        assert_eq!((a * b).widened([0.0, 0.0, a, b]), -f32::MIN_POSITIVE);
        assert_eq!(0f32.widened([a, b, b, a]), 0.0);
        assert_eq!(0.5f64.widened([3.0, 4.0, 5.0, 6.0]), 0.5);
    }
}

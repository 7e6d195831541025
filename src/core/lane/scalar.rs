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
    ($number:ty) => {
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
            fn sqrt(self) -> Self {
                <$number>::sqrt(self)
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
            fn map<const COUNT: usize>(
                values: [Self; COUNT],
                mut of: impl FnMut([Self; COUNT]) -> Self,
            ) -> Self {
                of(values)
            }
            #[inline(always)]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
        }
    };
}

scalar_lane!(f32);
scalar_lane!(f64);

impl Number for f32 {
    type Lanes<S: Simd> = f32x8<S>;
    const U: Self = f32::EPSILON / 2.0;
    const LEAST_NORMAL: Self = f32::MIN_POSITIVE;
    const HOLDS_PRODUCTS: bool = false;
    // The bound of a triangle at 45° to the ray is some 64u, whatever its size: 512u leaves one hit in a
    // hundred to be computed again. What is measured is a hundredth of the bound.
    const T_SLACK: Self = 512.0 * Self::U;
    const WEIGHT_SLACK: Self = Self::INFINITY;
    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }
    #[inline(always)]
    fn of_f64(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn next_up(self) -> Self {
        Self::next_up(self)
    }
    #[inline(always)]
    fn next_down(self) -> Self {
        Self::next_down(self)
    }
    #[inline(always)]
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> f32x8<S> {
        f32x8::load_array_ref(token, from)
    }
    #[inline(always)]
    fn gather<S: Simd>(token: S, from: [f32; LANES]) -> f32x8<S> {
        f32x8::load_array(token, from)
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
    // 2⁻³¹: 2⁻⁶ of f32's half ulp of 1, so that a rounded t errs by at most 0.51 ulp.
    const T_SLACK: Self = 0.5 / (1u64 << 31) as f64;
    const WEIGHT_SLACK: Self = 1.0 / (1u64 << 31) as f64;
    #[inline(always)]
    fn to_f32(self) -> f32 {
        self as f32
    }
    #[inline(always)]
    fn of_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn next_up(self) -> Self {
        Self::next_up(self)
    }
    #[inline(always)]
    fn next_down(self) -> Self {
        Self::next_down(self)
    }
    #[inline(always)]
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> f64x8<S> {
        let (low, high) = f32x8::load_array_ref(token, from).widen();
        low.combine(high)
    }
    #[inline(always)]
    fn gather<S: Simd>(token: S, from: [f64; LANES]) -> f64x8<S> {
        f64x8::load_array(token, from)
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

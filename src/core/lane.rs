//! What a kernel needs from a number, be it one f32 or a SIMD vector of them.
//!
//! Kernels are written once over [`Lane`]; a scalar and a vector then do the same operations in the
//! same order, so that they give the same bits, but for NaN in [`Lane::lesser`] and
//! [`Lane::greater`], which a kernel must reject by other means. There is no fused multiply-add here:
//! it would make results depend on the CPU, and break the watertight kernel's proof.

use fearless_simd::{Simd, f32x4, mask32x4, prelude::*};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

/// Which lanes a comparison holds for.
pub trait LaneMask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> {
    /// Whether it holds for any lane.
    fn any(self) -> bool;
    /// One bit a lane, the first lane lowest.
    fn bits(self) -> u32;
}

/// One number, or several of them side by side.
pub trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// What makes one: nothing for a scalar, the proof of the CPU's features for a vector.
    type Token: Copy;
    /// What comparing two of them gives.
    type Mask: LaneMask;

    /// The same number in all lanes.
    fn splat(token: Self::Token, x: f32) -> Self;
    /// The token this was made with.
    fn token(self) -> Self::Token;
    /// `|x|`.
    fn abs(self) -> Self;
    /// The number, negated where `sign` has its sign bit set.
    fn flip(self, sign: Self) -> Self;
    /// The smaller one. Where one is NaN, either.
    fn lesser(self, other: Self) -> Self;
    /// The larger one. Where one is NaN, either.
    fn greater(self, other: Self) -> Self;
    /// `self < other`; never for a NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self ≤ other`; never for a NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `self = other`; never for a NaN.
    fn eq(self, other: Self) -> Self::Mask;
    /// `a` where the mask holds, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Applies `f` lane by lane, in f64, to four numbers. For what is rarely needed: it is slow.
    fn map4_in_f64(args: [Self; 4], f: impl Fn([f64; 4]) -> f64) -> Self;
}

impl LaneMask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

impl Lane for f32 {
    type Token = ();
    type Mask = bool;
    #[inline(always)]
    fn splat(_: (), x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn token(self) {}
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
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
    fn map4_in_f64(args: [Self; 4], f: impl Fn([f64; 4]) -> f64) -> Self {
        f(args.map(f64::from)) as f32
    }
}

impl<S: Simd> LaneMask for mask32x4<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.any_true()
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.to_bitmask() as u32
    }
}

impl<S: Simd> Lane for f32x4<S> {
    type Token = S;
    type Mask = mask32x4<S>;
    #[inline(always)]
    fn splat(token: S, x: f32) -> Self {
        SimdBase::splat(token, x)
    }
    #[inline(always)]
    fn token(self) -> S {
        ExtractToken::token(&self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }
    #[inline(always)]
    fn flip(self, sign: Self) -> Self {
        SimdFloat::from_bits(self.to_bits() ^ (sign.to_bits() & 0x8000_0000))
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        self.min(other)
    }
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        self.max(other)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        self.simd_le(other)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Self::Mask {
        self.simd_eq(other)
    }
    #[inline(always)]
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
        mask.select(a, b)
    }
    #[inline(always)]
    fn map4_in_f64(args: [Self; 4], f: impl Fn([f64; 4]) -> f64) -> Self {
        let token = args[0].token();
        let args = args.map(|x| x.to_array());
        let lane = |i: usize| f(args.map(|x| f64::from(x[i]))) as f32;
        SimdBase::load_array(token, std::array::from_fn(lane))
    }
}

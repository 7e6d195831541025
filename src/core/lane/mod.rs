//! The arithmetic that kernels use, for one f32 or f64 or a SIMD vector of them.
//!
//! Kernels are written once over [`Lane`]. A scalar and a vector then do the same operations in the same
//! order and give the same bits, except for NaN in [`Lane::lesser`] and [`Lane::greater`], which a kernel
//! must reject by other means. There is no fused multiply-add: it would make results depend on the CPU and
//! break the proof of the watertight kernel.

mod scalar;
mod vector;

use fearless_simd::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Width of a vector over triangles.
pub const LANES: usize = 8;
/// Width of a vector over rays.
pub const PACKET: usize = 16;

/// The lanes for which a comparison holds.
pub trait LaneMask:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Whether it holds in any lane.
    fn any(self) -> bool;
    /// Whether it holds in all lanes.
    fn all(self) -> bool;
    /// One bit per lane; the first lane is the lowest bit.
    fn bits(self) -> u32;
}

/// One number, or a vector of numbers.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Proof that the CPU has the instructions; `()` for a scalar.
    type Token: Copy;
    /// Result of a comparison.
    type Mask: LaneMask;
    /// The number in one lane.
    type Number: Number;

    /// The same number in all lanes.
    fn splat(token: Self::Token, x: Self::Number) -> Self;
    /// The token that this was made with.
    fn token(self) -> Self::Token;
    /// `|x|`.
    fn abs(self) -> Self;
    /// The square root; NaN for negative numbers.
    fn sqrt(self) -> Self;
    /// Negated in the lanes where `sign` has its sign bit set.
    fn flip(self, sign: Self) -> Self;
    /// The smaller number; unspecified which one if either is NaN.
    fn lesser(self, other: Self) -> Self;
    /// The larger number; unspecified which one if either is NaN.
    fn greater(self, other: Self) -> Self;
    /// `self < other`; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self ≤ other`; false for NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `a` where the mask holds, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// Applies a function of several numbers in each lane.
    fn map<const COUNT: usize>(
        values: [Self; COUNT],
        of: impl FnMut([Self::Number; COUNT]) -> Self::Number,
    ) -> Self;

    /// The same f32 in all lanes.
    #[inline(always)]
    fn of(token: Self::Token, x: f32) -> Self {
        Self::splat(token, Self::Number::from(x))
    }
}

/// A scalar type of kernels: f32 or f64.
pub trait Number:
    Lane<Token = (), Mask = bool, Number = Self>
    + Stored<Self>
    + Stored<f32>
    + PartialOrd
    + From<f32>
    + Into<f64>
    + Send
    + Sync
    + 'static
{
    /// A vector of [`LANES`] of them.
    type Lanes<S: Simd>: Lane<Token = S, Number = Self>;
    /// Unit roundoff, the largest relative error of one operation: 2⁻²⁴ or 2⁻⁵³.
    const U: Self;
    /// The least normal number.
    const LEAST_NORMAL: Self;
    /// Whether the product of any two f32 is exact.
    const HOLDS_PRODUCTS: bool;
    /// Relative error bound of t above which a kernel computes it again in more digits.
    const T_SLACK: Self;
    /// The same for a weight; absolute.
    const WEIGHT_SLACK: Self;
    /// Rounded to f32; infinite if it overflows.
    fn to_f32(self) -> f32;
    /// Rounded from f64.
    fn of_f64(x: f64) -> Self;
    /// The number after this one.
    fn next_up(self) -> Self;
    /// The number before this one.
    fn next_down(self) -> Self;
    /// Widens [`LANES`] f32.
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> Self::Lanes<S>;
    /// A vector of the numbers.
    fn gather<S: Simd>(token: S, from: [Self; LANES]) -> Self::Lanes<S>;
    /// The numbers of a vector.
    fn store<S: Simd>(lanes: Self::Lanes<S>) -> [Self; LANES];
}

/// The storage type of a kernel that computes in `N`: `N` itself, or f32 if it stores corners only, which
/// are f32 in the mesh and widen exactly.
pub trait Stored<N>: Copy + Default + Send + Sync + 'static {
    /// The value widened to `N`.
    fn number(self) -> N;
    /// [`LANES`] values widened to `N`.
    fn lanes<S: Simd>(token: S, from: &[Self; LANES]) -> N::Lanes<S>
    where
        N: Number;
}

/// Numbers of several primitives, one primitive per lane: parameters, or a kernel's packed values.
///
/// A kernel loads only the values that it needs, so permuting the axes changes an address and needs no
/// shuffle of loaded vectors.
pub trait Values<L: Lane> {
    /// The value at an index of the layout.
    fn value(&self, index: usize) -> L;

    /// Three consecutive values.
    #[inline(always)]
    fn three(&self, first: usize) -> [L; 3] {
        [
            self.value(first),
            self.value(first + 1),
            self.value(first + 2),
        ]
    }
}

/// The values of one primitive.
impl<N: Number, T: Stored<N>> Values<N> for &[T] {
    #[inline(always)]
    fn value(&self, index: usize) -> N {
        self[index].number()
    }
}

/// The values of one primitive.
impl<N: Number, T: Stored<N>, const COUNT: usize> Values<N> for [T; COUNT] {
    #[inline(always)]
    fn value(&self, index: usize) -> N {
        self[index].number()
    }
}

/// `a × b`.
#[inline(always)]
pub fn cross<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a · b`.
#[inline(always)]
pub fn dot<L: Lane>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a − b`.
#[inline(always)]
pub fn minus<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s · v`. Written out, like the others, because a closure passed to an array's `map` may be compiled
/// without the CPU's features.
#[inline(always)]
pub fn times<L: Lane>(s: L, v: &[L; 3]) -> [L; 3] {
    [s * v[0], s * v[1], s * v[2]]
}

/// `a + b`.
#[inline(always)]
pub fn plus<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The smaller of each pair of components; see [`Lane::lesser`].
#[inline(always)]
pub fn least<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0].lesser(b[0]), a[1].lesser(b[1]), a[2].lesser(b[2])]
}

/// The larger of each pair of components; see [`Lane::greater`].
#[inline(always)]
pub fn greatest<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0].greater(b[0]), a[1].greater(b[1]), a[2].greater(b[2])]
}

/// The axis of the component that is largest in magnitude; the first one of several.
#[inline(always)]
pub fn longest_axis<N: Number>(v: [N; 3]) -> usize {
    let size = v.map(N::abs);
    if size[0] >= size[1] && size[0] >= size[2] {
        0
    } else if size[1] >= size[2] {
        1
    } else {
        2
    }
}

//! What a kernel needs from a number, be it one f32 or f64 or a SIMD vector of them.
//!
//! Kernels are written once over [`Lane`]; a scalar and a vector then do the same operations in the
//! same order, so that they give the same bits, but for NaN in [`Lane::lesser`] and
//! [`Lane::greater`], which a kernel must reject by other means. There is no fused multiply-add here:
//! it would make results depend on the CPU, and break the watertight kernel's proof.

mod scalar;
mod vector;

use fearless_simd::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Numbers in a vector of triangles.
pub const LANES: usize = 8;
/// Numbers in a vector of rays.
pub const PACKET: usize = 16;

/// Which lanes a comparison holds for.
pub trait LaneMask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> {
    /// Whether it holds for any lane.
    fn any(self) -> bool;
    /// Whether it holds for all lanes.
    fn all(self) -> bool;
    /// One bit a lane, the first lane lowest.
    fn bits(self) -> u32;
}

/// One number, or several of them side by side.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// What makes one: nothing for a scalar, the proof of the CPU's features for a vector.
    type Token: Copy;
    /// What comparing two of them gives.
    type Mask: LaneMask;
    /// What is in one lane.
    type Number: Number;

    /// The same number in all lanes.
    fn splat(token: Self::Token, x: Self::Number) -> Self;
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
    /// What this, computed as `a·b − c·d`, would be in the next wider format; only its sign counts.
    /// As it is where there is none: f64. For what is rarely needed: it is slow.
    fn widened(self, factors: [Self; 4]) -> Self;

    /// The same f32 in all lanes.
    #[inline(always)]
    fn of(token: Self::Token, x: f32) -> Self {
        Self::splat(token, Self::Number::from(x))
    }
}

/// What a lane holds: f32 or f64.
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
    /// [`LANES`] of them side by side.
    type Lanes<S: Simd>: Lane<Token = S, Number = Self>;
    /// What a rounding errs by at most, relatively: 2⁻²⁴ or 2⁻⁵³.
    const U: Self;
    /// The least normal number.
    const LEAST_NORMAL: Self;
    /// Whether it holds the product of two f32 exactly.
    const HOLDS_PRODUCTS: bool;
    /// Rounded; infinite where f32 has no such number.
    fn to_f32(self) -> f32;
    /// So many f32.
    fn load<S: Simd>(token: S, from: &[f32; LANES]) -> Self::Lanes<S>;
    /// The numbers of a vector.
    fn store<S: Simd>(lanes: Self::Lanes<S>) -> [Self; LANES];
}

/// What a kernel that works in `N` may keep its triangles as: `N`, or f32 where it keeps nothing but
/// corners, which are f32 in the mesh and widened exactly.
pub trait Stored<N>: Copy + Default + Send + Sync + 'static {
    /// One of them, in `N`.
    fn number(self) -> N;
    /// [`LANES`] of them, in `N`.
    fn lanes<S: Simd>(token: S, from: &[Self; LANES]) -> N::Lanes<S>
    where
        N: Number;
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

/// `s · v`. Written out, like the others: what an array's `map` calls may lose the CPU's features.
#[inline(always)]
pub fn times<L: Lane>(s: L, v: &[L; 3]) -> [L; 3] {
    [s * v[0], s * v[1], s * v[2]]
}

/// `a + b`.
#[inline(always)]
pub fn plus<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The axis along which a vector is longest; of several the first.
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

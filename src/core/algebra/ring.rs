//! The numbers that a shape's formulas are generic over, and vectors of them.

use glam::Vec3;
use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

/// A number that is constructed exactly from f32 and f64 and closed under +, − and ×.
///
/// [`Interval`](super::Interval) encloses the results, [`Dyadic`](super::Dyadic) computes them exactly.
/// The operators consume their operands; `plus`, `minus` and `times` take references.
pub trait Ring:
    Clone
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + From<f32>
    + From<f64>
    + From<i32>
{
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;

    /// The number times itself: for intervals never negative, and narrower than a product.
    fn square(&self) -> Self;

    /// Whether the number is certainly 0.
    fn is_zero(&self) -> bool;

    fn zero() -> Self {
        Self::from(0)
    }

    fn doubled(&self) -> Self {
        self.plus(self)
    }
}

/// The vector with the components of `v`.
#[inline(always)]
pub fn vector<R: Ring>(v: Vec3) -> [R; 3] {
    v.to_array().map(R::from)
}

/// `a − b`.
#[inline(always)]
pub fn difference<R: Ring>(a: &[R; 3], b: &[R; 3]) -> [R; 3] {
    std::array::from_fn(|i| a[i].minus(&b[i]))
}

/// `a·b`.
#[inline(always)]
pub fn dot<R: Ring>(a: &[R; 3], b: &[R; 3]) -> R {
    a[0].times(&b[0]) + a[1].times(&b[1]) + a[2].times(&b[2])
}

/// `a·a`.
#[inline(always)]
pub fn squared_length<R: Ring>(a: &[R; 3]) -> R {
    a[0].square() + a[1].square() + a[2].square()
}

/// `a × b`.
#[inline(always)]
pub fn cross<R: Ring>(a: &[R; 3], b: &[R; 3]) -> [R; 3] {
    let component = |i: usize, j: usize| a[i].times(&b[j]) - a[j].times(&b[i]);
    [component(1, 2), component(2, 0), component(0, 1)]
}

//! Polynomials of degree 4 at most.

use super::dyadic::Dyadic;
use super::interval::Interval;
use super::ring::Ring;
use std::array::from_fn;

/// The highest degree that a shape needs: the torus is a quartic surface.
pub const MAX_DEGREE: usize = 4;

/// `c₀ + c₁t + … + cₙtⁿ`. Coefficients above the degree are 0; the leading one may be 0, too.
#[derive(Clone, Debug)]
pub struct Polynomial<R> {
    coefficients: [R; MAX_DEGREE + 1],
    degree: usize,
}

impl<R: Ring> Polynomial<R> {
    /// The polynomial with the coefficients in ascending order of powers.
    ///
    /// # Panics
    /// If there are more than five coefficients, or none.
    pub fn new<const N: usize>(coefficients: [R; N]) -> Self {
        assert!(0 < N && N <= MAX_DEGREE + 1, "a degree between 0 and 4");
        let mut given = coefficients.into_iter();
        Self {
            coefficients: from_fn(|_| given.next().unwrap_or_else(R::zero)),
            degree: N - 1,
        }
    }

    pub fn constant(c0: R) -> Self {
        Self::new([c0])
    }

    /// The coefficients in ascending order of powers.
    pub fn coefficients(&self) -> &[R] {
        &self.coefficients[..=self.degree]
    }

    /// The coefficients without leading ones that are certainly 0, but the first always.
    #[inline(always)]
    pub fn significant(&self) -> &[R] {
        let mut degree = self.degree;
        while degree > 0 && self.coefficients[degree].is_zero() {
            degree -= 1;
        }
        &self.coefficients[..=degree]
    }

    /// The value at `t`, by Horner's rule.
    #[inline(always)]
    pub fn at(&self, t: &R) -> R {
        let mut value = self.coefficients[self.degree].clone();
        for c in self.coefficients[..self.degree].iter().rev() {
            value = value.times(t).plus(c);
        }
        value
    }

    #[inline(always)]
    pub fn derivative(&self) -> Self {
        Self {
            coefficients: from_fn(|i| match self.coefficients.get(i + 1) {
                Some(c) => c.times(&R::from(i as i32 + 1)),
                None => R::zero(),
            }),
            degree: self.degree.saturating_sub(1),
        }
    }

    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            coefficients: from_fn(|i| self.coefficients[i].plus(&other.coefficients[i])),
            degree: self.degree.max(other.degree),
        }
    }

    #[inline(always)]
    pub fn minus(&self, other: &Self) -> Self {
        Self {
            coefficients: from_fn(|i| self.coefficients[i].minus(&other.coefficients[i])),
            degree: self.degree.max(other.degree),
        }
    }

    /// # Panics
    /// If the product's degree exceeds 4.
    #[inline(always)]
    pub fn times(&self, other: &Self) -> Self {
        let mut product: [R; MAX_DEGREE + 1] = from_fn(|_| R::zero());
        for (i, a) in self.coefficients().iter().enumerate() {
            for (j, b) in other.coefficients().iter().enumerate() {
                product[i + j] = product[i + j].plus(&a.times(b));
            }
        }
        Self {
            coefficients: product,
            degree: self.degree + other.degree,
        }
    }

    /// The polynomial times a number.
    #[inline(always)]
    pub fn scaled(&self, factor: &R) -> Self {
        Self {
            coefficients: from_fn(|i| self.coefficients[i].times(factor)),
            degree: self.degree,
        }
    }
}

impl Polynomial<Dyadic> {
    /// The polynomial with the narrowest intervals around the coefficients.
    pub fn enclosure(&self) -> Polynomial<Interval> {
        Polynomial {
            coefficients: from_fn(|i| self.coefficients[i].enclosure()),
            degree: self.degree,
        }
    }
}

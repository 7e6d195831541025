//! Polynomials of degree 2 at most with integer coefficients.

use dashu_int::IBig;

/// c₀ + c₁t + c₂t².
#[derive(Clone, Debug)]
pub(super) struct Quadratic(pub [IBig; 3]);

impl Quadratic {
    pub fn constant(c: IBig) -> Self {
        Self([c, IBig::ZERO, IBig::ZERO])
    }

    /// a + bt.
    pub fn linear(a: IBig, b: IBig) -> Self {
        Self([a, b, IBig::ZERO])
    }

    /// (a + bt)².
    pub fn square([a, b]: [&IBig; 2]) -> Self {
        Self([a * a, (a * b) << 1, b * b])
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] + &other.0[k]))
    }

    pub fn minus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] - &other.0[k]))
    }

    pub fn times(&self, factor: &IBig) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] * factor))
    }

    /// The polynomial through (−1, y₋₁), (0, y₀) and (1, y₁), times 2.
    pub fn through([before, middle, after]: [&IBig; 3]) -> Self {
        Self([middle << 1, after - before, after + before - (middle << 1)])
    }
}

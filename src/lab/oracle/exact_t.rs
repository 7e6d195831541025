//! Exact values of t.

use super::fraction::Fraction;
use super::isolated::IsolatedRoot;
use super::surd::Surd;
use std::cmp::Ordering;

/// The exact t of a crossing, in lengths of the ray's direction.
#[derive(Clone, Debug)]
pub struct ExactT(Number);

#[derive(Clone, Debug)]
enum Number {
    Surd(Surd),
    Isolated(Box<IsolatedRoot>),
}

impl From<Surd> for ExactT {
    fn from(surd: Surd) -> Self {
        Self(Number::Surd(surd))
    }
}

impl From<IsolatedRoot> for ExactT {
    fn from(root: IsolatedRoot) -> Self {
        Self(Number::Isolated(Box::new(root)))
    }
}

impl ExactT {
    /// Compares two values exactly. Both may be enclosed more closely.
    pub fn compare(&mut self, other: &mut Self) -> Ordering {
        match (&mut self.0, &mut other.0) {
            (Number::Surd(a), Number::Surd(b)) => a.compare(b),
            (Number::Isolated(a), Number::Surd(b)) => a.compare_with_surd(b),
            (Number::Surd(a), Number::Isolated(b)) => b.compare_with_surd(a).reverse(),
            (Number::Isolated(a), Number::Isolated(b)) => a.compare(b),
        }
    }

    /// A number between this one and a larger one; `None` if they are closer than f64 numbers are.
    pub fn between(&mut self, larger: &mut Self) -> Option<f64> {
        let [low, high] = [self.to_f64(), larger.to_f64()];
        let middle = 0.5 * low + 0.5 * high;
        // An end is at most half way to the next f64.
        (low < middle && middle < high).then_some(middle)
    }

    /// The nearest f64, ties to even.
    pub fn to_f64(&mut self) -> f64 {
        self.rounded(Fraction::to_f64, f64::next_up)
    }

    /// The nearest f32, ties to even; infinity beyond the largest.
    pub fn to_f32(&mut self) -> f32 {
        let next = |x: f64| f64::from((x as f32).next_up());
        self.rounded(|t| f64::from(t.to_f32()), next) as f32
    }

    fn rounded(&mut self, round: impl Fn(&Fraction) -> f64, next: impl Fn(f64) -> f64) -> f64 {
        match &mut self.0 {
            Number::Surd(surd) => surd.rounded(round),
            Number::Isolated(root) => root.rounded(round, next),
        }
    }
}

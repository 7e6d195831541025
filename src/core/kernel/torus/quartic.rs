//! Roots of polynomials of degree 4 at most, by bisection between the roots of the derivative.
//!
//! Source: Hook, McAree, "Using Sturm Sequences to Bracket Real Roots of Polynomial Equations", Graphics Gems, 1990,
//! for bisection in brackets; here the derivative's roots are the brackets.

use crate::lane::Number;

/// Roots in ascending order; the first `count` are set.
pub(super) struct Roots<N> {
    pub values: [N; 4],
    pub count: usize,
}

// Not inlined: it is long, and called from many copies of the tree's walk.
/// The roots of c₀ + c₁t + … in an interval, where the sign changes or a turning point is exactly 0.
#[inline(never)]
pub(super) fn roots<N: Number>(coefficients: &[N], [start, end]: [N; 2]) -> Roots<N> {
    let zero = N::from(0.0);
    let mut found = Roots {
        values: [zero; 4],
        count: 0,
    };
    let [constant, rest @ ..] = coefficients else {
        return found;
    };
    if rest.is_empty() {
        return found;
    }
    if let [slope] = rest {
        let root = -*constant / *slope;
        if start < root && root < end {
            found.push(root);
        }
        return found;
    }
    // The turning points.
    let mut derivative = [zero; 4];
    let degree = rest.len();
    for (power, (to, from)) in derivative.iter_mut().zip(rest).enumerate() {
        *to = *from * N::from((power + 1) as f32);
    }
    let turns = roots(&derivative[..degree], [start, end]);
    let mut from = start;
    for to in turns.iter().chain([end]) {
        found.bracketed(coefficients, [from, to]);
        from = to;
    }
    found
}

impl<N: Number> Roots<N> {
    pub fn iter(&self) -> impl Iterator<Item = N> {
        self.values.into_iter().take(self.count)
    }

    fn push(&mut self, root: N) {
        let is_new = self.count == 0 || self.values[self.count - 1] < root;
        if is_new && self.count < self.values.len() {
            self.values[self.count] = root;
            self.count += 1;
        }
    }

    /// Adds the root between two neighbouring turning points, if there is one. The end counts, the start doesn't.
    fn bracketed(&mut self, coefficients: &[N], [mut low, mut high]: [N; 2]) {
        let zero = N::from(0.0);
        let (at_low, at_high) = (value(coefficients, low), value(coefficients, high));
        if at_high == zero {
            self.push(high);
        } else if (at_low < zero && zero < at_high) || (at_high < zero && zero < at_low) {
            let half = N::from(0.5);
            loop {
                let middle = low * half + high * half;
                if !(low < middle && middle < high) {
                    break;
                }
                if (value(coefficients, middle) < zero) == (at_low < zero) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            self.push(high);
        }
    }
}

/// The value at t, by Horner's rule.
fn value<N: Number>(coefficients: &[N], t: N) -> N {
    let zero = N::from(0.0);
    coefficients.iter().rev().fold(zero, |sum, c| sum * t + *c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(factors: [f64; 4]) -> Vec<f64> {
        let mut coefficients = vec![1.0];
        for root in factors {
            let mut next = vec![0.0; coefficients.len() + 1];
            for (k, c) in coefficients.iter().enumerate() {
                next[k] -= root * c;
                next[k + 1] += c;
            }
            coefficients = next;
        }
        roots(&coefficients, [-10.0, 10.0]).iter().collect()
    }

    #[test]
    fn all_roots_of_products_are_found_in_order() {
        let found = of([3.0, -1.0, 2.0, 0.5]);
        assert_eq!(found.len(), 4);
        for (found, expected) in found.iter().zip([-1.0, 0.5, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        // Only the roots inside the interval.
        assert_eq!(of([3.0, 11.0, -12.0, 2.0]).len(), 2);
        // A double root is a turning point at 0.
        assert_eq!(of([1.0, 1.0, 4.0, 5.0]).len(), 3);
    }
}

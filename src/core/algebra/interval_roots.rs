//! Roots of a polynomial with interval coefficients.
//!
//! The result holds for every polynomial whose coefficients are members of the intervals.
//! Degree 2: Press, Teukolsky, Vetterling, Flannery, "Numerical Recipes", 3rd ed., section 5.6.
//! Degrees 3 and 4: the signs at the roots of the derivative separate the roots. Newton's method approaches
//! each, and one step of the interval Newton method proves its bounds (Moore, Kearfott, Cloud, "Introduction to
//! Interval Analysis", SIAM 2009, chapter 8).
//! Promises: all real roots are simple and each interval contains one.
//! Doesn't promise: an answer. Multiple roots, and leading coefficients that may be 0, are never decided.

use super::interval::Interval;
use super::polynomial::{MAX_DEGREE, Polynomial};
use super::ring::Ring;
use std::cmp::Ordering;
use std::ops::Deref;

/// Disjoint intervals in ascending order.
#[derive(Clone, Copy, Debug)]
pub struct RootIntervals {
    intervals: [Interval; MAX_DEGREE],
    count: usize,
}

impl RootIntervals {
    pub(super) const NONE: Self = Self {
        intervals: [Interval::ZERO; MAX_DEGREE],
        count: 0,
    };

    /// Appends an interval, or returns `None` if it isn't behind the last one or unbounded.
    #[inline(always)]
    pub(super) fn with(mut self, interval: Interval) -> Option<Self> {
        let is_behind = self.last().is_none_or(|last| last.hi < interval.lo);
        if !(is_behind && interval.is_bounded()) {
            return None;
        }
        self.intervals[self.count] = interval;
        self.count += 1;
        Some(self)
    }
}

impl Deref for RootIntervals {
    type Target = [Interval];
    #[inline(always)]
    fn deref(&self) -> &[Interval] {
        &self.intervals[..self.count]
    }
}

/// All real roots, or `None` if the intervals can't tell how many there are. The polynomial 0 has none.
#[inline(always)]
pub fn isolated_roots(polynomial: &Polynomial<Interval>) -> Option<RootIntervals> {
    match *polynomial.significant() {
        [c0] => c0.sign().map(|_| RootIntervals::NONE),
        [c0, c1] => of_line(c0, c1),
        [c0, c1, c2] => of_quadratic(c0, c1, c2),
        _ => of_higher_degree(polynomial),
    }
}

#[inline(always)]
fn of_line(c0: Interval, c1: Interval) -> Option<RootIntervals> {
    // An unbounded quotient, by an interval that contains 0, is refused.
    RootIntervals::NONE.with(-c0 / c1)
}

#[inline(always)]
fn of_quadratic(c: Interval, b: Interval, a: Interval) -> Option<RootIntervals> {
    let discriminant = b.square() - a.doubled() * c.doubled();
    match discriminant.sign() {
        Some(Ordering::Less) => return Some(RootIntervals::NONE),
        Some(Ordering::Greater) => {}
        _ => return None,
    }
    let root = discriminant.sqrt();
    // Sums of numbers of the same sign, if b's sign is known; otherwise b is negligible.
    let (x, y) = match b.sign() {
        Some(Ordering::Greater) => {
            let q = -(b + root);
            (q / a.doubled(), c.doubled() / q)
        }
        Some(Ordering::Less) => {
            let q = root - b;
            (q / a.doubled(), c.doubled() / q)
        }
        _ => ((root - b) / a.doubled(), -(root + b) / a.doubled()),
    };
    let (first, second) = if x.lo < y.lo { (x, y) } else { (y, x) };
    RootIntervals::NONE.with(first)?.with(second)
}

// Not inlined: recursive.
fn of_higher_degree(p: &Polynomial<Interval>) -> Option<RootIntervals> {
    let slope = p.derivative();
    let turning_points = isolated_roots(&slope)?;
    let bound = root_bound(p)?;
    let [.., lead] = p.significant() else {
        return None;
    };
    let lead = lead.sign()?;

    // Between turning points and beyond the bound, the polynomial is monotone.
    let numeric = Numeric::new(p);
    let mut roots = RootIntervals::NONE;
    let is_odd = p.significant().len().is_multiple_of(2);
    let mut left = -bound;
    let mut left_sign = if is_odd { lead.reverse() } else { lead };
    let ends = turning_points.iter().map(|x| (*x, p.at(x).sign()));
    for (right, sign) in ends.chain([(Interval::point(bound), Some(lead))]) {
        let right_sign = sign.filter(|sign| *sign != Ordering::Equal)?;
        if left_sign != right_sign {
            roots = roots.with(root_between(
                p,
                &slope,
                &numeric,
                [left, right.lo],
                left_sign,
            )?)?;
        }
        (left, left_sign) = (right.hi, right_sign);
    }
    Some(roots)
}

/// A power of two that is larger than all roots in absolute value: twice the largest of |cₙ₋ₖ/cₙ|^(1/k)
/// (Fujiwara, "Über die obere Schranke des absoluten Betrages der Wurzeln einer algebraischen Gleichung",
/// Tohoku Mathematical Journal 10, 1916).
fn root_bound(p: &Polynomial<Interval>) -> Option<f64> {
    // At most the exponent of a number, and less than 1 below it.
    let exponent = |x: f64| (x.to_bits() >> 52) as i32 - 1023;
    if !p.significant().iter().all(|c| c.is_bounded()) {
        return None;
    }
    let mut coefficients = p.significant().iter().rev();
    let lead = coefficients.next()?.mignitude();
    if !lead.is_normal() {
        return None;
    }
    let mut largest = i32::MIN;
    for (k, c) in (1..).zip(coefficients) {
        if !c.is_zero() {
            // The ratio is below 2 to this power.
            let power = exponent(c.magnitude()) + 1 - exponent(lead);
            largest = largest.max((power + k - 1).div_euclid(k) + 1);
        }
    }
    (-1000..1000).contains(&largest).then(|| 2f64.powi(largest))
}

/// The root in an interval in which the polynomial is monotone and has opposite signs at the ends.
fn root_between(
    p: &Polynomial<Interval>,
    slope: &Polynomial<Interval>,
    numeric: &Numeric,
    ends: [f64; 2],
    left_sign: Ordering,
) -> Option<Interval> {
    let x = numeric.root_between(ends, left_sign)?;
    let value = p.at(&Interval::point(x));
    let [_, approximate_slope] = numeric.at(x);
    let mut radius = 2.0 * value.magnitude() / approximate_slope.abs();
    radius = radius.max(x.abs() * 2.0 * f64::EPSILON);
    for _ in 0..4 {
        let around = Interval {
            lo: x - radius,
            hi: x + radius,
        };
        let newton = Interval::point(x) - value / slope.at(&around);
        // Newton's image inside the interval proves a root, and the interval has no other.
        if around.lo < newton.lo && newton.hi < around.hi {
            return Some(newton);
        }
        radius *= 4.0;
    }
    None
}

/// The polynomial with the middles of the coefficients, in descending order of powers.
struct Numeric([f64; MAX_DEGREE + 1]);

impl Numeric {
    fn new(p: &Polynomial<Interval>) -> Self {
        let mut descending = [0.0; MAX_DEGREE + 1];
        for (i, c) in p.coefficients().iter().enumerate() {
            descending[MAX_DEGREE - i] = c.middle();
        }
        Self(descending)
    }

    /// Value and slope, by Horner's rule.
    #[inline(always)]
    fn at(&self, x: f64) -> [f64; 2] {
        let start = [self.0[0], 0.0];
        self.0[1..].iter().fold(start, |[value, slope], c| {
            [value * x + c, slope * x + value]
        })
    }

    /// A number near the root between two numbers: Newton's method, with bisection where it leaves the
    /// interval or converges slowly.
    fn root_between(&self, [mut lo, mut hi]: [f64; 2], left_sign: Ordering) -> Option<f64> {
        if lo >= hi {
            return None;
        }
        let mut x = 0.5 * lo + 0.5 * hi;
        let mut last_step = hi - lo;
        // Bisection of all f64 takes 2100 steps. This limit is rarely reached, and affects no promise.
        for _ in 0..200 {
            let [value, slope] = self.at(x);
            if (value > 0.0) == (left_sign == Ordering::Greater) {
                lo = x;
            } else {
                hi = x;
            }
            let newton = x - value / slope;
            let is_good = lo < newton && newton < hi && (newton - x).abs() < 0.5 * last_step;
            let next = if is_good { newton } else { 0.5 * lo + 0.5 * hi };
            last_step = (next - x).abs();
            x = next;
            // Newton's method squares the relative error: below 2⁻²⁷, it was the last step.
            if last_step <= x.abs() * NEWTON_DONE {
                break;
            }
        }
        Some(x)
    }
}

/// 2⁻³⁰, a little less than the square root of the precision of f64.
const NEWTON_DONE: f64 = 1.0 / (1 << 30) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_approximation_far_from_the_root_is_no_proof() {
        let cubic = |c0: f64| Polynomial::new([c0, 0.0, 0.0, 1.0].map(Interval::point));
        let p = cubic(-2.0);
        let bounds = |approximated: f64| {
            let numeric = Numeric::new(&cubic(-approximated));
            root_between(&p, &p.derivative(), &numeric, [0.0, 16.0], Ordering::Less)
        };
        // The cube root of 2, rounded.
        let root = 1.259_921_049_894_873_2;
        assert!(bounds(2.0).is_some_and(|interval| interval.contains(root)));
        assert!(bounds(2.1).is_some_and(|interval| interval.contains(root)));
        assert_eq!(bounds(100.0), None);
    }
}

//! Positive roots of integer polynomials of any degree.
//!
//! Isolation: Descartes' rule of signs on ever smaller halves of an interval (Collins, Akritas, "Polynomial Real Root
//! Isolation Using Descartes' Rule of Signs", SYMSAC 1976). The rule's count exceeds the number of roots in an open
//! interval by an even number, so 0 means no root and 1 exactly one simple root. For a polynomial without multiple
//! roots the count falls to 0 or 1 once an interval is small (Krandick, Mehlhorn, "New Bounds for the Descartes
//! Method", JSC 41(1), 2006). If halving doesn't end after [`MANY`] steps, the polynomial is divided by its greatest
//! common divisor with its derivative, which keeps each root once, and the isolation begins again. A root at an end
//! of an interval is a zero constant coefficient and is therefore exact.
//!
//! Refinement: a root that is alone in its interval has opposite signs on either side. The secant predicts one of 2^j
//! parts of the interval, and signs at its two ends, which are exact, confirm it; j doubles after a success and the
//! interval is halved after a failure (Abbott, "Quadratic Interval Refinement for Real Roots", ISSAC 2006).
//!
//! The kernels isolate by intervals and Sturm sequences.

use super::fraction::Fraction;
use super::polynomial::{
    greatest_common_divisor, moved_by_one, substituted, without_multiple_roots,
};
use super::surd::Surd;
use dashu_int::IBig;
use dashu_int::ops::BitTest as _;
use std::cmp::Ordering;

/// Halvings after which multiple roots are suspected.
const MANY: usize = 80;

/// A root x between n·2^−depth and (n + 1)·2^−depth, or at the former if it is exact. The represented number is
/// x·2^exponent.
#[derive(Clone, Debug)]
pub(super) struct IsolatedRoot {
    /// The coefficients of the polynomial in x, that of 1 first.
    coefficients: Vec<IBig>,
    exponent: i32,
    n: IBig,
    depth: usize,
    is_exact: bool,
    /// The polynomial's sign between the lower end and the root.
    sign_below: Ordering,
    /// The binary logarithm of the number of parts in the next step of the refinement.
    log_parts: usize,
}

impl IsolatedRoot {
    /// The positive roots in ascending order, multiple ones once. The polynomial isn't 0.
    pub fn positive_roots(polynomial: &[IBig]) -> Vec<Self> {
        let (coefficients, exponent) = over_unit_interval(polynomial);
        let isolated = isolate(&coefficients, exponent, Some(MANY));
        isolated.unwrap_or_else(|| {
            let distinct = without_multiple_roots(&coefficients);
            isolate(&distinct, exponent, None).expect("no limit")
        })
    }

    /// The product with 2^`exponent`.
    pub fn scaled(self, exponent: i32) -> Self {
        Self {
            exponent: self.exponent + exponent,
            ..self
        }
    }

    /// The lower and the upper end.
    fn ends(&self) -> [Fraction; 2] {
        let upper = &self.n + IBig::from(i32::from(!self.is_exact));
        [self.n.clone(), upper].map(|n| self.fraction(n))
    }

    fn fraction(&self, n: IBig) -> Fraction {
        let n = Fraction::new(n, IBig::ONE).expect("not 0");
        n.scaled(self.exponent - self.depth as i32)
    }

    /// 2^(degree·depth) times the value at n·2^−depth.
    fn value(&self, n: &IBig, depth: usize) -> IBig {
        let top = self.coefficients.len() - 1;
        let mut value = IBig::ZERO;
        for (power, k) in self.coefficients.iter().enumerate().rev() {
            value = value * n + (k << (depth * (top - power)));
        }
        value
    }

    /// Narrows the interval: halves it at least.
    pub fn refine(&mut self) {
        if self.is_exact {
            return;
        }
        let parts = self.log_parts;
        let lower = self.value(&self.n, self.depth);
        let upper = self.value(&(&self.n + IBig::ONE), self.depth);
        // The secant's part, if the values at the ends have opposite signs.
        let rise = &upper - &lower;
        let is_crossed = lower.cmp(&IBig::ZERO) == self.sign_below
            && upper.cmp(&IBig::ZERO) == self.sign_below.reverse();
        if parts > 1 && is_crossed {
            let count = IBig::ONE << parts;
            let part = ((-lower) << parts) / &rise;
            let part = part.clamp(IBig::ZERO, &count - IBig::ONE);
            if self.narrow_to(part, parts) {
                self.log_parts = 2 * parts;
                return;
            }
        }
        self.log_parts = (parts / 2).max(2);
        self.halve();
    }

    /// Replaces the interval by one of 2^`log_parts` parts, if the root is in it.
    fn narrow_to(&mut self, part: IBig, log_parts: usize) -> bool {
        let depth = self.depth + log_parts;
        let n = (&self.n << log_parts) + &part;
        let is_first = part == IBig::ZERO;
        let is_last = part + IBig::ONE == IBig::ONE << log_parts;
        let sign = |n: &IBig| self.value(n, depth).cmp(&IBig::ZERO);
        let left = if is_first { self.sign_below } else { sign(&n) };
        let next = &n + IBig::ONE;
        let right = if is_last {
            self.sign_below.reverse()
        } else {
            sign(&next)
        };
        if left == Ordering::Equal || right == Ordering::Equal {
            self.n = if left == Ordering::Equal { n } else { next };
            self.is_exact = true;
        } else if left == self.sign_below && right != self.sign_below {
            self.n = n;
        } else {
            return false;
        }
        self.depth = depth;
        true
    }

    fn halve(&mut self) {
        self.depth += 1;
        let middle = (&self.n << 1) + IBig::ONE;
        let sign = self.value(&middle, self.depth).cmp(&IBig::ZERO);
        self.n = if sign == self.sign_below || sign == Ordering::Equal {
            self.is_exact = sign == Ordering::Equal;
            middle
        } else {
            middle - IBig::ONE
        };
    }

    pub fn compare_with_surd(&mut self, surd: &Surd) -> Ordering {
        // The surd in units of x.
        let x = surd.clone().scaled(-self.exponent);
        let is_root = x.sign_of_coefficients(&self.coefficients) == Ordering::Equal;
        loop {
            let end = |n: IBig| {
                let end = Surd::rational(n, IBig::ONE << self.depth);
                end.expect("the denominator isn't 0").compare(&x)
            };
            let (lower, upper) = (end(self.n.clone()), end(&self.n + IBig::ONE));
            if self.is_exact {
                return lower;
            } else if lower != Ordering::Less {
                return Ordering::Greater;
            } else if upper != Ordering::Greater {
                return Ordering::Less;
            } else if is_root {
                // The only root in the interval.
                return Ordering::Equal;
            }
            self.refine();
        }
    }

    pub fn compare(&mut self, other: &mut Self) -> Ordering {
        let mut have_common_root = None;
        loop {
            let ([a, b], [c, d]) = (self.ends(), other.ends());
            if self.is_exact && other.is_exact {
                return a.cmp(&c);
            } else if b <= c {
                return Ordering::Less;
            } else if d <= a {
                return Ordering::Greater;
            }
            let have_common =
                *have_common_root.get_or_insert_with(|| self.is_root_of(&other.in_units_of(self)));
            // One interval inside the other: the outer one's only root.
            if have_common && c <= a && b <= d {
                return Ordering::Equal;
            }
            self.refine();
            if !have_common {
                other.refine();
            }
        }
    }

    /// The coefficients of the polynomial in the units of another root.
    fn in_units_of(&self, other: &Self) -> Vec<IBig> {
        substituted(&self.coefficients, other.exponent - self.exponent)
    }

    /// Whether another polynomial is 0 at this root: whether their greatest common divisor changes its sign there.
    fn is_root_of(&mut self, other: &[IBig]) -> bool {
        let divisor = greatest_common_divisor(&self.coefficients, other);
        if divisor.len() < 2 {
            return false;
        }
        loop {
            let common = Self {
                coefficients: divisor.clone(),
                ..self.clone()
            };
            let sign = |n: &IBig| common.value(n, common.depth).cmp(&IBig::ZERO);
            let (lower, upper) = (sign(&self.n), sign(&(&self.n + IBig::ONE)));
            if self.is_exact {
                return lower == Ordering::Equal;
            } else if lower != Ordering::Equal && upper != Ordering::Equal {
                return lower != upper;
            }
            // An end may be another root.
            self.refine();
        }
    }

    /// The root rounded by `round`, to numbers of which `next` is the next larger one.
    pub fn rounded(&mut self, round: impl Fn(&Fraction) -> f64, next: impl Fn(f64) -> f64) -> f64 {
        loop {
            let ends = self.ends();
            let [low, high] = ends.each_ref().map(&round);
            if low == high {
                return low;
            } else if next(low) == high {
                // Only the number half way between them is left to compare with.
                let [a, b] = [low, high].map(|x| Fraction::from_f64(x).expect("finite"));
                let half_way = a.plus(&b).scaled(-1);
                let [n, d] = half_way.parts();
                let surd = Surd::rational(n.clone(), d.clone()).expect("not 0");
                return match self.compare_with_surd(&surd) {
                    Ordering::Less => low,
                    Ordering::Equal => round(&half_way),
                    Ordering::Greater => high,
                };
            }
            self.refine();
        }
    }
}

/// The polynomial in x = t·2^−exponent, such that all positive roots are below x = 1.
fn over_unit_interval(polynomial: &[IBig]) -> (Vec<IBig>, i32) {
    let bits = |k: &IBig| k.bit_len() as i64;
    let degree = polynomial.iter().rposition(|k| *k != IBig::ZERO);
    let polynomial = &polynomial[..=degree.expect("the polynomial isn't 0")];
    let [lower @ .., top] = polynomial else {
        return (Vec::new(), 0);
    };
    // Fujiwara: every root is at most twice the largest of |k[i]/k[top]|^(1/(top − i)).
    let quotients = lower.iter().enumerate().filter(|(_, k)| **k != IBig::ZERO);
    let exponents = quotients.map(|(power, k)| {
        let below_top = (lower.len() - power) as i64;
        (bits(k) - bits(top) + 1).div_euclid(below_top) + 1
    });
    let exponent = 2 + exponents.max().unwrap_or(0) as i32;
    (substituted(polynomial, exponent), exponent)
}

/// An interval's polynomial, as a function of its own coordinate from 0 to 1.
struct Part {
    coefficients: Vec<IBig>,
    n: IBig,
    depth: usize,
}

/// The roots between 0 and 1; `None` if that takes more halvings than `limit`.
fn isolate(polynomial: &[IBig], exponent: i32, limit: Option<usize>) -> Option<Vec<IsolatedRoot>> {
    let mut roots = Vec::new();
    let mut parts = vec![Part {
        coefficients: polynomial.to_vec(),
        n: IBig::ZERO,
        depth: 0,
    }];
    while let Some(mut part) = parts.pop() {
        let zeros = part.coefficients.iter().take_while(|k| **k == IBig::ZERO);
        let zeros = zeros.count();
        part.coefficients.drain(..zeros);
        let [lowest, ..] = &part.coefficients[..] else {
            return Some(roots);
        };
        let root = |is_exact: bool| IsolatedRoot {
            coefficients: polynomial.to_vec(),
            exponent,
            n: part.n.clone(),
            depth: part.depth,
            is_exact,
            sign_below: lowest.cmp(&IBig::ZERO),
            log_parts: 2,
        };
        // 0 itself isn't positive.
        if zeros > 0 && part.n != IBig::ZERO {
            roots.push(root(true));
        }
        match variations(&part.coefficients) {
            0 => {}
            1 => roots.push(root(false)),
            _ if limit.is_some_and(|limit| part.depth >= limit) => return None,
            _ => parts.extend(part.halves()),
        }
    }
    Some(roots)
}

impl Part {
    /// The upper half, then the lower one.
    fn halves(self) -> [Self; 2] {
        let top = self.coefficients.len() - 1;
        let terms = self.coefficients.into_iter().enumerate();
        let lower: Vec<IBig> = terms.map(|(power, k)| k << (top - power)).collect();
        let half = |coefficients, is_upper: i32| Self {
            coefficients,
            n: (&self.n << 1) + IBig::from(is_upper),
            depth: self.depth + 1,
        };
        [half(moved_by_one(lower.clone()), 1), half(lower, 0)]
    }
}

/// Descartes' count of the roots between 0 and 1.
fn variations(polynomial: &[IBig]) -> usize {
    // Positive roots of (1 + y)^degree·p(1/(1 + y)).
    let reversed = polynomial.iter().rev().cloned().collect();
    let signs = moved_by_one(reversed);
    let signs: Vec<Ordering> = signs.iter().map(|k| k.cmp(&IBig::ZERO)).collect();
    let signs: Vec<&Ordering> = signs.iter().filter(|s| **s != Ordering::Equal).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

//! Exact roots of polynomials: comparison, signs of other polynomials, rounding.

use super::dyadic::{Dyadic, F32, F64, Format};
use super::interval::Interval;
use super::isolation::isolate;
use super::polynomial::Polynomial;
use super::remainders::{IntegerPolynomial, RemainderSequence};
use super::ring::Ring;
use dashu_int::IBig;
use dashu_int::ops::Abs;
use std::cmp::Ordering;
use std::sync::Arc;

/// A real number, given as the only root of a squarefree polynomial in an open interval.
#[derive(Clone, Debug)]
pub struct Algebraic {
    polynomial: Arc<IntegerPolynomial>,
    lo: Dyadic,
    hi: Dyadic,
    /// The sign of the polynomial at `lo`. At `hi` it is the opposite.
    side: Ordering,
    /// The next refinement divides the interval into this power of two of parts.
    step: u32,
}

/// A root of a polynomial.
#[derive(Clone, Debug)]
pub struct Root {
    pub value: Algebraic,
    pub multiplicity: usize,
}

impl Root {
    /// All real roots in ascending order. The polynomial 0 has none.
    pub fn all(polynomial: &Polynomial<Dyadic>) -> Vec<Self> {
        let given = IntegerPolynomial::new(polynomial);
        let squarefree = Arc::new(given.squarefree());
        let intervals = isolate(&squarefree).into_iter();
        let values = intervals.map(|[lo, hi]| Algebraic::new(Arc::clone(&squarefree), lo, hi));
        let is_simple = squarefree.degree() == given.degree();
        let roots = values.map(|value| Self {
            multiplicity: if is_simple {
                1
            } else {
                value.multiplicity_in(&given)
            },
            value,
        });
        roots.collect()
    }

    pub fn has_even_multiplicity(&self) -> bool {
        self.multiplicity.is_multiple_of(2)
    }
}

impl Algebraic {
    fn new(polynomial: Arc<IntegerPolynomial>, lo: Dyadic, hi: Dyadic) -> Self {
        Self {
            side: polynomial.sign_at(&lo),
            polynomial,
            lo,
            hi,
            step: 2,
        }
    }

    /// `numerator/denominator`, or `None` if the denominator is 0.
    pub fn ratio(numerator: &Dyadic, denominator: &Dyadic) -> Option<Self> {
        let line = Polynomial::new([-numerator.clone(), denominator.clone()]);
        Root::all(&line).pop().map(|root| root.value)
    }

    /// The only root of a squarefree polynomial between two numbers, or `None` if its signs at them aren't
    /// opposite.
    pub fn between(polynomial: &Polynomial<Dyadic>, bounds: Interval) -> Option<Self> {
        let polynomial = Arc::new(IntegerPolynomial::new(polynomial));
        let root = Self::new(polynomial, bounds.lo.into(), bounds.hi.into());
        let right = root.polynomial.sign_at(&root.hi);
        (root.side != Ordering::Equal && right == root.side.reverse()).then_some(root)
    }

    /// The number of the first derivative of `p` that isn't 0 here.
    fn multiplicity_in(&self, p: &IntegerPolynomial) -> usize {
        let mut derivative = p.derivative();
        let mut multiplicity = 1;
        while multiplicity < p.degree() && self.sign(&derivative) == Ordering::Equal {
            derivative = derivative.derivative();
            multiplicity += 1;
        }
        multiplicity
    }

    /// The sign of a polynomial at this number.
    pub fn sign_of(&self, polynomial: &Polynomial<Dyadic>) -> Ordering {
        self.sign(&IntegerPolynomial::new(polynomial))
    }

    fn sign(&self, q: &IntegerPolynomial) -> Ordering {
        match q.coefficients() {
            [] => return Ordering::Equal,
            [constant] => return constant.cmp(&IBig::ZERO),
            _ => {}
        }
        // The only root in the interval contributes the sign of q.
        let chain = RemainderSequence::tarski(&self.polynomial, q);
        chain.changes_at(&self.lo).cmp(&chain.changes_at(&self.hi))
    }

    /// The order of this number and a dyadic one.
    pub fn compare_with(&self, x: &Dyadic) -> Ordering {
        if *x <= self.lo {
            Ordering::Greater
        } else if *x >= self.hi {
            Ordering::Less
        } else {
            self.order_by_sign(self.polynomial.sign_at(x))
        }
    }

    /// The order of this number and a point in the interval at which the polynomial has the given sign.
    fn order_by_sign(&self, sign: Ordering) -> Ordering {
        if sign == Ordering::Equal {
            Ordering::Equal
        } else if sign == self.side {
            Ordering::Greater
        } else {
            Ordering::Less
        }
    }

    /// The order of two numbers, which may be roots of different polynomials.
    pub fn compare(&self, other: &Self) -> Ordering {
        if self.hi <= other.lo {
            return Ordering::Less;
        } else if self.lo >= other.hi {
            return Ordering::Greater;
        }
        // Where is this number relative to the ends of the other's interval?
        if self.compare_with(&other.lo) != Ordering::Greater {
            return Ordering::Less;
        } else if self.compare_with(&other.hi) != Ordering::Less {
            return Ordering::Greater;
        }
        // Inside, where the other's polynomial changes its sign only at the other number.
        other.order_by_sign(self.sign(&other.polynomial)).reverse()
    }

    /// Narrows the interval.
    ///
    /// Source: Abbott, "Quadratic interval refinement for real roots", ACM Communications in Computer Algebra
    /// 48(1), 2014. The interval is divided into 2^step parts. If the root is in a part next to the root of the
    /// chord, the number of parts is squared for the next time; otherwise it becomes its square root.
    fn refine(&mut self) {
        let part = self.hi.minus(&self.lo).scaled(-(self.step as i32));
        let values = [&self.lo, &self.hi].map(|x| self.polynomial.at(x));
        let count = Dyadic::new(chord_root(values, self.step), 0);
        let guess = self.lo.plus(&part.times(&count));
        let side = self.cut(&guess, &part);
        let is_in_part = match side {
            Ordering::Less => self.cut(&guess.minus(&part), &part) == Ordering::Greater,
            Ordering::Equal => true,
            Ordering::Greater => self.cut(&guess.plus(&part), &part) == Ordering::Less,
        };
        self.step = if is_in_part {
            (2 * self.step).min(MAX_STEP)
        } else {
            (self.step / 2).max(1)
        };
    }

    /// Makes `x` an end of the interval, and returns the order of the number and `x`. If they are equal, the
    /// ends become its neighbours, at a distance that is tiny relative to `part`.
    fn cut(&mut self, x: &Dyadic, part: &Dyadic) -> Ordering {
        let order = self.compare_with(x);
        match order {
            Ordering::Less if *x < self.hi => self.hi = x.clone(),
            Ordering::Greater if *x > self.lo => self.lo = x.clone(),
            Ordering::Equal => {
                let distance = part.scaled(-(MAX_STEP as i32));
                self.lo = x.minus(&distance);
                self.hi = x.plus(&distance);
            }
            _ => {}
        }
        order
    }

    /// An interval of f64 around the number, at most two f64 wide.
    pub fn enclosure(&mut self) -> Interval {
        let x = self.rounded(F64);
        if x.is_infinite() {
            return Interval::WHOLE;
        }
        match self.compare_with(&x.into()) {
            Ordering::Less => Interval {
                lo: x.next_down(),
                hi: x,
            },
            Ordering::Equal => Interval::point(x),
            Ordering::Greater => Interval {
                lo: x,
                hi: x.next_up(),
            },
        }
    }

    /// The nearest f64; of two equally near ones, the even one.
    pub fn nearest_f64(&mut self) -> f64 {
        self.rounded(F64)
    }

    /// The nearest f32; of two equally near ones, the even one.
    pub fn nearest_f32(&mut self) -> f32 {
        self.rounded(F32) as f32
    }

    /// Refines until both ends are rounded to the same number, or to neighbours: then their middle decides.
    ///
    /// Source: Ziv, "Fast evaluation of elementary mathematical functions with correctly rounded last bit",
    /// ACM Transactions on Mathematical Software 17(3), 1991, with an exact test for middles.
    fn rounded(&mut self, format: Format) -> f64 {
        loop {
            let [lo, hi] = [&self.lo, &self.hi].map(|x| x.rounded(format));
            if lo == hi {
                // Adding 0 turns −0 into 0.
                return lo + 0.0;
            } else if format.are_neighbours(lo, hi) {
                let nearest = match self.compare_with(&format.middle(lo, hi)) {
                    Ordering::Less => lo,
                    Ordering::Greater => hi,
                    Ordering::Equal if (format.is_even)(lo) => lo,
                    Ordering::Equal => hi,
                };
                return nearest + 0.0;
            }
            self.refine();
        }
    }
}

/// More than the digits of f64, so that one step often suffices.
const MAX_STEP: u32 = 64;

/// The root of the chord between two values of opposite sign, in units of 2^−step of their distance. Rounded
/// to an inner multiple of the unit.
fn chord_root(values: [Dyadic; 2], step: u32) -> IBig {
    let exponent = values[0].exponent.min(values[1].exponent);
    let [left, right] = values.map(|x| x.in_units_of(exponent).abs());
    let parts = IBig::ONE << step as usize;
    let total = &left + right;
    // Rounded to nearest: twice the quotient, plus 1, halved.
    let nearest: IBig = (((left << (step as usize + 1)) / total) + 1) >> 1usize;
    nearest.clamp(IBig::ONE, parts - 1)
}

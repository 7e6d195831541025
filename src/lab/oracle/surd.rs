//! Numbers of the form (a ± √d)/c with integers a, c and d: roots of polynomials of degree 2.
//!
//! Signs and comparisons compare squares of integers. Values are enclosed by integer square roots of ever more digits,
//! until both ends round to the same number (Ziv, "Fast Evaluation of Elementary Mathematical Functions with Correctly
//! Rounded Last Bit", TOMS 17(3), 1991). If d isn't a square, the number is irrational and therefore never half way
//! between two floating-point numbers, so the loop ends.

use super::fraction::Fraction;
use super::quadratic::Quadratic;
use dashu_int::ops::SquareRoot as _;
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;

/// (a + s·√d)/c with c > 0, d ≥ 0 and s = −1, 0 or 1; d is 0 if s is.
#[derive(Clone, Debug)]
pub(super) struct Surd {
    a: IBig,
    sign: IBig,
    d: IBig,
    c: IBig,
}

impl Surd {
    /// A quotient; `None` if the denominator is 0.
    pub fn rational(numerator: IBig, denominator: IBig) -> Option<Self> {
        let (a, c) = match denominator.cmp(&IBig::ZERO) {
            Ordering::Equal => return None,
            Ordering::Greater => (numerator, denominator),
            Ordering::Less => (-numerator, -denominator),
        };
        Some(Self {
            a,
            sign: IBig::ZERO,
            d: IBig::ZERO,
            c,
        })
    }

    /// The real roots in ascending order, a double root once. The polynomial 0 has none.
    pub fn roots(polynomial: &Quadratic) -> Vec<Self> {
        let [k0, k1, k2] = &polynomial.0;
        if *k2 == IBig::ZERO {
            return Self::rational(-k0, k1.clone()).into_iter().collect();
        }
        let d = k1 * k1 - ((k0 * k2) << 2);
        // With a positive denominator the root with −√d is the smaller one.
        let (a, c) = if *k2 > IBig::ZERO {
            (-k1, k2 << 1)
        } else {
            (k1.clone(), -(k2 << 1))
        };
        let root = |sign: i32| Self {
            a: a.clone(),
            sign: sign.into(),
            d: d.clone(),
            c: c.clone(),
        };
        match d.cmp(&IBig::ZERO) {
            Ordering::Less => Vec::new(),
            Ordering::Equal => vec![root(0)],
            Ordering::Greater => vec![root(-1), root(1)],
        }
    }

    /// The product with 2^`exponent`.
    pub fn scaled(self, exponent: i32) -> Self {
        let shift = exponent.unsigned_abs() as usize;
        if exponent >= 0 {
            Self {
                a: self.a << shift,
                d: self.d << (2 * shift),
                ..self
            }
        } else {
            Self {
                c: self.c << shift,
                ..self
            }
        }
    }

    pub fn sign(&self) -> Ordering {
        sign_of_sum(&self.a, &self.sign, &self.d)
    }

    /// The sign of a polynomial at this number.
    pub fn sign_of(&self, polynomial: &Quadratic) -> Ordering {
        let [k0, k1, k2] = &polynomial.0;
        // c² times the value is whole + s·root·√d.
        let whole =
            k0 * &self.c * &self.c + k1 * &self.a * &self.c + k2 * (&self.a * &self.a + &self.d);
        let root = (k1 * &self.c + ((k2 * &self.a) << 1)) * &self.sign;
        sign_of_sum(&whole, &root, &self.d)
    }

    /// The sign of a polynomial of any degree at this number: Horner's rule over the numbers u + v·√d.
    pub fn sign_of_coefficients(&self, coefficients: &[IBig]) -> Ordering {
        let (mut u, mut v) = (IBig::ZERO, IBig::ZERO);
        let mut power = IBig::ONE;
        for k in coefficients.iter().rev() {
            // The value so far, times a power of c.
            let next = &u * &self.a + &v * &self.sign * &self.d + k * &power;
            v = &v * &self.a + &u * &self.sign;
            u = next;
            power *= &self.c;
        }
        sign_of_sum(&u, &v, &self.d)
    }

    pub fn compare(&self, other: &Self) -> Ordering {
        // The difference times both denominators: a + b√d + e√f.
        let a = &self.a * &other.c - &other.a * &self.c;
        let b = &self.sign * &other.c;
        let e = -(&other.sign * &self.c);
        let first = sign_of_sum(&a, &b, &self.d);
        let second = sign_of_sum(&IBig::ZERO, &e, &other.d);
        if second == Ordering::Equal || first == second {
            return first;
        } else if first == Ordering::Equal {
            return second;
        }
        // Opposite signs: the larger square decides.
        let whole = &a * &a + &b * &b * &self.d - &e * &e * &other.d;
        let is_first_larger = sign_of_sum(&whole, &((&a * &b) << 1), &self.d);
        match is_first_larger {
            Ordering::Greater => first,
            Ordering::Equal => Ordering::Equal,
            Ordering::Less => second,
        }
    }

    /// The number rounded by `round`, which is monotonic.
    pub fn rounded(&self, round: impl Fn(&Fraction) -> f64) -> f64 {
        let mut digits = 64;
        loop {
            // √d is between s and s + 1, in units of 2^−digits.
            let scaled = UBig::try_from(&self.d << (2 * digits)).expect("d isn't negative");
            let s = scaled.sqrt();
            let is_exact = &s * &s == scaled;
            let s = IBig::from(s);
            let ends = [s.clone(), s + IBig::from(i32::from(!is_exact))];
            let [first, second] = ends.map(|root| {
                let numerator = &self.sign * root + (&self.a << digits);
                let end = Fraction::new(numerator, &self.c << digits);
                round(&end.expect("c is positive"))
            });
            if first == second {
                return first;
            }
            digits *= 2;
        }
    }
}

/// The sign of a + b√d.
fn sign_of_sum(a: &IBig, b: &IBig, d: &IBig) -> Ordering {
    let zero = IBig::ZERO;
    let whole = a.cmp(&zero);
    let root = if *d == zero {
        Ordering::Equal
    } else {
        b.cmp(&zero)
    };
    if root == Ordering::Equal || whole == root {
        return whole;
    } else if whole == Ordering::Equal {
        return root;
    }
    match (a * a).cmp(&(b * b * d)) {
        Ordering::Greater => whole,
        Ordering::Equal => Ordering::Equal,
        Ordering::Less => root,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roots(coefficients: [i32; 3]) -> Vec<Surd> {
        Surd::roots(&Quadratic(coefficients.map(IBig::from)))
    }

    #[test]
    fn comparisons_agree_with_f64_where_numbers_differ_and_find_equal_ones() {
        let numbers = || -6..=6;
        let mut all = Vec::new();
        for (b, c) in numbers().flat_map(|b| numbers().map(move |c| (b, c))) {
            all.extend(roots([c, b, 1]));
            all.extend(roots([c, b, -2]));
            all.extend(roots([2 * c, 2 * b, 2]));
        }
        let value = |surd: &Surd| surd.rounded(Fraction::to_f64);
        for (p, q) in all.iter().flat_map(|p| all.iter().map(move |q| (p, q))) {
            let (x, y) = (value(p), value(q));
            let expected = if (x - y).abs() < 1e-12 {
                Ordering::Equal
            } else {
                x.total_cmp(&y)
            };
            assert_eq!(p.compare(q), expected, "{p:?} {q:?}");
        }
    }

    #[test]
    fn signs_at_a_root_are_exact() {
        let [_, root] = &roots([-2, 0, 1])[..] else {
            panic!("two roots");
        };
        let sign = |k: [i32; 3]| root.sign_of(&Quadratic(k.map(IBig::from)));
        assert_eq!(sign([-4, 0, 2]), Ordering::Equal);
        assert_eq!(sign([-141, 100, 0]), Ordering::Greater);
        assert_eq!(sign([-142, 100, 0]), Ordering::Less);
        let quartic = [-4, 0, 0, 0, 1].map(IBig::from);
        assert_eq!(root.sign_of_coefficients(&quartic), Ordering::Equal);
        let cubic = [-3, 0, 0, 1].map(IBig::from);
        assert_eq!(root.sign_of_coefficients(&cubic), Ordering::Less);
    }
}

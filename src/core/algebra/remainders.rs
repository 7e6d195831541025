//! Integer polynomials and their signed remainder sequences.
//!
//! Source: Basu, Pollack, Roy, "Algorithms in Real Algebraic Geometry", Springer 2006, sections 2.2 and 8.1.
//! The sequence of P and P′·Q has, between two points that aren't roots of P, as many changes of sign at the
//! first more than at the second as the sum of the signs of Q at the roots of P in between (Tarski's query).
//! With Q = 1 it counts the roots (Sturm).
//! Differs from it: remainders are divided by their content, a positive integer, which keeps them short.

use super::dyadic::Dyadic;
use super::polynomial::Polynomial;
use super::ring::Ring;
use dashu_int::IBig;
use dashu_int::ops::{Abs, Gcd};
use std::cmp::Ordering;

/// A polynomial with integer coefficients, in ascending order of powers. The leading one isn't 0; the
/// polynomial 0 has none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct IntegerPolynomial(Vec<IBig>);

impl IntegerPolynomial {
    /// The polynomial without its leading zeros, divided by its content.
    fn primitive(mut coefficients: Vec<IBig>) -> Self {
        while coefficients.last().is_some_and(|c| *c == IBig::ZERO) {
            coefficients.pop();
        }
        let content = coefficients.iter().fold(IBig::ZERO, |content, c| {
            if content == IBig::ONE || *c == IBig::ZERO {
                content
            } else if content == IBig::ZERO {
                c.abs()
            } else {
                (&content).gcd(c).into()
            }
        });
        if content > IBig::ONE {
            for c in &mut coefficients {
                *c = &*c / &content;
            }
        }
        Self(coefficients)
    }

    /// A positive multiple of the given polynomial.
    pub fn new(polynomial: &Polynomial<Dyadic>) -> Self {
        let coefficients = polynomial.coefficients();
        let nonzero = coefficients.iter().filter(|c| !c.is_zero());
        let exponent = nonzero.map(|c| c.exponent).min().unwrap_or(0);
        Self::primitive(
            coefficients
                .iter()
                .map(|c| c.in_units_of(exponent))
                .collect(),
        )
    }

    pub fn coefficients(&self) -> &[IBig] {
        &self.0
    }

    /// The degree; 0 for the polynomial 0, too.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// A positive multiple of the derivative.
    pub fn derivative(&self) -> Self {
        let terms = self.0.iter().enumerate().skip(1);
        Self::primitive(terms.map(|(i, c)| c * IBig::from(i)).collect())
    }

    pub fn at(&self, x: &Dyadic) -> Dyadic {
        let mut value = IBig::ZERO;
        if x.exponent >= 0 {
            let x = &x.mantissa << x.exponent as usize;
            for c in self.0.iter().rev() {
                value = value * &x + c;
            }
            return Dyadic::new(value, 0);
        }
        // Horner's rule for the value times 2^(shift·degree).
        let shift = x.exponent.unsigned_abs() as usize;
        for (step, c) in self.0.iter().rev().enumerate() {
            value = value * &x.mantissa + (c << (shift * step));
        }
        Dyadic::new(value, x.exponent * self.degree() as i32)
    }

    pub fn sign_at(&self, x: &Dyadic) -> Ordering {
        self.at(x).sign()
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = vec![IBig::ZERO; self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Self::primitive(product)
    }

    /// A positive multiple of the remainder of the division by `divisor`, which isn't 0.
    fn remainder(&self, divisor: &Self) -> Self {
        let Some((lead, rest)) = divisor.0.split_last() else {
            return self.clone();
        };
        let factor = lead.abs();
        let mut remainder = self.0.clone();
        while remainder.len() > rest.len() {
            let top = remainder.pop().unwrap_or_default();
            if top == IBig::ZERO {
                continue;
            }
            // The multiplier |lead| is positive, so signs are kept.
            let top = if *lead < IBig::ZERO { -top } else { top };
            let offset = remainder.len() - rest.len();
            for (i, c) in remainder.iter_mut().enumerate() {
                *c *= &factor;
                if i >= offset {
                    *c -= &top * &rest[i - offset];
                }
            }
        }
        Self::primitive(remainder)
    }

    /// A multiple of the quotient by a divisor that leaves no remainder.
    fn quotient(&self, divisor: &Self) -> Self {
        let Some((lead, rest)) = divisor.0.split_last() else {
            return self.clone();
        };
        // Both are primitive, so by Gauss's lemma the quotient has integer coefficients.
        let mut dividend = self.0.clone();
        let mut quotient = vec![IBig::ZERO; self.0.len() - rest.len()];
        for (offset, q) in quotient.iter_mut().enumerate().rev() {
            *q = dividend.pop().unwrap_or_default() / lead;
            for (i, c) in rest.iter().enumerate() {
                dividend[offset + i] -= &*q * c;
            }
        }
        Self::primitive(quotient)
    }

    /// The polynomial with the same roots, each of multiplicity 1.
    pub fn squarefree(&self) -> Self {
        let chain = RemainderSequence::new(self.clone(), self.derivative());
        let divisor = chain.last();
        if divisor.degree() == 0 {
            self.clone()
        } else {
            self.quotient(divisor)
        }
    }
}

/// The signed remainder sequence of two polynomials: each member is a positive multiple of minus the remainder
/// of the two before it. The last is their greatest common divisor.
pub(super) struct RemainderSequence(Vec<IntegerPolynomial>);

impl RemainderSequence {
    fn new(first: IntegerPolynomial, second: IntegerPolynomial) -> Self {
        let mut members = vec![first];
        let mut next = second;
        while !next.is_zero() {
            let previous = &members[members.len() - 1];
            let mut remainder = previous.remainder(&next);
            for c in &mut remainder.0 {
                *c = -std::mem::take(c);
            }
            members.push(std::mem::replace(&mut next, remainder));
        }
        Self(members)
    }

    /// The sequence that counts the roots of a squarefree polynomial.
    pub fn sturm(p: &IntegerPolynomial) -> Self {
        Self::new(p.clone(), p.derivative())
    }

    /// The sequence that sums the signs of `q` over the roots of `p`.
    pub fn tarski(p: &IntegerPolynomial, q: &IntegerPolynomial) -> Self {
        Self::new(p.clone(), p.derivative().times(q).remainder(p))
    }

    fn last(&self) -> &IntegerPolynomial {
        &self.0[self.0.len() - 1]
    }

    /// The changes of sign along the sequence at a point; zeros don't count.
    pub fn changes_at(&self, x: &Dyadic) -> usize {
        let mut changes = 0;
        let mut before = Ordering::Equal;
        for sign in self.0.iter().map(|p| p.sign_at(x)) {
            if sign == Ordering::Equal {
                continue;
            }
            changes += usize::from(before == sign.reverse());
            before = sign;
        }
        changes
    }
}

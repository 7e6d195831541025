//! Intervals that contain one root of an integer polynomial each.
//!
//! Degrees 1 and 2 have closed formulas; for others, the real line is bisected and Sturm's sequence counts
//! the roots in each part (Basu, Pollack, Roy, "Algorithms in Real Algebraic Geometry", Springer 2006,
//! section 10.2).

use super::dyadic::Dyadic;
use super::remainders::{IntegerPolynomial, RemainderSequence};
use super::ring::Ring;
use dashu_int::ops::{BitTest, DivEuclid, SquareRoot, UnsignedAbs};
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;

/// Open intervals, in ascending order. Each contains one root of a squarefree polynomial; no end is a root.
pub(super) fn isolate(p: &IntegerPolynomial) -> Vec<[Dyadic; 2]> {
    match p.coefficients() {
        [] | [_] => Vec::new(),
        [c0, c1] => vec![of_line(c0, c1)],
        [c0, c1, c2] => of_quadratic(c0, c1, c2),
        _ => bisect(p),
    }
}

/// Bits to which the closed formulas compute roots: a few more than f64 has.
const DIGITS: usize = 64;

/// The root −c₀/c₁.
fn of_line(c0: &IBig, c1: &IBig) -> [Dyadic; 2] {
    let shift = (DIGITS + c1.bit_len()).saturating_sub(c0.bit_len());
    around_quotients([-c0, -c0], c1, shift, 0)
}

/// The roots (−c₁ ± √(c₁² − 4c₀c₂))/(2c₂).
fn of_quadratic(c0: &IBig, c1: &IBig, c2: &IBig) -> Vec<[Dyadic; 2]> {
    let discriminant: IBig = c1 * c1 - c0 * c2 * 4;
    if discriminant <= IBig::ZERO {
        return Vec::new();
    }
    // Numerators in units of 2^−DIGITS: the root of the discriminant is at least 1 and computed down to a unit.
    let scaled: UBig = (discriminant << (2 * DIGITS)).unsigned_abs();
    let root = IBig::from(scaled.sqrt());
    let centre = -c1 << DIGITS;
    let denominator: IBig = c2 * 2;
    // The quotients are at least 2⁶⁵ units apart, and the intervals a few units wide.
    let shift = denominator.bit_len() + 2;
    let around = |least: IBig| {
        let most = &least + 1;
        around_quotients([least, most], &denominator, shift, -(DIGITS as i32))
    };
    let roots = [around(&centre - &root - 1), around(centre + root)];
    if *c2 > IBig::ZERO {
        roots.into()
    } else {
        roots.into_iter().rev().collect()
    }
}

/// An open interval around `n/denominator·2^exponent` for all n between two integers. Its ends are multiples
/// of `2^(exponent − shift)`.
fn around_quotients(n: [IBig; 2], denominator: &IBig, shift: usize, exponent: i32) -> [Dyadic; 2] {
    let size = IBig::from(denominator.clone().unsigned_abs());
    let [least, most] = n;
    let [least, most] = if *denominator < IBig::ZERO {
        [-most, -least]
    } else {
        [least, most]
    };
    let floor = |n: IBig| -> IBig { (n << shift).div_euclid(&size) };
    // Floors lie up to one unit below the quotients.
    let ends = [floor(least) - 1, floor(most) + 2];
    ends.map(|end| Dyadic::new(end, exponent - shift as i32))
}

/// Bisects until every interval has one root or none.
fn bisect(p: &IntegerPolynomial) -> Vec<[Dyadic; 2]> {
    let chain = RemainderSequence::sturm(p);
    let bound = Dyadic::power(root_bound(p));
    let end = |x: Dyadic| (chain.changes_at(&x), x);
    let mut isolated = Vec::new();
    // The part with the smallest numbers is on top.
    let mut parts = vec![(end(-bound.clone()), end(bound))];
    while let Some((lo, hi)) = parts.pop() {
        match lo.0 - hi.0 {
            0 => {}
            1 => isolated.push([lo.1, hi.1]),
            _ => {
                let middle = end(inner_point(p, &lo.1, &hi.1));
                parts.push((middle.clone(), hi));
                parts.push((lo, middle));
            }
        }
    }
    isolated
}

/// A point near the middle of an interval that isn't a root of `p`.
fn inner_point(p: &IntegerPolynomial, lo: &Dyadic, hi: &Dyadic) -> Dyadic {
    let sixteenth = hi.minus(lo).scaled(-4);
    // A quartic has four roots, so that one of five points isn't a root.
    let points = [8, 7, 9, 6, 10].map(|i| lo.plus(&sixteenth.times(&Dyadic::from(i))));
    let [middle, ..] = points.clone();
    let mut points = points.into_iter();
    points
        .find(|x| p.sign_at(x) != Ordering::Equal)
        .unwrap_or(middle)
}

/// An exponent of a power of two that is larger than all roots: twice the largest of |cₙ₋ₖ/cₙ|^(1/k)
/// (Fujiwara, "Über die obere Schranke des absoluten Betrages der Wurzeln einer algebraischen Gleichung",
/// Tohoku Mathematical Journal 10, 1916).
fn root_bound(p: &IntegerPolynomial) -> i32 {
    let mut coefficients = p.coefficients().iter().rev().map(|c| c.bit_len() as i32);
    let lead = coefficients.next().unwrap_or(0);
    let terms = (1..).zip(coefficients).filter(|(_, bits)| *bits > 0);
    let exponents = terms.map(|(k, bits)| (bits - lead + 1).div_euclid(k) + 1);
    2 + exponents.max().unwrap_or(0)
}

//! Polynomials with integer coefficients, that of 1 first.

use dashu_int::IBig;
use dashu_int::ops::Gcd as _;

/// The polynomial in x, where t = x·2^exponent, times a power of two.
pub(super) fn substituted(polynomial: &[IBig], exponent: i32) -> Vec<IBig> {
    let size = exponent.unsigned_abs() as usize;
    let top = polynomial.len() - 1;
    let terms = polynomial.iter().enumerate();
    let terms =
        terms.map(|(power, k)| k << (size * if exponent >= 0 { power } else { top - power }));
    without_powers_of_two(terms.collect())
}

fn without_powers_of_two(polynomial: Vec<IBig>) -> Vec<IBig> {
    let zeros = polynomial.iter().filter_map(IBig::trailing_zeros).min();
    let zeros = zeros.unwrap_or(0);
    polynomial.into_iter().map(|k| k >> zeros).collect()
}

/// The polynomial of x + 1.
pub(super) fn moved_by_one(mut polynomial: Vec<IBig>) -> Vec<IBig> {
    for start in 0..polynomial.len() {
        for k in (start..polynomial.len() - 1).rev() {
            let above = polynomial[k + 1].clone();
            polynomial[k] += above;
        }
    }
    polynomial
}

/// The polynomial with the same roots, each once.
pub(super) fn without_multiple_roots(polynomial: &[IBig]) -> Vec<IBig> {
    let slopes = polynomial.iter().enumerate().skip(1);
    let derivative: Vec<IBig> = slopes.map(|(power, k)| k * IBig::from(power)).collect();
    let divisor = greatest_common_divisor(polynomial, &derivative);
    primitive(divided(polynomial.to_vec(), &divisor).0)
}

/// The greatest common divisor with rational coefficients, up to a factor.
pub(super) fn greatest_common_divisor(a: &[IBig], b: &[IBig]) -> Vec<IBig> {
    let (mut a, mut b) = (primitive(a.to_vec()), primitive(b.to_vec()));
    while !b.is_empty() {
        let rest = if a.len() < b.len() {
            a
        } else {
            divided(a, &b).1
        };
        (a, b) = (b, primitive(rest));
    }
    a
}

/// Quotient and remainder of the polynomial times a power of the divisor's leading coefficient.
fn divided(mut rest: Vec<IBig>, divisor: &[IBig]) -> (Vec<IBig>, Vec<IBig>) {
    let top = &divisor[divisor.len() - 1];
    let mut quotient = vec![IBig::ZERO; rest.len() + 1 - divisor.len()];
    for place in (0..quotient.len()).rev() {
        let factor = rest.pop().expect("as long as the divisor and the place");
        for k in rest.iter_mut().chain(&mut quotient) {
            *k *= top;
        }
        for (k, d) in rest[place..].iter_mut().zip(divisor) {
            *k -= &factor * d;
        }
        quotient[place] += factor;
    }
    (quotient, rest)
}

/// The polynomial without leading zeros, divided by the greatest common divisor of its coefficients.
fn primitive(mut polynomial: Vec<IBig>) -> Vec<IBig> {
    while polynomial.last() == Some(&IBig::ZERO) {
        polynomial.pop();
    }
    let mut divisor = IBig::ZERO;
    for k in polynomial.iter().filter(|k| **k != IBig::ZERO) {
        divisor = IBig::from(if divisor == IBig::ZERO {
            k.gcd(k)
        } else {
            (&divisor).gcd(k)
        });
    }
    polynomial.iter_mut().for_each(|k| *k = &*k / &divisor);
    polynomial
}

//! Numbers, vectors and polynomials as text.

use glam::DVec3;

/// A number with ten significant digits at most; zero has no sign.
pub(super) fn text(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    let size = rounded.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e10).contains(&size) || !size.is_finite() {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A number as an operand: in parentheses if it is negative.
pub(super) fn operand(x: f64) -> String {
    if x < 0.0 {
        format!("({})", text(x))
    } else {
        text(x)
    }
}

/// The coordinates of a point or a vector.
pub(super) fn point(p: DVec3) -> String {
    format!("({}, {}, {})", text(p.x), text(p.y), text(p.z))
}

/// A polynomial in t, from its coefficients in ascending order of powers.
pub(super) fn polynomial(coefficients: &[f64]) -> String {
    const POWERS: [&str; 5] = ["", " t", " t²", " t³", " t⁴"];
    let mut sum = String::new();
    for (&coefficient, power) in coefficients.iter().zip(POWERS).rev() {
        if coefficient == 0.0 {
            continue;
        }
        if sum.is_empty() {
            sum = text(coefficient) + power;
        } else {
            let sign = if coefficient < 0.0 { '−' } else { '+' };
            sum += &format!(" {sign} {}{power}", text(coefficient.abs()));
        }
    }
    if sum.is_empty() { text(0.0) } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_written_from_the_highest_power() {
        assert_eq!(polynomial(&[1.0, -2.5, 1.0]), "1 t² − 2.5 t + 1");
        assert_eq!(polynomial(&[0.0, 0.0, -3.0, 0.0, 1e-9]), "1e-9 t⁴ − 3 t²");
        assert_eq!(polynomial(&[0.0, 0.0]), "0");
        assert_eq!(polynomial(&[-4.0]), "-4");
    }

    #[test]
    fn numbers_have_ten_digits() {
        assert_eq!(text(1.0 / 3.0), "0.3333333333");
        assert_eq!(text(-0.0), "0");
        assert_eq!(text(2e-7), "2e-7");
        assert_eq!(operand(-1.5), "(-1.5)");
    }
}

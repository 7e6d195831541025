//! Bounds the difference between a mesh's coordinates and the decimals in the file.

use super::words::EXACT_DIGITS;
use crate::mesh::{TriangleMesh, two_sum};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Upper bound, per coordinate, on the distance between the traced mesh and the numbers in the file.
///
/// It sums the errors of three roundings: of the decimal to f64, of the difference from the origin, and of
/// that to f32. The last two are known exactly. The first is at most half an ulp of the f64, and zero if the
/// decimal equals the f64. `has_long_numbers` says whether a coordinate may have more than 15 digits.
/// Different decimals of at most 15 digits are different f64s, so that an f64 whose own value has no more
/// digits was written as exactly that value.
pub(super) fn max_rounding(mesh: &TriangleMesh, exact: &[DVec3], has_long_numbers: bool) -> f64 {
    rounding_of(mesh, exact, has_long_numbers, |_| true)
}

/// [`max_rounding`] of some of the vertices.
pub(super) fn rounding_of(
    mesh: &TriangleMesh,
    exact: &[DVec3],
    has_long_numbers: bool,
    counts: impl Fn(&DVec3) -> bool + Sync,
) -> f64 {
    let vertices = mesh.positions().par_iter().zip(exact);
    let larger_of = |mut most: f64, (own, in_file): (&Vec3, &DVec3)| {
        for axis in 0..3 {
            let (x, origin) = (in_file[axis], mesh.origin()[axis]);
            let (from_origin, lost) = two_sum(x, -origin);
            // Exact: the two differ by less than half an ulp of an f32.
            let moved = (from_origin - f64::from(own[axis])).abs() + lost.abs();
            // An upper bound on `read`.
            if moved + x.abs() * f64::EPSILON <= most {
                continue;
            }
            let read = half_last_place(x);
            if moved + read > most {
                let is_exact = !has_long_numbers && has_15_digits(x);
                most = most.max(if is_exact { moved } else { moved + read });
            }
        }
        most
    };
    let most = vertices
        .filter(|(own, in_file)| own.is_finite() && counts(in_file))
        .fold(|| 0.0, larger_of)
        .reduce(|| 0.0, f64::max);
    // The two sums above round at most three times.
    most * (1.0 + 4.0 * f64::EPSILON)
}

/// Half an ulp of an f64: the largest error of a decimal parsed as this f64.
fn half_last_place(x: f64) -> f64 {
    0.5 * (x.abs().next_up() - x.abs())
}

/// Whether the exact decimal expansion of an f64 has at most 15 digits. Returns false for some integers above
/// 2⁵³.
fn has_15_digits(x: f64) -> bool {
    const TOO_LARGE: u64 = 10u64.pow(EXACT_DIGITS);
    // 5²² exceeds 10¹⁵.
    const LEAST_POWER: i32 = -21;
    if x == 0.0 {
        return true;
    }
    let bits = x.abs().to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let whole = fraction | 1 << 52;
    // x = odd·2^power. Subnormal numbers have too many fractional bits in any case.
    let power = exponent - 1075 + whole.trailing_zeros().cast_signed();
    let odd = whole >> whole.trailing_zeros();
    match power {
        // odd·2⁻ᵏ = odd·5ᵏ·10⁻ᵏ.
        LEAST_POWER..0 => {
            let digits = odd.checked_mul(5u64.pow(power.unsigned_abs()));
            digits.is_some_and(|digits| digits < TOO_LARGE)
        }
        0..53 => x.abs() < TOO_LARGE as f64,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_of_an_f64s_exact_decimal_expansion_are_counted() {
        for (x, expected) in [
            (0.0, true),
            (-3.0, true),
            (0.5, true),
            (4_649_776.25, true),
            (999_999_999_999_999.0, true),
            (1e15, false),
            (0.1, false),
            (1e22, false),
            (1e-310, false),
            // 15 and 16 digits.
            (1.0 + 2f64.powi(-14), true),
            (1.0 + 2f64.powi(-15), false),
        ] {
            assert_eq!(has_15_digits(x), expected, "{x:e}");
        }
    }
}

//! Exact test for triangles of zero area, which have no normal and no barycentric coordinates; and the aspect ratio.

use glam::{DVec3, Vec3, Vec3Swizzles as _};

/// Whether the corners are exactly collinear. `false` if a corner isn't finite.
///
/// Corners are collinear if and only if their projections along all three axes are. Each projection is an orientation
/// test; its terms are products of two f32 numbers and therefore exact in f64.
#[inline]
pub fn has_zero_area(corners: [Vec3; 3]) -> bool {
    !surely_has_area(corners)
        && [(0, 1), (1, 2), (2, 0)]
            .into_iter()
            .all(|(x, y)| is_flat(corners.map(|p| [f64::from(p[x]), f64::from(p[y])])))
}

/// Whether a projection's area exceeds the rounding error, as for nearly all triangles. The differences and products
/// round once each, by at most 2⁻⁵³ of their size, so the error of the products' difference is at most 4·2⁻⁵³ of the
/// sum of their sizes. Products of differences of f32 numbers don't underflow in f64.
#[inline]
fn surely_has_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (p, q) = (b - a, c - a);
    let (left, right) = (p.yzx() * q.zxy(), p.zxy() * q.yzx());
    let error = 8.0 * f64::EPSILON * (left.abs() + right.abs());
    (left - right).abs().cmpgt(error).any()
}

/// The longest edge divided by the height above it; infinite if the height is 0 in f64 or a corner isn't finite.
pub(crate) fn aspect(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let longest = [b - a, c - b, a - c]
        .map(DVec3::length_squared)
        .into_iter()
        .fold(0.0, f64::max);
    let doubled_area = (b - a).cross(c - a).length();
    if doubled_area > 0.0 {
        longest / doubled_area
    } else {
        f64::INFINITY
    }
}

/// Whether A×B + B×C + C×A, twice the signed area in 2D, is exactly zero.
fn is_flat([a, b, c]: [[f64; 2]; 3]) -> bool {
    let terms = [
        a[0] * b[1],
        -(a[1] * b[0]),
        b[0] * c[1],
        -(b[1] * c[0]),
        c[0] * a[1],
        -(c[1] * a[0]),
    ];
    // Six terms and five roundings give an error of at most 5·2⁻⁵³·Σ|term|; 8ε = 16·2⁻⁵³ also covers the
    // rounding of the sum of magnitudes.
    let sum: f64 = terms.iter().sum();
    let size: f64 = terms.iter().map(|x| x.abs()).sum();
    if sum.abs() > 8.0 * f64::EPSILON * size {
        return false;
    }
    exact_sum_is_zero(terms)
}

/// Whether the exact sum of the terms is zero.
///
/// The sum is kept as an expansion: non-overlapping numbers whose exact sum it is. An expansion is zero if and only if
/// all its numbers are.
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic", DCG 18, 1997 (Grow-Expansion).
fn exact_sum_is_zero(terms: [f64; 6]) -> bool {
    let mut expansion = [0.0f64; 6];
    for (count, term) in terms.into_iter().enumerate() {
        let mut carry = term;
        for part in &mut expansion[..count] {
            (carry, *part) = two_sum(carry, *part);
        }
        expansion[count] = carry;
    }
    expansion.iter().all(|&part| part == 0.0)
}

/// The rounded sum of a and b, and its rounding error.
/// Source: Knuth, The Art of Computer Programming 2, 4.2.2.
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_have_no_area_at_any_scale() {
        for scale in [1e-40f32, 1e-20, 1.0, 1e20, 1e38] {
            // Multiples of a power of two stay exactly on the line.
            let unit = 2f32.powi(scale.log2() as i32);
            let dir = Vec3::new(1.0, 2.0, -3.0) * unit / 4.0;
            assert!(has_zero_area([dir, dir * 2.0, dir * 4.0]), "{scale}");
            assert!(has_zero_area([dir, dir, Vec3::ZERO]), "{scale}");
        }
    }

    #[test]
    fn the_thinnest_triangles_have_an_area() {
        let next = |x: f32| f32::from_bits(x.to_bits() + 1);
        let [a, b] = [Vec3::ZERO, Vec3::splat(1e6)];
        assert!(has_zero_area([a, b, Vec3::splat(0.5e6)]));
        let c = Vec3::new(0.5e6, 0.5e6, next(0.5e6));
        assert!(!has_zero_area([a, b, c]));
        let tiny = f32::from_bits(1);
        assert!(!has_zero_area([a, Vec3::X * tiny, Vec3::Y * tiny]));
    }

    #[test]
    fn a_triangle_whose_area_rounds_to_zero_in_f64_has_an_area() {
        // With x = 0 the third corner would be collinear. In f64 the sum of the six terms rounds to 0.
        let [a, b] = [Vec3::new(4.0, 3.0, 0.0), Vec3::new(2.0, 7.0, 4.0)];
        assert!(has_zero_area([a, b, Vec3::new(0.0, 11.0, 8.0)]));
        assert!(!has_zero_area([a, b, Vec3::new(-1e-45, 11.0, 8.0)]));
    }

    #[test]
    fn a_sum_that_rounds_to_zero_in_f64_is_not_zero() {
        assert!(!exact_sum_is_zero([1e30, 1.0, -1e30, 0.0, 0.0, 0.0]));
        assert!(exact_sum_is_zero([1e30, 1.0, -1e30, -0.5, -0.5, 0.0]));
    }
}

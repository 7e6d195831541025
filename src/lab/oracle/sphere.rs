//! Exact ray–sphere intersection.
//!
//! With f = o − c: a = d·d, b = f·d and c = f·f − r² are integers times powers of two, and t = (−b ± √(b² − ac))/a.
//! Whether a root exists and is positive follows from signs of integers. Its value is enclosed by integer square roots
//! of ever more digits, until both ends round to the same number (Ziv, "Fast Evaluation of Elementary Mathematical
//! Functions with Correctly Rounded Last Bit", TOMS 17(3), 1991). The kernels use intervals and Sturm sequences.

use super::fraction::Fraction;
use super::triangle::{dot, integers, minus};
use dashu_int::ops::SquareRoot as _;
use dashu_int::{IBig, UBig};
use glam::Vec3;
use hitscope_core::Ray;
use std::cmp::Ordering;

/// The positive t at which a ray meets a sphere, in ascending order and correctly rounded to f64. A ray that touches
/// the sphere meets it once. The ray's interval is ignored; a NaN or an infinity, and a radius that isn't positive, give
/// no hit.
pub fn sphere_crossings(ray: &Ray, centre: Vec3, radius: f32) -> Vec<f64> {
    crossings(ray, centre, radius).unwrap_or_default()
}

fn crossings(ray: &Ray, centre: Vec3, radius: f32) -> Option<Vec<f64>> {
    let radius = (radius > 0.0).then_some(radius)?;
    let lengths = [ray.origin, centre, Vec3::new(radius, 0.0, 0.0)];
    let (lengths, length_exponent) = integers(&lengths)?;
    let (dirs, dir_exponent) = integers(&[ray.dir])?;
    let (d, f) = (&dirs[0], minus(&lengths[0], &lengths[1]));
    let r = &lengths[2][0];
    let (a, b) = (dot(d, d), dot(&f, d));
    let c = dot(&f, &f) - r * r;
    let discriminant = &b * &b - &a * &c;
    let zero = IBig::ZERO;
    let root = |sign: i32| {
        let t = rounded(&a, &b, &discriminant, sign, length_exponent - dir_exponent);
        t.expect("a isn't 0")
    };
    // The signs of −b ± √(b² − ac), where the root exceeds |b| if c is negative.
    let is_near_positive = b < zero && c > zero;
    let is_far_positive = b < zero || c < zero;
    Some(match discriminant.cmp(&zero) {
        Ordering::Less => Vec::new(),
        Ordering::Equal => is_near_positive.then(|| root(1)).into_iter().collect(),
        Ordering::Greater => {
            let near = is_near_positive.then(|| root(-1));
            let far = is_far_positive.then(|| root(1));
            near.into_iter().chain(far).collect()
        }
    })
}

/// (−b + sign·√discriminant)/a·2^exponent, correctly rounded.
fn rounded(a: &IBig, b: &IBig, discriminant: &IBig, sign: i32, exponent: i32) -> Option<f64> {
    let mut digits = 64;
    loop {
        // √ is between s and s + 1, in units of 2^−digits.
        let scaled = UBig::try_from(discriminant << (2 * digits)).expect("not negative");
        let s = scaled.sqrt();
        let is_exact = &s * &s == scaled;
        let s = IBig::from(s);
        let ends = [s.clone(), s + IBig::from(i32::from(!is_exact))];
        let [low, high] = ends.map(|root| {
            let numerator = IBig::from(sign) * root - (b << digits);
            let t = Fraction::new(numerator, a << digits)?.scaled(exponent);
            Some(t.to_f64())
        });
        if low? == high? {
            return low;
        }
        digits *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_integers_are_exact_and_others_rounded() {
        let unit = |origin: [f32; 3], dir: [f32; 3]| {
            let ray = Ray::new(origin.into(), dir.into()).expect("a ray");
            sphere_crossings(&ray, Vec3::ZERO, 1.0)
        };
        assert_eq!(unit([0.0, 0.0, 3.0], [0.0, 0.0, -1.0]), [2.0, 4.0]);
        assert_eq!(unit([0.0, 0.0, 0.0], [0.0, 0.0, -2.0]), [0.5]);
        assert_eq!(unit([1.0, 0.0, 3.0], [0.0, 0.0, -1.0]), [3.0]);
        assert!(unit([1.0f32.next_up(), 0.0, 3.0], [0.0, 0.0, -1.0]).is_empty());
        assert!(unit([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]).is_empty());
        // On the surface, t = 0 doesn't count.
        assert_eq!(unit([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), [2.0]);
        // 3 ∓ √0.75 = 2.13397459621556135323… and 3.86602540378443864676…
        let roots = unit([0.5, 0.0, 3.0], [0.0, 0.0, -1.0]);
        assert_eq!(roots, [2.133974596215561, 3.866025403784439]);
    }
}

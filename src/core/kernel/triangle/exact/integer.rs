//! Exact ray–triangle predicates in integers, for decisions that f64 leaves open.
//!
//! Every f32 is an integer times a power of two. With A, B, C relative to the origin and n = (B − A)×(C − A):
//!
//! ```text
//! W_a = d·(B×C), W_b = d·(C×A), W_c = d·(A×B)    inside: none has the sign opposite to det
//! det = W_a + W_b + W_c = d·n,  t = A·n/det,  u = W_b/det,  v = W_c/det
//! ```
//!
//! 128 bits suffice on grids and for numbers of similar magnitude; otherwise the integers have any size.
//! Bits, if coordinates have L and directions D of them: |W| < 2^(D+2L+5), |A·n| < 2^(3L+8), and
//! |det| < 2^(D+2L+7).

use crate::algebra::Dyadic;
use crate::ray::Ray;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, UnsignedAbs};
use glam::Vec3;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Shl, Sub};

/// An integer type that is wide enough for its use.
trait Integer: Clone + Ord + From<i32> + Neg<Output = Self> + Shl<usize, Output = Self> {}
impl Integer for i128 {}
impl Integer for IBig {}

/// Whether the ray's line meets the closed triangle. `false` if it is parallel to the triangle.
pub(super) fn is_inside(ray: &Ray, corners: [Vec3; 3]) -> bool {
    let lengths = Span::of(&[ray.origin, corners[0], corners[1], corners[2]]);
    let dirs = Span::of(&[ray.dir]);
    if dirs.bits + 2 * lengths.bits + 7 <= 127 {
        is_inside_in::<i128>(ray, corners, lengths, dirs)
    } else {
        is_inside_in::<IBig>(ray, corners, lengths, dirs)
    }
}

/// Whether the ray's line passes through a point.
pub(super) fn meets(ray: &Ray, point: Vec3) -> bool {
    let lengths = Span::of(&[ray.origin, point]);
    let dirs = Span::of(&[ray.dir]);
    if dirs.bits + lengths.bits + 2 <= 127 {
        meets_in::<i128>(ray, point, lengths, dirs)
    } else {
        meets_in::<IBig>(ray, point, lengths, dirs)
    }
}

/// Compares the t of two triangles. The ray must be parallel to neither.
pub(super) fn compare(ray: &Ray, first: [Vec3; 3], second: [Vec3; 3]) -> Ordering {
    let [a, b, c] = first;
    let [d, e, f] = second;
    let lengths = Span::of(&[ray.origin, a, b, c, d, e, f]);
    let dirs = Span::of(&[ray.dir]);
    if 5 * lengths.bits + dirs.bits + 15 <= 127 {
        compare_in::<i128>(ray, first, second, lengths, dirs)
    } else {
        compare_in::<IBig>(ray, first, second, lengths, dirs)
    }
}

/// Compares t with a finite number, exactly. The ray must not be parallel to the triangle.
pub(super) fn compare_with(ray: &Ray, corners: [Vec3; 3], t: f32) -> Ordering {
    let lengths = Span::of(&[ray.origin, corners[0], corners[1], corners[2]]);
    let dirs = Span::of(&[ray.dir]);
    let (numerator, det) = fraction::<IBig>(ray, corners, lengths, dirs);
    // Compare numerator/det·2^(l − d) with m·2^e.
    let (mantissa, exponent) = decode(t);
    let shift = lengths.exponent - dirs.exponent - exponent;
    let (left, right) = (numerator, IBig::from(mantissa) * &det);
    let order = if shift >= 0 {
        (left << shift as usize).cmp(&right)
    } else {
        left.cmp(&(right << shift.unsigned_abs() as usize))
    };
    if det < IBig::ZERO {
        order.reverse()
    } else {
        order
    }
}

/// t, u and v to the second-to-last place of f64.
pub(super) fn rounded(ray: &Ray, corners: [Vec3; 3]) -> [f64; 3] {
    let lengths = Span::of(&[ray.origin, corners[0], corners[1], corners[2]]);
    let dirs = Span::of(&[ray.dir]);
    let (numerator, det) = fraction::<IBig>(ray, corners, lengths, dirs);
    let [_, w_b, w_c] = weights::<IBig>(ray, corners, lengths, dirs);
    let exponent = lengths.exponent - dirs.exponent;
    [
        quotient(&numerator, &det, exponent),
        quotient(&w_b, &det, 0),
        quotient(&w_c, &det, 0),
    ]
}

/// Numerator and denominator of t.
pub(super) fn ratio(ray: &Ray, corners: [Vec3; 3]) -> [Dyadic; 2] {
    let lengths = Span::of(&[ray.origin, corners[0], corners[1], corners[2]]);
    let dirs = Span::of(&[ray.dir]);
    let (numerator, det) = fraction::<IBig>(ray, corners, lengths, dirs);
    [
        Dyadic::new(numerator, lengths.exponent - dirs.exponent),
        Dyadic::new(det, 0),
    ]
}

/// `numerator/denominator·2^exponent`, truncated to 62 digits and then rounded.
fn quotient(numerator: &IBig, denominator: &IBig, exponent: i32) -> f64 {
    let bits = |x: &IBig| x.unsigned_abs().bit_len() as i32;
    let shift = 62 - (bits(numerator) - bits(denominator));
    let scaled = if shift >= 0 {
        (numerator << shift as usize) / denominator
    } else {
        numerator / (denominator << shift.unsigned_abs() as usize)
    };
    let digits = i64::try_from(scaled).expect("63 digits at most");
    // Two steps, so that neither power of two leaves the range of f64.
    let power = exponent - shift;
    digits as f64 * 2f64.powi(power / 2) * 2f64.powi(power - power / 2)
}

fn is_inside_in<T: Integer>(ray: &Ray, corners: [Vec3; 3], lengths: Span, dirs: Span) -> bool
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let [a, b, c] = weights::<T>(ray, corners, lengths, dirs);
    let zero = T::from(0);
    let side = (&(&a + &b) + &c).cmp(&zero);
    side != Ordering::Equal && [a, b, c].iter().all(|w| w.cmp(&zero) != side.reverse())
}

fn meets_in<T: Integer>(ray: &Ray, point: Vec3, lengths: Span, dirs: Span) -> bool
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let origin = lengths.integers::<T>(ray.origin);
    let to_point = minus(&lengths.integers(point), &origin);
    let moment = cross(&dirs.integers(ray.dir), &to_point);
    moment.iter().all(|x| *x == T::from(0))
}

fn compare_in<T: Integer>(
    ray: &Ray,
    first: [Vec3; 3],
    second: [Vec3; 3],
    lengths: Span,
    dirs: Span,
) -> Ordering
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let positive = |(numerator, det): (T, T)| {
        if det < T::from(0) {
            (-numerator, -det)
        } else {
            (numerator, det)
        }
    };
    let (left, left_det) = positive(fraction(ray, first, lengths, dirs));
    let (right, right_det) = positive(fraction(ray, second, lengths, dirs));
    (&left * &right_det).cmp(&(&right * &left_det))
}

/// The edge functions W_a, W_b, W_c.
fn weights<T: Integer>(ray: &Ray, corners: [Vec3; 3], lengths: Span, dirs: Span) -> [T; 3]
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let [a, b, c] = relative(ray, corners, lengths);
    let d: [T; 3] = dirs.integers(ray.dir);
    [
        dot(&d, &cross(&b, &c)),
        dot(&d, &cross(&c, &a)),
        dot(&d, &cross(&a, &b)),
    ]
}

/// A·n and det; t is their quotient times 2^(lengths − dirs).
fn fraction<T: Integer>(ray: &Ray, corners: [Vec3; 3], lengths: Span, dirs: Span) -> (T, T)
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let [a, b, c] = relative::<T>(ray, corners, lengths);
    let normal = cross(&minus(&b, &a), &minus(&c, &a));
    (dot(&a, &normal), dot(&dirs.integers(ray.dir), &normal))
}

fn relative<T: Integer>(ray: &Ray, corners: [Vec3; 3], lengths: Span) -> [[T; 3]; 3]
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    let origin = lengths.integers::<T>(ray.origin);
    corners.map(|p| minus(&lengths.integers(p), &origin))
}

/// The range of powers of two that holds all bits of some numbers.
#[derive(Clone, Copy)]
struct Span {
    /// Exponent of the lowest bit.
    exponent: i32,
    /// Number of bits from the lowest to the highest.
    bits: i32,
}

impl Span {
    fn of(vectors: &[Vec3]) -> Self {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for (mantissa, exponent) in vectors.iter().flat_map(|v| v.to_array()).map(decode) {
            if mantissa != 0 {
                low = low.min(exponent + mantissa.trailing_zeros() as i32);
                high = high.max(exponent + 32 - mantissa.unsigned_abs().leading_zeros() as i32);
            }
        }
        Self {
            exponent: if low > high { 0 } else { low },
            bits: (high.saturating_sub(low)).max(0),
        }
    }

    /// The coordinates in units of the lowest bit.
    fn integers<T: Integer>(self, v: Vec3) -> [T; 3] {
        v.to_array().map(|x| {
            let (mantissa, exponent) = decode(x);
            let shift = exponent - self.exponent;
            if mantissa == 0 {
                T::from(0)
            } else if shift >= 0 {
                T::from(mantissa) << shift as usize
            } else {
                // The bits shifted out are zeros: none lies below the lowest bit.
                T::from(mantissa >> shift.unsigned_abs())
            }
        })
    }
}

/// Mantissa and exponent of a finite number, which is `mantissa·2^exponent`.
fn decode(x: f32) -> (i32, i32) {
    let bits = x.to_bits();
    let exponent = (bits >> 23 & 0xff) as i32;
    let fraction = (bits & ((1 << 23) - 1)) as i32;
    let (size, exponent) = match exponent {
        0 => (fraction, -149),
        _ => (fraction | 1 << 23, exponent - 150),
    };
    (if x < 0.0 { -size } else { size }, exponent)
}

/// Arithmetic on references, which avoids copies of large integers.
trait Arithmetic<'a, T: 'a>:
    Add<&'a T, Output = T> + Sub<&'a T, Output = T> + Mul<&'a T, Output = T> + Sized
{
}
impl<'a, T: 'a, R> Arithmetic<'a, T> for R where
    R: Add<&'a T, Output = T> + Sub<&'a T, Output = T> + Mul<&'a T, Output = T>
{
}

fn minus<T>(a: &[T; 3], b: &[T; 3]) -> [T; 3]
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn cross<T>(a: &[T; 3], b: &[T; 3]) -> [T; 3]
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    [
        &(&a[1] * &b[2]) - &(&a[2] * &b[1]),
        &(&a[2] * &b[0]) - &(&a[0] * &b[2]),
        &(&a[0] * &b[1]) - &(&a[1] * &b[0]),
    ]
}

fn dot<T>(a: &[T; 3], b: &[T; 3]) -> T
where
    for<'a> &'a T: Arithmetic<'a, T>,
{
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

#[cfg(test)]
mod tests;

//! Filter of the spheres that a line may meet, in one precision, with an error bound.
//!
//! With f = o − c, the line misses the sphere if |f×d| > r·|d|. u = 2⁻²⁴ is the largest relative error of an operation,
//! F = |f| and D = |d|. A component of x = f×d is the difference of two products, each of which errs by 2u: u through f and u
//! of its own. The sums of the products' sizes form a vector of at most the length √2·F·D, because
//! Σ(F² − f_i²)(D² − d_i²) = F²D² + Σf_i²d_i² ≤ 2F²D². The differences err by u|x|:
//!
//! ```text
//! |δx| ≤ 2√2·u·F·D + u|x|      so the line misses the sphere if |x|·(1 − u) > D·(r + 2√2·u·F)
//! ```
//!
//! The code compares squares. It has 4u instead of 2√2·u, and |f_x| + |f_y| + |f_z| ≥ F. All other roundings add up to less
//! than 16u relatively, and the code has 32u. Products that underflow err by less than 2⁻¹⁴⁷ altogether, a millionth of
//! the least normal number. That is added to both factors of the right side, either of which may be large, and to
//! their product. If anything overflows, one side is infinite or NaN: an infinite right side or a NaN counts as met, and
//! a left side that overflows exceeds any right side that doesn't.
//!
//! A kernel that computes the distance of line and centre in f64 with an error of at most 2¹⁰·2⁻⁵³·(F + r) misses the
//! sphere, too: the bound in the code exceeds the derived one by more than u·F, and r by 8u·r.

use crate::lane::{Lane, cross, dot, minus};

/// The lanes whose spheres a line may meet; false for a radius that is NaN or not positive.
#[inline(always)]
pub(super) fn may_meet<L: Lane>(
    [origin, dir]: [&[L; 3]; 2],
    centre: &[L; 3],
    radius: L,
) -> L::Mask {
    let constant = |x: f32| L::of(radius.token(), x);
    let least_normal = constant(f32::MIN_POSITIVE);
    let f = minus(origin, centre);
    let x = cross(&f, dir);
    let size = f[0].abs() + f[1].abs() + f[2].abs();
    let reach = radius + constant(2.0 * f32::EPSILON) * size;
    let dir_squared = (dot(dir, dir) + least_normal) * constant(1.0 + 16.0 * f32::EPSILON);
    let most = (reach * reach + least_normal) * dir_squared + least_normal;
    !most.lt(dot(&x, &x)) & constant(0.0).lt(radius)
}

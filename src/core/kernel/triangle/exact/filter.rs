//! Edge functions and depths with error bounds, in f32 or f64.
//!
//! The relative rounding error of one operation is at most u, 2⁻²⁴ in f32 and 2⁻⁵³ in f64. The constants
//! exceed those derived here by enough to cover O(u²) and the rounding of the bounds themselves;
//! `LEAST_NORMAL` covers underflow in f32. In f64 nothing derived from f32 numbers under- or overflows.
//!
//! **Shear.** With A relative to the origin, z = A_z, and |d_x| ≤ |d_z|: x = A_x − (d_x/d_z)·A_z in f32. The
//! difference A_x errs by u|A_x|; the slope, A_z and their product by 3u|A_z|; the last difference by u|x|;
//! |A_x| ≤ |x| + |A_z|. In f64 everything is multiplied by d_z: x = A_x·d_z − d_x·A_z. The differences and
//! products err by 2u(|A_x·d_z| + |d_x·A_z|), the last difference by u|x|. Both are within
//!
//! ```text
//! |δx| ≤ 4u·Q + 3u·X        X, Y, Z: the largest |x|, |y|, |z| of the three corners,
//!                           Q = Z in f32, |d_z|·Z in f64
//! ```
//!
//! **Edges.** The error of E = x₁y₂ − x₂y₁ comes from its four factors and from three roundings of its own:
//!
//! ```text
//! |δE| ≤ 2(X·|δy| + Y·|δx|) + 2|δx||δy| + 4u·XY ≤ 8u·Q(X + Y) + 16u·XY + 32u²Q²
//!      ≤ u(s + 4uQ)(8Q + 4s)                       s = X + Y, for XY ≤ s²/4
//! ```
//!
//! The right side overflows before any edge product does, and a bound that isn't finite certifies nothing.
//!
//! **Depth.** ζ = t·d_z is the mean of the corners' depths, weighted by the edge functions E/S with S = ΣE.
//! Computed with E + e, |e| ≤ err, it is off by Σe(z − ζ)/S, at most 3·err·R/|S| with R the range of the
//! corners' depths. Both refer to the rounded depths, whose mean is off by u·Z. The computation itself rounds
//! the differences from A's depth seven times (S twice, its inverse, two products, a difference, a sum) and a
//! depth once; subtracting the bound rounds once more.
//!
//! ```text
//! |δζ| ≤ 3·err·R/|S| + 7u·R + 3u·Z
//! ```
//!
//! The code has 4·err, which covers the rounding of R and is also the error of a weight.
//!
//! **Weights.** E/S is off by (1 + 3)·err/|S| and by four roundings.
//!
//! Both bounds hold for every triangle that is hit, even if the signs of E + e leave the hit undecided: S is
//! then the computed sum, which need only be nonzero. Two of the computed edge functions may then have the
//! wrong sign, by at most err each, so roundings relative to Σ|E + e| ≤ |S| + 4·err exceed those relative to
//! S by no more than O(u)·err/|S|.

use super::super::shear::ShearedRay;
use crate::lane::{Lane, LaneMask, Number, Values};

/// The filter's result for the triangles in the lanes. A lane in neither mask is undecided.
pub(crate) struct Filtered<L: Lane> {
    /// Certain hits of the ray's line: it meets the triangle's interior, at a depth between `near` and `far`.
    pub certain: L::Mask,
    /// Certain misses.
    pub missed: L::Mask,
    /// The depth |t·d_z|, with t's sign. This and the following fields are valid in lanes whose triangle is
    /// hit, certainly or not.
    pub depth: L,
    /// Largest error of the depth.
    pub slack: L,
    /// Weights of the second and the third corner.
    pub weights: [L; 2],
    /// Largest error of the weights, without their four roundings.
    pub weight_error: L,
}

impl<L: Lane> Filtered<L> {
    /// Lower bound of the depth.
    #[inline(always)]
    pub fn near(&self) -> L {
        self.depth - self.slack
    }

    /// Upper bound of the depth.
    #[inline(always)]
    pub fn far(&self) -> L {
        self.depth + self.slack
    }

    /// The lanes in which t errs relatively by no more than `t_slack`, and the weights by no more than
    /// `weight_slack`.
    #[inline(always)]
    pub fn is_within(&self, t_slack: L::Number, weight_slack: L::Number) -> L::Mask {
        let token = self.depth.token();
        let most = L::splat(token, t_slack) * self.depth.abs();
        self.slack.le(most) & self.weight_error.le(L::splat(token, weight_slack))
    }

    /// [`is_within`](Self::is_within) for [`Number::T_SLACK`] and [`Number::WEIGHT_SLACK`].
    #[inline(always)]
    pub fn is_accurate(&self) -> L::Mask {
        self.is_within(L::Number::T_SLACK, L::Number::WEIGHT_SLACK)
    }
}

/// Tests a ray's line against triangles whose values are their corners. Returns `None` if all are certain
/// misses.
#[inline(always)]
pub(crate) fn filter<L: Lane>(
    ray: &ShearedRay<L>,
    triangles: &impl Values<L>,
) -> Option<Filtered<L>> {
    let token = ray.dir_z().token();
    let u = L::splat(token, L::Number::U);
    let constant = |x: f32| L::of(token, x);

    let [a, b, c] = ray.sheared(triangles);
    let edge = [
        c[0] * b[1] - c[1] * b[0],
        a[0] * c[1] - a[1] * c[0],
        b[0] * a[1] - b[1] * a[0],
    ];
    let least = edge[0].lesser(edge[1]).lesser(edge[2]);
    let most = edge[0].greater(edge[1]).greater(edge[2]);

    let largest = |k: usize| a[k].abs().greater(b[k].abs()).greater(c[k].abs());
    let (s, z) = (largest(0) + largest(1), largest(2));
    let q = z * ray.unit().abs();
    let least_normal = L::splat(token, L::Number::LEAST_NORMAL);
    let error = (s + constant(4.0) * u * q) * (constant(8.0625) * q + constant(4.0625) * s) * u
        + least_normal;

    // `lesser` and `greater` may drop a NaN; an edge is NaN only if the error is infinite or NaN.
    let missed = error.lt(most) & least.lt(-error);
    let certain = error.lt(least) | most.lt(-error);
    if missed.all() {
        return None;
    }

    let det = edge[0] + edge[1] + edge[2];
    // Infinite if det is subnormal: then the bounds are NaN or infinite, and decide nothing.
    let inverse = constant(1.0) / det;
    let weights = [edge[1] * inverse, edge[2] * inverse];
    let (to_b, to_c) = (b[2] - a[2], c[2] - a[2]);
    let depth = a[2] + (weights[0] * to_b + weights[1] * to_c);
    let range = a[2].greater(b[2]).greater(c[2]) - a[2].lesser(b[2]).lesser(c[2]);
    let weight_error = constant(4.0) * error * inverse.abs();
    let slack =
        weight_error * range + (constant(7.5) * range + constant(4.25) * z) * u + least_normal;
    Some(Filtered {
        certain,
        missed,
        depth: depth.flip(ray.dir_z()),
        slack,
        weights,
        weight_error,
    })
}

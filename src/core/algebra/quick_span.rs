//! The crossing of a line with the plane of two half axes in plain f64, with an error bound derived in advance.
//!
//! The plane consists of the points c + a·u + b·v, and n = u×v. U = 2⁻⁵³ is the largest relative error of an operation.
//! |x| is the sum of the magnitudes of a vector's coordinates, and ‖x‖ the largest of them. Constants in the code
//! exceed those derived here, as in `quick_line`.
//!
//! Products of two f32 are exact, so the coordinates of n err relatively by U, as do those of f = o − c. Each term of
//! n·f errs by 3U and each term of n·d by 2U, and the sums add 2U:
//!
//! ```text
//! |δ(n·f)| ≤ 5U·Σ|nᵢfᵢ| < 8U·Σ|nᵢfᵢ|      |δ(n·d)| ≤ 4U·Σ|nᵢdᵢ| < 8U·Σ|nᵢdᵢ|
//! ```
//!
//! The line crosses the plane at t = −n·f / n·d. If the error of n·d is at most half of it,
//!
//! ```text
//! |δt| ≤ 2·(|δ(n·f)| + |t|·|δ(n·d)|) / |n·d| + 2U|t|
//! ```
//!
//! The crossing is c + p with p = f + t·d. The coordinates of p err by δt·dᵢ, by U through f and the product, and by U
//! through the sum: together by δp with |δp| ≤ |δt||d| + 3U(|f| + |t||d|). At the crossing, a·n² = p·(v×n) and
//! b·n² = p·(n×u). A coordinate of v×n is at most 2‖v‖‖n‖ and errs by 6U‖v‖‖n‖, so a·n² errs by
//!
//! ```text
//! |δ(a·n²)| ≤ ‖v‖‖n‖·(2|δp| + (6 + 6)U|p|)
//! ```
//!
//! and n² relatively by 5U. The same bound with u in place of v holds for b·n².

use super::interval::Interval;
use super::interval_roots::RootIntervals;
use super::quick_line::{QuickLine, U, length1};
use glam::{DVec3, Vec3};

/// The crossing of a line with the plane of two half axes.
#[derive(Clone, Copy, Debug)]
pub struct QuickSpan {
    t: Interval,
    /// Bounds of |a|·n².
    a: [f64; 2],
    /// Bounds of |b|·n².
    b: [f64; 2],
    /// Bounds of n².
    one: [f64; 2],
}

impl QuickLine {
    /// The crossing with the plane of the points c + a·u + b·v, as derived in the [module](self).
    ///
    /// `None` if it isn't certain that there is one.
    #[inline(always)]
    pub fn in_plane(&self, centre: Vec3, axes: [Vec3; 2]) -> Option<QuickSpan> {
        let [u, v] = axes.map(Vec3::as_dvec3);
        let n = u.cross(v);
        let f = self.origin - centre.as_dvec3();
        let (along, across) = (n * self.dir, n * f);
        let (along_error, across_error) = (8.0 * U * length1(along), 8.0 * U * length1(across));
        let speed = along.element_sum();
        // False for NaN.
        let crosses = speed.abs() > 2.0 * along_error;
        if !crosses {
            return None;
        }
        let per_speed = 1.0 / speed;
        let t = -across.element_sum() * per_speed;
        let slack = 2.0 * (across_error + t.abs() * along_error) * per_speed.abs();
        let slack = slack + 4.0 * U * t.abs();
        let p = f + t * self.dir;
        let reach = length1(f) + t.abs() * length1(self.dir);
        let p_error = 2.0 * (slack * length1(self.dir) + 3.0 * U * reach) + 16.0 * U * reach;
        let size = n.abs().max_element();
        let bounds = |product: f64, axis: DVec3| {
            let error = p_error * size * axis.abs().max_element();
            [product.abs() - error, product.abs() + error]
        };
        let one = n.length_squared();
        Some(QuickSpan {
            t: Interval {
                lo: t - slack,
                hi: t + slack,
            },
            a: bounds(p.dot(v.cross(n)), v),
            b: bounds(p.dot(n.cross(u)), u),
            one: [one * (1.0 - 8.0 * U), one * (1.0 + 8.0 * U)],
        })
    }
}

impl QuickSpan {
    /// The crossing if |a| ≤ 1 and |b| ≤ 1; `None` if that isn't certain.
    #[inline(always)]
    pub fn in_parallelogram(&self) -> Option<RootIntervals> {
        let Self { a, b, one, .. } = self;
        self.decided(
            a[1] < one[0] && b[1] < one[0],
            a[0] > one[1] || b[0] > one[1],
        )
    }

    /// The crossing if a² + b² ≤ 1; `None` if that isn't certain.
    #[inline(always)]
    pub fn in_ellipse(&self) -> Option<RootIntervals> {
        // Squares of numbers below 10⁻¹⁵⁴ are subnormal and have fewer digits. This limit leaves a margin.
        const LEAST: f64 = 1e-140;
        let has_all_digits = self.one[0] > LEAST;
        if !has_all_digits {
            return None;
        }
        let squared = |[a, b]: [f64; 2]| a * a + b * b;
        let nearest = squared([self.a[0].max(0.0), self.b[0].max(0.0)]);
        let farthest = squared([self.a[1], self.b[1]]);
        // The squares and the sum err by 3U.
        let inner = self.one[0] * self.one[0] * (1.0 - 8.0 * U);
        let outer = self.one[1] * self.one[1] * (1.0 + 8.0 * U);
        self.decided(farthest < inner, nearest > outer)
    }

    #[inline(always)]
    fn decided(&self, is_inside: bool, is_outside: bool) -> Option<RootIntervals> {
        if is_outside {
            Some(RootIntervals::NONE)
        } else if is_inside {
            RootIntervals::NONE.with(self.t)
        } else {
            None
        }
    }
}

//! Roots along a ray in plain f64, with error bounds derived in advance.
//!
//! An operation on intervals takes some ten operations, so for a simple shape most of the time goes into bounds that can
//! be derived once. u = 2⁻⁵³ is the largest relative error of an operation. The constants in the code exceed those derived
//! here by enough to cover O(u²) and the rounding of the bounds themselves. Nothing derived from f32 numbers over- or
//! underflows.
//!
//! **Points at a distance r from a centre c.** Source: Haines, Günther, Akenine-Möller, "Precision Improvements for
//! Ray/Sphere Intersection", Ray Tracing Gems, 2019. With f = o − c, F = |f| and D = |d|, the ray is nearest to the centre at
//! m = −f·d/D², and l = f + m·d. Products of two f32 are exact, so D² errs relatively by 2u and its inverse by 3u. f·d errs
//! by 4u·F·D: u each through f and the products, and 2u through the sums. So m errs by (4 + 3 + 1)u·F/D, and l by that
//! times D and by u·F each through f, the products and the sums:
//!
//! ```text
//! |δm| ≤ 8u·F/D      |δl| ≤ 11u·F
//! ```
//!
//! The square of |l| errs by 22u·F|l| + (11u·F)² through l and by 3u|l|² through its own roundings, and its difference from
//! r² by as much and u·r² if |l| ≤ r. So this difference, Δ, errs by less than E where Δ > E. The line misses the sphere if
//! |l| − 11u·F > r, which follows from Δ < −E:
//!
//! ```text
//! E = 2r·h + h² + 5u·r²      h = 12u·(|f_x| + |f_y| + |f_z|) ≥ 12u·F
//! ```
//!
//! The roots are m ± √Δ/D. √Δ errs by E/√Δ through Δ, because √Δ − √Δ′ = (Δ − Δ′)/(√Δ + √Δ′), and by u relatively; 1/D
//! errs by 3u and the product by u. The sum and its bound round by u|t| each, where |t| ≤ F/D + √Δ/D:
//!
//! ```text
//! |δt| ≤ (8 + 2)u·F/D + E/√Δ/D + (5 + 2)u·√Δ/D
//! ```

use super::interval::Interval;
use super::interval_roots::RootIntervals;
use crate::ray::Ray;
use glam::{DVec3, Vec3};

/// A ray's line, prepared for many shapes.
#[derive(Clone, Copy, Debug)]
pub struct QuickLine {
    pub(super) origin: DVec3,
    pub(super) dir: DVec3,
    per_length_squared: f64,
    per_length: f64,
}

/// The largest relative error of an operation.
pub(super) const U: f64 = f64::EPSILON / 2.0;

/// The sum of the magnitudes of the coordinates.
#[inline(always)]
pub(super) fn length1(v: DVec3) -> f64 {
    v.abs().element_sum()
}

impl QuickLine {
    #[inline(always)]
    pub fn of(ray: &Ray) -> Self {
        let dir = ray.dir.as_dvec3();
        let squared = dir.length_squared();
        Self {
            origin: ray.origin.as_dvec3(),
            dir,
            per_length_squared: 1.0 / squared,
            per_length: 1.0 / squared.sqrt(),
        }
    }

    /// Bounds of t of the points at a distance from a centre, as derived in the [module](self). `None` if their number or
    /// order isn't certain, if a number isn't finite, or if the distance isn't positive.
    #[inline(always)]
    pub fn at_distance(&self, centre: Vec3, distance: f32) -> Option<RootIntervals> {
        let f = self.origin - centre.as_dvec3();
        let m = -f.dot(self.dir) * self.per_length_squared;
        let l = f + m * self.dir;
        let r = f64::from(distance);
        let difference = r * r - l.length_squared();
        let h = 12.0 * U * length1(f);
        let error = (2.0 * r + h) * h + 5.0 * U * r * r;
        // Comparisons with NaN are false, and bounds that aren't finite are refused.
        if difference < -error && distance > 0.0 {
            return Some(RootIntervals::NONE);
        }
        if !(error < difference && distance > 0.0) {
            return None;
        }
        let root = difference.sqrt();
        let half = root * self.per_length;
        let slack = (h + error / root) * self.per_length + 10.0 * U * half;
        let around = |t: f64| Interval {
            lo: t - slack,
            hi: t + slack,
        };
        RootIntervals::NONE
            .with(around(m - half))?
            .with(around(m + half))
    }
}

//! Ray–triangle test whose decisions match exact arithmetic, at nearly the speed of f32.
//!
//! Source: the edge functions of the watertight kernel (Woop, Benthin, Wald, JCGT 2(1), 2013) with error
//!   bounds derived here, in the manner of Shewchuk's adaptive predicates (DCG 18, 1997): f32 first, then
//!   f64, then integers, each only if the previous one can't decide. Bounds: `filter`; integers: `integer`.
//! Promises: exact decisions about hit or miss, `t_min < t < t_max`, and the order of two hits by t, for any
//!   finite ray and triangle. Triangles are closed: their boundary belongs to them. A ray in a triangle's
//!   plane misses it, and every ray misses a triangle of zero area. t errs by at most 0.51 ulp of f32, a
//!   weight by at most 1.02·2⁻²⁵. So the kernel is watertight, and a ray through a shared edge or vertex
//!   meets all triangles there at the same t: one crossing, reported for the triangle with the lowest index.
//! Doesn't promise: hits beyond the largest finite f32, which are misses; hits through a tree whose boxes lie
//!   at distances that aren't normal f32 numbers, about 1e-38 to 1e38 (see `bvh::slab`).

mod filter;
mod integer;
mod interval;
mod judge;
mod rounding;

pub(crate) use filter::{Filtered, filter};
pub(crate) use interval::DepthInterval;
pub(crate) use judge::{Candidate, Corners, Judge};
pub(crate) use rounding::HitLanes;

use crate::algebra::Algebraic;
use crate::kernel::{KernelInfo, Precision, Promises, Tier};
use crate::lane::Number;
use crate::ray::{Hit, Ray};
use glam::Vec3;

/// The kernel's description.
pub(crate) static INFO: KernelInfo = KernelInfo {
    name: "exact",
    title: "Exact, adaptive",
    tier: Some(Tier::Exact),
    precision: Precision::Adaptive,
    source: "Shewchuk, Adaptive Precision Floating-Point Arithmetic, DCG 1997",
    summary: "Every decision matches exact arithmetic; uses f64 and integers only where needed.",
    promises: Promises {
        is_watertight: true,
        is_accurate: true,
        is_exact: true,
        is_translation_invariant: true,
    },
};

/// The number of values stored per triangle: its corners.
pub(crate) const VALUES: usize = 9;

/// Tests one triangle. The hit's `primitive` is 0.
pub(in crate::kernel) fn intersect_one(ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
    evaluate(ray, corners, |judge, candidate| judge.hit(candidate))
}

/// Bounds of t, given t as computed by [`Judge::values`].
pub(crate) fn t_bounds(t: f64) -> [f64; 2] {
    // 2⁻³¹ exceeds the error, 2⁻³², and the rounding of the bounds.
    let slack = t.abs() / (1u64 << 31) as f64;
    [t - slack, t + slack]
}

/// The exact t of a triangle that the ray hits.
pub(crate) fn exact_t(ray: &Ray, corners: [Vec3; 3]) -> Algebraic {
    let [numerator, denominator] = integer::ratio(ray, corners);
    Algebraic::ratio(&numerator, &denominator).expect("a ray that hits isn't parallel")
}

/// t, u and v of a ray's hit of a triangle, or `None` for a miss; t and the weights are as accurate as `N` requires.
pub(in crate::kernel) fn answer_for<N: Number>(ray: &Ray, corners: [Vec3; 3]) -> Option<[f64; 3]> {
    evaluate(ray, corners, |judge, candidate| {
        judge.values_for::<N>(candidate)
    })
}

fn evaluate<T>(
    ray: &Ray,
    corners: [Vec3; 3],
    answer: impl Fn(&Judge<'_, [Vec3; 3]>, Candidate) -> T,
) -> Option<T> {
    if !corners.iter().all(|p| p.is_finite()) {
        return None;
    }
    let mut judge = Judge::new(ray, corners);
    let unknown = Candidate::new(0, 0, f32::NEG_INFINITY, f32::INFINITY);
    let candidate = judge.within(unknown, false)?;
    Some(answer(&judge, candidate))
}

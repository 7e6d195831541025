//! Test of any shape that states its crossings as polynomials, with decisions as in exact arithmetic.
//!
//! Source: intervals first, then integers, as in Shewchuk, "Adaptive Precision Floating-Point Arithmetic", DCG 18,
//!   1997; see `algebra` for the roots of polynomials.
//! Promises: exact decisions about hit or miss, `t_min < t < t_max`, and the order of two hits by t, also of
//!   different shapes; t correctly rounded. A ray that touches a surface hits it; one that lies in a surface misses it.
//! Doesn't promise: hits beyond the largest finite f32, which are misses.

use super::{KernelInfo, Precision, Promises, Tier};
use crate::algebra::{CrossingSolver, Pieces};
use crate::ray::{Hit, Ray};

/// The kernel's description.
pub(crate) static INFO: KernelInfo = KernelInfo {
    name: "exact",
    title: "Exact, adaptive",
    tier: Some(Tier::Exact),
    precision: Precision::Adaptive,
    source: "Shewchuk, Adaptive Precision Floating-Point Arithmetic, DCG 1997",
    summary: "Every decision matches exact arithmetic; uses integers only where needed.",
    promises: Promises {
        is_watertight: true,
        is_accurate: true,
        is_exact: true,
        is_translation_invariant: true,
    },
};

/// t of a ray's first hit of a primitive, correctly rounded, its part, and 0.
pub(super) fn answer<S: Pieces>(ray: &Ray, shape: &S) -> Option<[f64; 3]> {
    let mut solver = CrossingSolver::new(ray);
    let mut first = solver.first(shape)?;
    let t = solver.t_in_f64(shape, &mut first);
    Some([t, f64::from(first.part()), 0.0])
}

/// Tests one primitive. The hit's `primitive` is 0.
pub(super) fn intersect_one<S: Pieces>(ray: &Ray, shape: &S) -> Option<Hit> {
    let mut solver = CrossingSolver::new(ray);
    let mut first = solver.first(shape)?;
    Some(Hit {
        // Slightly below the largest f32, t may round to infinity.
        t: solver.t_in_f32(shape, &mut first).min(f32::MAX),
        u: f32::from(first.part()),
        v: 0.0,
        primitive: 0,
    })
}

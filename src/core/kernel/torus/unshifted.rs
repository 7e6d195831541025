//! Ray–torus test by the quartic equation from the ray's origin.
//!
//! Source: Hanrahan, "A Survey of Ray-Surface Intersection Algorithms", in Glassner (ed.), An Introduction to Ray
//!   Tracing, 1989.
//! Differs from it: roots are found by bisection between the derivative's roots.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions from a distance, where the coefficients grow with its fourth power and cancel.

use super::nearest_root;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, minus};
use crate::shape::Torus;

/// See the [module](self).
pub(super) struct Unshifted;

impl Kernel for Unshifted {
    type Shape = Torus;
    const IN_F32: KernelInfo = KernelInfo {
        name: "torus-unshifted",
        title: "Quartic",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Hanrahan, A Survey of Ray-Surface Intersection Algorithms, 1989",
        summary: "The textbook quartic; wrong from a distance.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "torus-unshifted-f64",
        title: "Quartic, f64",
        tier: None,
        precision: Precision::F64,
        summary: "The textbook quartic; good to 300 radii.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        tori: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let f = minus(&ray.origin, &tori.three(0));
        let zero = L::of(t_min.token(), 0.0);
        nearest_root(tori, &f, &ray.dir, zero, [t_min, t_max])
    }
}

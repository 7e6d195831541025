//! Ray–torus test by the quartic equation from the point nearest to the centre.
//!
//! Source: Wald, "Improving Numerical Precision in Intersection Programs", Ray Tracing Gems II, 2021, for the origin;
//!   Hanrahan, "A Survey of Ray-Surface Intersection Algorithms", 1989, for the quartic.
//! Differs from them: roots are found by bisection between the derivative's roots.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions about tubes that are thin relative to the major radius in f32.

use super::nearest_root;
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values, dot, minus, plus, times};
use crate::shape::Torus;

/// See the [module](self).
pub(super) struct Shifted;

impl Kernel for Shifted {
    type Shape = Torus;
    const IN_F32: KernelInfo = KernelInfo {
        name: "torus-shifted",
        title: "Moved quartic",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Wald, Improving Numerical Precision in Intersection Programs, 2021",
        summary: "The quartic with small coefficients at any distance.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "torus-shifted-f64",
        title: "Moved quartic, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Right at any distance but for grazing rays.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = SquaredRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &SquaredRay<L>,
        tori: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let f = minus(&ray.origin, &tori.three(0));
        let shift = -dot(&f, &ray.dir) / ray.dir_squared;
        let moved = plus(&f, &times(shift, &ray.dir));
        nearest_root(tori, &moved, &ray.dir, shift, [t_min, t_max])
    }
}

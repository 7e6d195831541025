//! Ray–quadric test from an origin moved to the point nearest to the box's centre.
//!
//! Source: Wald, "Improving Numerical Precision in Intersection Programs", Ray Tracing Gems II, 2021; Press et al.,
//!   Numerical Recipes, 1986, for the roots.
//! Differs from them: nothing.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for quadrics that are small in their box.

use super::{coefficients, offer};
use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values, dot, minus, plus, times};
use crate::shape::Quadric;

/// See the [module](self).
pub(super) struct Shifted;

impl Kernel for Shifted {
    type Shape = Quadric;
    const IN_F32: KernelInfo = KernelInfo {
        name: "quadric-shifted",
        title: "Moved origin",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Wald, Improving Numerical Precision in Intersection Programs, 2021",
        summary: "Accurate for small and distant quadrics.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "quadric-shifted-f64",
        title: "Moved origin, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 but for grazing rays.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = SquaredRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &SquaredRay<L>,
        quadrics: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let f = minus(&ray.origin, &quadrics.three(10));
        let shift = -dot(&f, &ray.dir) / ray.dir_squared;
        let moved = plus(&f, &times(shift, &ray.dir));
        let [a, b, c] = coefficients(quadrics, &moved, &ray.dir);
        let mut nearest = Nearest::new(t_min, t_max);
        let roots = Roots::press(a, b, c, b * b - a * c);
        offer(&mut nearest, &roots, quadrics, &moved, &ray.dir, shift);
        nearest.hit()
    }
}

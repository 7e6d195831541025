//! Ray–quadric test by the quadratic equation as textbooks write it.
//!
//! Source: Goldstein, Nagel, "3-D Visual Simulation", Simulation 16(1), 1971.
//! Differs from it: the surface is cut by a box.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for small or distant quadrics: b² and ac nearly cancel.

use super::{coefficients, offer};
use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, minus};
use crate::shape::Quadric;

/// See the [module](self).
pub(super) struct Naive;

impl Kernel for Naive {
    type Shape = Quadric;
    const IN_F32: KernelInfo = KernelInfo {
        name: "quadric-naive",
        title: "Quadratic equation",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Goldstein, Nagel, 3-D Visual Simulation, 1971",
        summary: "The textbook formula; wrong for small and distant quadrics.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "quadric-naive-f64",
        title: "Quadratic equation, f64",
        tier: None,
        precision: Precision::F64,
        summary: "The textbook formula in f64.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        quadrics: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let f = minus(&ray.origin, &quadrics.three(10));
        let [a, b, c] = coefficients(quadrics, &f, &ray.dir);
        let mut nearest = Nearest::new(t_min, t_max);
        let zero = L::of(a.token(), 0.0);
        offer(
            &mut nearest,
            &Roots::naive(a, b, c),
            quadrics,
            &f,
            &ray.dir,
            zero,
        );
        nearest.hit()
    }
}

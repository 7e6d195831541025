//! Ray–cone test by the quadratic equation as textbooks write it.
//!
//! Source: Goldstein, Nagel, "3-D Visual Simulation", Simulation 16(1), 1971.
//! Differs from it: any axis, by products with it.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for thin or distant cones: b² and ac nearly cancel.

use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::cylinder::{offer_cap, offer_side};
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus};
use crate::shape::{BASE, Cone};

/// See the [module](self).
pub(super) struct Naive;

impl Kernel for Naive {
    type Shape = Cone;
    const IN_F32: KernelInfo = KernelInfo {
        name: "cone-naive",
        title: "Quadratic equation",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Goldstein, Nagel, 3-D Visual Simulation, 1971",
        summary: "The textbook formula; wrong for thin and distant cones.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "cone-naive-f64",
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
        shapes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        // From the apex towards the base.
        let (apex, base) = (shapes.three(3), shapes.three(0));
        let (w, f) = (minus(&base, &apex), minus(&ray.origin, &apex));
        let (from, step) = (cross(&f, &w), cross(&ray.dir, &w));
        let along = [dot(&f, &w), dot(&ray.dir, &w)];
        let (length_squared, r) = (dot(&w, &w), shapes.value(6));
        let r_squared = r * r;
        let a = length_squared * dot(&step, &step) - r_squared * along[1] * along[1];
        let b = length_squared * dot(&from, &step) - r_squared * along[0] * along[1];
        let c = length_squared * dot(&from, &from) - r_squared * along[0] * along[0];
        let roots = Roots::naive(a, b, c);
        let mut nearest = Nearest::new(t_min, t_max);
        offer_side(&mut nearest, &roots, along, length_squared);
        let (across, reach) = ([&from, &step], r_squared * length_squared);
        let base = (BASE, length_squared);
        offer_cap(&mut nearest, shapes.value(7), across, along, base, reach);
        nearest.hit()
    }
}

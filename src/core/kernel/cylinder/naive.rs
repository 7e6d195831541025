//! Ray–cylinder test by the quadratic equation as textbooks write it.
//!
//! Source: Goldstein, Nagel, "3-D Visual Simulation", Simulation 16(1), 1971.
//! Differs from it: any axis, by cross products with it.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for thin or distant cylinders: b² and ac nearly cancel.

use super::{offer_cap, offer_side};
use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus};
use crate::shape::{BASE, Cylinder, TOP};

/// See the [module](self).
pub(super) struct Naive;

impl Kernel for Naive {
    type Shape = Cylinder;
    const IN_F32: KernelInfo = KernelInfo {
        name: "cylinder-naive",
        title: "Quadratic equation",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Goldstein, Nagel, 3-D Visual Simulation, 1971",
        summary: "The textbook formula; wrong for thin and distant cylinders.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "cylinder-naive-f64",
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
        let (p0, p1) = (shapes.three(0), shapes.three(3));
        let (w, f) = (minus(&p1, &p0), minus(&ray.origin, &p0));
        let (from, step) = (cross(&f, &w), cross(&ray.dir, &w));
        let length_squared = dot(&w, &w);
        let r = shapes.value(6);
        let reach = r * r * length_squared;
        let roots = Roots::naive(
            dot(&step, &step),
            dot(&from, &step),
            dot(&from, &from) - reach,
        );
        let along = [dot(&f, &w), dot(&ray.dir, &w)];
        let mut nearest = Nearest::new(t_min, t_max);
        offer_side(&mut nearest, &roots, along, length_squared);
        let (is_capped, zero) = (shapes.value(7), L::of(reach.token(), 0.0));
        for end in [(BASE, zero), (TOP, length_squared)] {
            offer_cap(&mut nearest, is_capped, [&from, &step], along, end, reach);
        }
        nearest.hit()
    }
}

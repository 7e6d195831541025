//! Ray–cylinder test without the cancellations of the quadratic equation.
//!
//! Source: the sphere's test of Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection",
//!   Ray Tracing Gems, 2019, in the plane across the axis.
//! Differs from it: origin and direction are replaced by their cross products with the axis.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions from far away along the axis, where the cross products round.

use super::{offer_cap, offer_side};
use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus};
use crate::shape::{BASE, Cylinder, TOP};

/// See the [module](self).
pub(super) struct Stable;

impl Kernel for Stable {
    type Shape = Cylinder;
    const IN_F32: KernelInfo = KernelInfo {
        name: "cylinder-stable",
        title: "Closest approach, Press",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Haines, Günther, Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, 2019",
        summary: "Accurate for thin and distant cylinders.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "cylinder-stable-f64",
        title: "Closest approach, Press, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 but for grazing rays.",
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
        let roots = Roots::at_distance(&from, &step, dot(&step, &step), reach);
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

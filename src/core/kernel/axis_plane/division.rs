//! Ray–plane test for planes that are perpendicular to an axis: a subtraction and a division.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022: t = (D − o_x)/d_x.
//! Differs from it: nothing.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a correctly rounded t: two operations are rounded.

use super::along;
use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values};
use crate::shape::AxisPlane;

/// See the [module](self).
pub(super) struct Division;

impl Kernel for Division {
    type Shape = AxisPlane;
    const IN_F32: KernelInfo = KernelInfo {
        name: "axis-plane-division",
        title: "Division",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "One subtraction and one division; the sign of t is right.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "axis-plane-division-f64",
        title: "Division, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "One subtraction, exact unless the coordinates differ by a factor above 2²⁹, and one division; t correct to the last place of f32.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        planes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let axis = planes.value(0);
        let distance = planes.value(1) - along(axis, ray.origin);
        let t = distance / along(axis, ray.dir);
        let mut nearest = Nearest::new(t_min, t_max);
        // Not if t is NaN: the ray lies in the plane.
        nearest.offer(t.le(t), t, 0);
        nearest.hit()
    }
}

//! Ray–plane test for planes that are perpendicular to an axis: a subtraction and a multiplication.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022: t = (D − o_x)/d_x.
//! Differs from it: the ray's inverse direction is computed once.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a correctly rounded t: three operations are rounded.

use super::along;
use crate::kernel::crossings::Nearest;
use crate::kernel::ray_lanes::InverseRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values};
use crate::shape::AxisPlane;

/// See the [module](self).
pub(super) struct Reciprocal;

impl Kernel for Reciprocal {
    type Shape = AxisPlane;
    const IN_F32: KernelInfo = KernelInfo {
        name: "axis-plane-reciprocal",
        title: "Reciprocal",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "One subtraction and one multiplication; one division per ray.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "axis-plane-reciprocal-f64",
        title: "Reciprocal, f64",
        tier: None,
        precision: Precision::F64,
        summary: "One subtraction and one multiplication.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = InverseRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &InverseRay<L>,
        planes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let axis = planes.value(0);
        let distance = planes.value(1) - along(axis, ray.origin);
        let t = distance * along(axis, ray.inverse);
        let mut nearest = Nearest::new(t_min, t_max);
        // Not if t is NaN: the ray lies in the plane.
        nearest.offer(t.le(t), t, 0);
        nearest.hit()
    }
}

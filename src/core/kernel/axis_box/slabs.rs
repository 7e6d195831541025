//! Ray–box test by slabs: a subtraction and a multiplication per plane.
//!
//! Source: Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; Lensch, Basic Geometry, lecture, 2022.
//! Differs from them: the last entry and the first exit of all pairs are compared, where the lecture's text compares
//!   those of one pair.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit of a box that is thin in the direction of the ray, or of an edge.

use super::InverseRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values};
use crate::shape::AxisBox;

/// See the [module](self).
pub(super) struct Slabs;

impl Kernel for Slabs {
    type Shape = AxisBox;
    const IN_F32: KernelInfo = KernelInfo {
        name: "axis-box-slabs",
        title: "Slabs",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Kay, Kajiya, Ray Tracing Complex Scenes, 1986",
        summary: "Three pairs of planes; one multiplication per plane.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "axis-box-slabs-f64",
        title: "Slabs, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Correct to the last place of f32 except at edges.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = InverseRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &InverseRay<L>,
        boxes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        ray.inside(boxes).hit(t_min, t_max, L::Number::from(0.0))
    }
}

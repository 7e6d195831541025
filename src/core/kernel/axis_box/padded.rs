//! Ray–box test by slabs that hits every box that the ray meets.
//!
//! Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013.
//! Differs from it: t is reported, not only whether there is a hit.
//! Promises: a hit wherever exact arithmetic finds one at a t inside the interval by more than 3u, relatively, if
//!   distances and inverses are normal numbers; u is 2⁻²⁴, in f64 2⁻⁵³.
//! Doesn't promise: a miss of a ray that passes an edge within 8u·|t|.
//!
//! An inverse, a difference and a product are each rounded by u, so that either end errs by 3u, and so does the sum that
//! moves the exit by u: 7u is less than 8u.

use super::InverseRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values};
use crate::shape::AxisBox;

/// See the [module](self).
pub(super) struct Padded;

impl Kernel for Padded {
    type Shape = AxisBox;
    const IN_F32: KernelInfo = KernelInfo {
        name: "axis-box-padded",
        title: "Padded slabs",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Ize, Robust BVH Ray Traversal, JCGT 2013",
        summary: "As slabs, with a padded exit, so that thin boxes and edges aren't missed.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "axis-box-padded-f64",
        title: "Padded slabs, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "As slabs in f64, with a padded exit; t correct to the last place of f32.",
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
        let slack = L::Number::from(8.0) * <L::Number as Number>::U;
        ray.inside(boxes).hit(t_min, t_max, slack)
    }
}

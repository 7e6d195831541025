//! Ray–plane test from a point and a normal.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022: 0 = n·(x − p).
//! Differs from it: nothing.
//! Promises: nothing beyond the measured figures; the distance of plane and origin is measured from the plane's point.
//! Doesn't promise: an accurate t for a ray that is nearly parallel to the plane.

use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, dot, minus};
use crate::shape::Plane;

/// See the [module](self).
pub(super) struct PointNormal;

impl Kernel for PointNormal {
    type Shape = Plane;
    const IN_F32: KernelInfo = KernelInfo {
        name: "plane-point-normal",
        title: "Point and normal",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Measures from a point of the plane: accurate near that point.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "plane-point-normal-f64",
        title: "Point and normal, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 but for nearly parallel rays.",
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
        let (point, normal) = (shapes.three(0), shapes.three(3));
        let distance = dot(&normal, &minus(&point, &ray.origin));
        let slope = dot(&normal, &ray.dir);
        // t is NaN or infinite if the ray is parallel.
        let t = distance / slope;
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer(t.le(t), t, 0);
        nearest.hit()
    }
}

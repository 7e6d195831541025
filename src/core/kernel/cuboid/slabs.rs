//! Ray–box test by slabs: the ray is inside while it is between the planes of all three pairs.
//!
//! Source: Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; Lensch, Basic Geometry, lecture, 2022.
//! Differs from them: boxes of any orientation; the last entry and the first exit of all pairs are compared, where the
//!   lecture's text compares those of one pair.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit of a box that is thin in the direction of the ray, or of an edge.

use super::{VALUES, bounds, pack};
use crate::aabb::Planes;
use crate::kernel::slabs::SlabInterval;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, dot, minus};
use crate::shape::Cuboid;

/// See the [module](self).
pub(super) struct Slabs;

impl Kernel for Slabs {
    type Shape = Cuboid;
    const IN_F32: KernelInfo = KernelInfo {
        name: "box-slabs",
        title: "Slabs",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Kay, Kajiya, Ray Tracing Complex Scenes, 1986",
        summary: "Three pairs of planes; two divisions per pair.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "box-slabs-f64",
        title: "Slabs, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 except at edges.",
        ..Self::IN_F32
    };
    const VALUES: usize = VALUES;
    type Stored<N: Number> = N;
    type Prepared<L: Lane> = RayLanes<L>;

    fn pack<N: Number>(cuboid: &Cuboid, values: &mut [N]) {
        pack(cuboid, values);
    }

    #[inline(always)]
    fn bounds<N: Number, L: Lane>(cuboids: &impl Values<L>) -> Planes<L> {
        bounds(cuboids)
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        cuboids: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let f = minus(&ray.origin, &cuboids.three(0));
        let one = L::of(t_min.token(), 1.0);
        let mut inside = SlabInterval::whole(one);
        for pair in 0..3 {
            let row = cuboids.three(3 + 3 * pair);
            let (at, step) = (dot(&row, &f), dot(&row, &ray.dir));
            inside.clip(pair as u8, (-one - at) / step, (one - at) / step, step);
        }
        inside.hit(t_min, t_max, L::Number::from(0.0))
    }
}

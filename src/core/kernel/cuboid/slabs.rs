//! Ray–box test by slabs: the ray is inside while it is between the planes of all three pairs.
//!
//! Source: Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; Lensch, Basic Geometry, lecture, 2022.
//! Differs from them: boxes of any orientation; the last entry and the first exit of all pairs are compared, where the
//!   lecture's text compares those of one pair.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit of a box that is thin in the direction of the ray, or of an edge.

use super::{VALUES, bounds, pack};
use crate::aabb::Planes;
use crate::kernel::crossings::Nearest;
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
        summary: "Correct to the last place of f32 but at edges.",
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
    fn prepare<L: Lane>(rays: &RayLanes<L>) -> RayLanes<L> {
        *rays
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
        let infinity = L::of(one.token(), f32::INFINITY);
        let (mut enter, mut leave) = (-infinity, infinity);
        let (mut entry, mut exit) = (L::of(one.token(), 0.0), L::of(one.token(), 0.0));
        let mut axis = 0;
        while axis < 3 {
            let row = cuboids.three(3 + 3 * axis);
            let (at, step) = (dot(&row, &f), dot(&row, &ray.dir));
            let low = (-one - at) / step;
            let high = (one - at) / step;
            let is_forward = low.lt(high);
            let (first, last) = (low.lesser(high), low.greater(high));
            let faces = [2 * axis as u8, 2 * axis as u8 + 1].map(|k| L::of(one.token(), k.into()));
            let [near_face, far_face] = [
                L::select(is_forward, faces[0], faces[1]),
                L::select(is_forward, faces[1], faces[0]),
            ];
            // A parallel ray between the planes gives −∞ and ∞; one outside gives two equal infinities.
            let (is_later, is_sooner) = (enter.lt(first), last.lt(leave));
            enter = L::select(is_later, first, enter);
            entry = L::select(is_later, near_face, entry);
            leave = L::select(is_sooner, last, leave);
            exit = L::select(is_sooner, far_face, exit);
            axis += 1;
        }
        let meets = enter.le(leave);
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer_face(meets, enter, entry);
        nearest.offer_face(meets, leave, exit);
        nearest.hit()
    }
}

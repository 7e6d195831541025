//! Ray–box test face by face: each is a plane, and the point's other two coordinates are compared with 1.
//!
//! Source: Haines, "Essential Ray Tracing Algorithms", in Glassner (ed.), An Introduction to Ray Tracing, 1989.
//! Differs from it: boxes of any orientation.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at an edge, where each of two faces may be missed.

use super::{VALUES, bounds, pack};
use crate::aabb::Planes;
use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, dot, minus};
use crate::shape::Cuboid;

/// See the [module](self).
pub(super) struct Faces;

impl Kernel for Faces {
    type Shape = Cuboid;
    const IN_F32: KernelInfo = KernelInfo {
        name: "box-faces",
        title: "Faces",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Haines, Essential Ray Tracing Algorithms, 1989",
        summary: "Six planes; thin boxes are hit.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "box-faces-f64",
        title: "Faces, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Six planes.",
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
        let rows = [cuboids.three(3), cuboids.three(6), cuboids.three(9)];
        let at = [dot(&rows[0], &f), dot(&rows[1], &f), dot(&rows[2], &f)];
        let step = [
            dot(&rows[0], &ray.dir),
            dot(&rows[1], &ray.dir),
            dot(&rows[2], &ray.dir),
        ];
        let mut nearest = Nearest::new(t_min, t_max);
        let mut axis = 0;
        while axis < 3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            for (side, place) in [-one, one].into_iter().enumerate() {
                let t = (place - at[axis]) / step[axis];
                let is_inside =
                    (at[j] + t * step[j]).abs().le(one) & (at[k] + t * step[k]).abs().le(one);
                nearest.offer(is_inside, t, (2 * axis + side) as u8);
            }
            axis += 1;
        }
        nearest.hit()
    }
}

//! Test of a disk or a rectangle: the plane first, then the point's coordinates in it.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022, whose first test of a triangle does the same.
//! Differs from it: disks and rectangles; the coordinates are measured by products with the half axes.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for distant or nearly parallel rays, whose point o + t·d is rounded.

use super::Outline;
use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus, plus, times};
use std::marker::PhantomData;

/// See the [module](self).
pub(super) struct PlaneFirst<S>(PhantomData<S>);

impl<S: Outline> Kernel for PlaneFirst<S> {
    type Shape = S;
    const IN_F32: KernelInfo = KernelInfo {
        name: S::NAMES.plane_first,
        title: "Plane first",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Plane first, then 2D; the point is rounded.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: S::NAMES.plane_first_f64,
        title: "Plane first, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Plane first, then 2D.",
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
        let [centre, u, v] = [shapes.three(0), shapes.three(3), shapes.three(6)];
        let normal = cross(&u, &v);
        let f = minus(&ray.origin, &centre);
        let t = -dot(&normal, &f) / dot(&normal, &ray.dir);
        let p = plus(&f, &times(t, &ray.dir));
        let a = dot(&normal, &cross(&p, &v));
        let b = dot(&normal, &cross(&u, &p));
        let is_inside = S::contains(a, b, dot(&normal, &normal));
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer(is_inside, t, 0);
        nearest.hit()
    }
}

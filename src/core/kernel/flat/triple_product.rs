//! Test of a disk or a rectangle by Cramer's rule, without the point of the plane.
//!
//! Source: Möller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
//! Differs from it: the coordinates are those of disks and rectangles.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions about rays that pass an edge closely.

use super::Outline;
use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus};
use std::marker::PhantomData;

/// See the [module](self).
pub(super) struct TripleProduct<S>(PhantomData<S>);

impl<S: Outline> Kernel for TripleProduct<S> {
    type Shape = S;
    const IN_F32: KernelInfo = KernelInfo {
        name: S::NAMES.triple_product,
        title: "Triple product",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Möller, Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997",
        summary: "Measures from the centre; accurate for distant rays.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: S::NAMES.triple_product_f64,
        title: "Triple product, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 but at edges.",
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
        // Cramer's rule for f = −t·d + a·u + b·v.
        let f = minus(&ray.origin, &centre);
        let p = cross(&ray.dir, &v);
        let det = dot(&u, &p);
        let q = cross(&f, &u);
        let t = dot(&v, &q) / det;
        let size = det.abs();
        let is_inside =
            S::contains(dot(&f, &p), dot(&ray.dir, &q), size) & L::of(t.token(), 0.0).lt(size);
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer(is_inside, t, 0);
        nearest.hit()
    }
}

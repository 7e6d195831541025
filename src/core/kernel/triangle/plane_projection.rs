//! Ray–triangle test that intersects the plane first, then computes barycentric coordinates in 2D.
//!
//! Source: H. Lensch, "Basic Geometry", lecture in computer graphics, Tübingen 2022, method (1); Badouel, "An
//!   Efficient Ray-Polygon Intersection", Graphics Gems, 1990. Everything that depends on the triangle alone
//!   is precomputed.
//! Differs from the lecture: the sign of the normal and the weights of B and C follow its figures, not its
//!   program; the plane's distance is measured from the corner A, because measured from the world's origin it
//!   cancels; no ε on t; the omitted coordinate is a 0 in a row.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at shared edges and vertices, because the point on the plane is rounded separately
//!   for each triangle.

use super::bounds;
use super::dominant_axis::{self, Rows};
use crate::aabb::Planes;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes};
use crate::lane::{Lane, LaneMask, Number, Values, dot, minus, times};
use crate::shape::Triangle;

/// Index of the box in the packed values.
const BOX: usize = 12;

/// See the [module](self).
pub(super) struct PlaneProjection;

impl Kernel for PlaneProjection {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "plane-projection",
        title: "Plane and projection",
        tier: None,
        precision: Precision::F32,
        source: "Badouel, An Efficient Ray-Polygon Intersection, Graphics Gems 1990",
        summary: "Plane first, then 2D; twice the memory; rays slip through edges and vertices.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "plane-projection-f64",
        title: "Plane and projection, f64",
        precision: Precision::F64,
        summary: "Plane first, then 2D; four times the memory.",
        ..Self::IN_F32
    };
    const VALUES: usize = BOX + bounds::VALUES;
    type Stored<N: Number> = N;
    type Prepared<L: Lane> = RayLanes<L>;

    fn pack<N: Number>(triangle: &Triangle, values: &mut [N]) {
        let Rows { u, v, normal, a } = dominant_axis::rows(triangle.0);
        for (row, kept) in [a, normal, u, v]
            .iter()
            .zip(values[..BOX].chunks_exact_mut(3))
        {
            kept.copy_from_slice(row);
        }
        bounds::pack(triangle.0, &mut values[BOX..]);
    }

    #[inline(always)]
    fn bounds<N: Number, L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
        bounds::kept(triangles, BOX)
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let (zero, one) = (L::of(t_min.token(), 0.0), L::of(t_min.token(), 1.0));

        // The plane: (o + t·d − A)·n = 0. The comparisons below reject NaN and infinity.
        let to_a = minus(&triangles.three(0), &ray.origin);
        let normal = triangles.three(3);
        let det = dot(&normal, &ray.dir);
        let t = dot(&normal, &to_a) / det;
        let ahead = zero.lt(det.abs()) & t_min.lt(t) & t.le(t_max);
        if !ahead.any() {
            return None;
        }

        // The point on the plane, relative to A, in 2D.
        let p = minus(&times(t, &ray.dir), &to_a);
        let u = dot(&triangles.three(6), &p);
        let v = dot(&triangles.three(9), &p);
        let mask = ahead & zero.le(u) & zero.le(v) & (u + v).le(one);
        LaneHit::certain(mask, t, u, v)
    }
}

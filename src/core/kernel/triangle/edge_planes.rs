//! Ray–triangle test against the three planes through the ray's origin and an edge.
//!
//! ```text
//!            C
//!           ╱ ╲          The direction lies inside the pyramid over the triangle if it is on the
//!          ╱ × ╲         same side of all three of its planes. For back faces the sides are
//!    o ···A─────B        swapped.
//! ```
//!
//! Source: H. Lensch, "Basic Geometry", lecture in computer graphics, Tübingen 2022, method (3).
//! Differs from the lecture: both sides hit; the planes' normals aren't normalised, which would give NaN if
//!   the origin lies on the line of an edge; the sign tested is that of d·n, because the point on the
//!   triangle's plane lies in the same direction.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at shared vertices (at shared edges none is lost, because both neighbours round the
//!   edge's normal alike); accuracy far from the triangle, because the normals grow with the square of the
//!   distance.

use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes};
use crate::lane::{Lane, LaneMask, Number, Values, cross, dot, minus};
use crate::shape::Triangle;

/// See the [module](self).
pub(super) struct EdgePlanes;

impl Kernel for EdgePlanes {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "edge-planes",
        title: "Edge planes",
        tier: None,
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "No ray slips through an edge, some through vertices; inaccurate for distant origins.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "edge-planes-f64",
        title: "Edge planes, f64",
        precision: Precision::F64,
        summary: "Accurate up to a distance of a million times the triangle's size.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let zero = L::of(t_min.token(), 0.0);
        let [a, b, c] = [
            minus(&triangles.three(0), &ray.origin),
            minus(&triangles.three(3), &ray.origin),
            minus(&triangles.three(6), &ray.origin),
        ];

        // Signed sides of the planes through BC, CA and AB; each is a weight times det.
        let w1 = dot(&ray.dir, &cross(&b, &c));
        let w2 = dot(&ray.dir, &cross(&c, &a));
        let w3 = dot(&ray.dir, &cross(&a, &b));
        let (least, most) = (w1.lesser(w2).lesser(w3), w1.greater(w2).greater(w3));
        let det = w1 + w2 + w3;
        let inside = (zero.le(least) | most.le(zero)) & zero.lt(det.abs());
        if !inside.any() {
            return None;
        }

        // The plane, from the triangle's own normal: the sum of the edge planes' normals cancels. The
        // comparison below rejects NaN and infinity.
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        let t = dot(&normal, &a) / dot(&normal, &ray.dir);
        let (u, v) = (w2 / det, w3 / det);
        let mask = inside & t_min.lt(t) & t.le(t_max) & zero.le(u) & zero.le(v);
        LaneHit::certain(mask, t, u, v)
    }
}

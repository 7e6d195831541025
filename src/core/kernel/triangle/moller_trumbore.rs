//! Ray–triangle test with the least arithmetic, from the triangle's edges.
//!
//! Source: Möller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
//! Differs from it: no ε on the determinant, because its magnitude scales with the triangle and the
//!   direction: only det = 0 is rejected; both sides hit; the divisions come last.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at shared edges and vertices (each neighbour rounds differently, so both may miss);
//!   in f32, hits of triangles with edges below about 1e-12 (det underflows).

use super::bounds;
use crate::aabb::Planes;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, LaneMask, Number, Values, cross, dot, minus};
use crate::shape::{Shape as _, Triangle};

/// See the [module](self).
pub(super) struct MollerTrumbore;

impl Kernel for MollerTrumbore {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "moller-trumbore",
        title: "Möller–Trumbore",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Möller, Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997",
        summary: "Fast; some rays slip through shared edges and vertices.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "moller-trumbore-f64",
        title: "Möller–Trumbore, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Accurate; rays aimed exactly at a vertex may still slip through.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    /// Packs A and two edges in f32; the corners in f64, as f32 can't hold the edges exactly.
    fn pack<N: Number>(triangle: &Triangle, values: &mut [f32]) {
        let [a, b, c] = triangle.0;
        if N::HOLDS_PRODUCTS {
            triangle.write(values);
        } else {
            Triangle([a, b - a, c - a]).write(values);
        }
    }

    #[inline(always)]
    fn bounds<N: Number, L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
        if N::HOLDS_PRODUCTS {
            Triangle::planes(triangles)
        } else {
            bounds::around_edges(triangles)
        }
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let zero = L::of(t_min.token(), 0.0);
        let [a, b, c] = [triangles.three(0), triangles.three(3), triangles.three(6)];
        let (e1, e2) = if L::Number::HOLDS_PRODUCTS {
            (minus(&b, &a), minus(&c, &a))
        } else {
            (b, c)
        };

        // Cramer's rule for o − A = −t·d + u·e1 + v·e2. det = 0 means that the ray is parallel to the plane.
        let p = cross(&ray.dir, &e2);
        let det = dot(&e1, &p);
        let s = minus(&ray.origin, &a);
        let u = dot(&s, &p).flip(det);
        let q = cross(&s, &e1);
        let v = dot(&ray.dir, &q).flip(det);
        let det_abs = det.abs();

        // Inside: u, v and 1 − u − v ≥ 0, here times |det|. A NaN fails every comparison.
        let inside = zero.le(u) & zero.le(v) & (u + v).le(det_abs) & zero.lt(det_abs);
        if !inside.any() {
            return None;
        }

        let t = dot(&e2, &q).flip(det) / det_abs;
        let mask = inside & t_min.lt(t) & t.le(t_max);
        LaneHit::certain(mask, t, u / det_abs, v / det_abs)
    }
}

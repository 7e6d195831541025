//! Ray–triangle test that two triangles sharing an edge can't both miss.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
//! Differs from it: no back-face culling; only the edge value that came out 0 is decided again in
//!   f64, lane by lane, so that a lane's answer doesn't depend on its neighbours; the weights are
//!   divided before they meet the depths, which are interpolated from A's.
//! Promises: watertight over shared edges and vertices, at any offset; in f32 for edges and distances
//!   from 1e-18 to 1e17 (so for meshes of 1e-15 to 1e16, seen from ten times as far), as beyond the product of two leaves its range. In f64, where no product of f32
//!   numbers does: t within 0.7 ulp of f32, and the right decision but for rays that pass an edge at
//!   less than some 2⁻⁵⁰ of their length.
//! Doesn't promise: in f32, accurate t and weights at the lower end of that, where the products are
//!   nearly subnormal; an answer for triangles of zero area (they are dropped at load); the right
//!   triangle of two where rounding the sheared vertices moves an edge across the ray; a hit beside the box
//!   of a needle that is seen along its length (see `bvh/slab.rs`; none was found).
//!
//! Why no ray slips through: a vertex is moved to 2D by the same operations whichever triangle it
//! belongs to, and the two neighbours of an edge compute its edge function from the same two points.
//!
//! ```text
//!      y     B          The edge function of AB is the signed area of A, B and the origin, where
//!      │    ╱│          the ray pierces the plane. Rounded, it keeps its sign or becomes 0, for
//!      │   ╱ │          rounding is monotone; 0 counts as inside for both neighbours.
//!      A──┼──┘ x        A fused multiply-add would break this: it rounds one product only.
//! ```

use super::bounds;
use super::shear::ShearedRay;
use crate::aabb::Planes;
use crate::kernel::{
    Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier, Values, pack_corners,
};
use crate::lane::{Lane, LaneMask, Number};
use glam::Vec3;

/// See the [module](self).
pub(super) struct Watertight;

impl Kernel for Watertight {
    const IN_F32: KernelInfo = KernelInfo {
        name: "watertight",
        title: "Watertight (Woop et al.)",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2013",
        summary: "No ray slips through a closed mesh from 1e-15 to 1e16 in size, at any offset.",
        promises: Promises {
            is_watertight: true,
            ..Promises::PLAIN
        },
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "watertight-f64",
        title: "Watertight, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Watertight, and t and weights right to f32's last place.",
        promises: Promises {
            is_accurate: true,
            ..Self::IN_F32.promises
        },
        ..Self::IN_F32
    };
    const VALUES: usize = 9;
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = ShearedRay<L>;

    fn pack<N: Number>(corners: [Vec3; 3], values: &mut [f32]) {
        pack_corners(corners, values);
    }

    #[inline(always)]
    fn bounds<N: Number, L: Lane>(triangles: &impl Values<L>) -> Planes<L> {
        bounds::around_corners(triangles)
    }

    #[inline(always)]
    fn prepare<L: Lane>(rays: &RayLanes<L>) -> ShearedRay<L> {
        ShearedRay::new(rays)
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &ShearedRay<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let zero = L::of(t_min.token(), 0.0);

        // Translate to the ray's origin, so that the edge tests see small numbers; then shear.
        let [a, b, c] = ray.sheared(triangles);

        // Edge functions: U belongs to A and lies opposite it, V to B, W to C.
        let mut u = c[0] * b[1] - c[1] * b[0];
        let mut v = a[0] * c[1] - a[1] * c[0];
        let mut w = b[0] * a[1] - b[1] * a[0];
        let mut inside = one_sign(u, v, w, zero);
        if !inside.any() {
            return None;
        }

        // A 0 may hide a sign that f64 knows: there the products of two f32 are exact. Only lanes at 0
        // are decided again, so that an answer doesn't depend on the neighbours.
        let any_zero = u.eq(zero) | v.eq(zero) | w.eq(zero);
        if (any_zero & inside).any() {
            let resolved = |edge: L, p: &[L; 3], q: &[L; 3]| {
                let wider = edge.widened([p[0], q[1], p[1], q[0]]);
                L::select(edge.eq(zero), wider, edge)
            };
            u = resolved(u, &c, &b);
            v = resolved(v, &a, &c);
            w = resolved(w, &b, &a);
            inside = one_sign(u, v, w, zero);
        }

        // det = 0: the triangle is seen edge-on. A NaN fails every comparison.
        let det = u + v + w;
        // Weights before depths: a product of three lengths would leave f32's range at 1e±13.
        let (l2, l3) = (v / det, w / det);
        let depth = a[2] + (l2 * (b[2] - a[2]) + l3 * (c[2] - a[2]));
        let t = depth / ray.dir_z();
        let mask = inside & zero.lt(det.abs()) & t_min.lt(t) & t.le(t_max);
        mask.any().then_some(LaneHit {
            mask,
            t,
            u: l2,
            v: l3,
        })
    }
}

/// Where the three aren't of both signs: the ray passes inside, or along the boundary.
#[inline(always)]
fn one_sign<L: Lane>(u: L, v: L, w: L, zero: L) -> L::Mask {
    zero.le(u.lesser(v).lesser(w)) | u.greater(v).greater(w).le(zero)
}

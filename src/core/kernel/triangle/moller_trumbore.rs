//! Ray–triangle test with the least arithmetic, from the triangle's edges.
//!
//! Source: Möller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
//! Differs from it: no ε on the determinant, whose size follows the triangle's and the direction's:
//!   only det = 0 is rejected; both sides hit; the divisions come last.
//! Promises: nothing beyond the figures that are measured.
//! Doesn't promise: an answer at shared edges and vertices (each neighbour rounds its own way, so
//!   that both may miss), nor for triangles whose edges are below some 1e-12 (det underflows).

use crate::kernel::{Corners, Kernel, KernelInfo, LaneHit, Tier};
use crate::lane::{Lane, LaneMask};
use crate::ray::Ray;

/// See the [module](self).
pub(super) struct MollerTrumbore;

/// The ray as it is, in every lane.
#[derive(Clone, Copy)]
pub(crate) struct Prepared<L> {
    origin: [L; 3],
    dir: [L; 3],
}

impl Kernel for MollerTrumbore {
    const INFO: KernelInfo = KernelInfo {
        name: "moller-trumbore",
        title: "Möller–Trumbore",
        tier: Some(Tier::Fast),
        source: "Möller, Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997",
        summary: "Fast; some rays slip through shared edges and vertices.",
        is_watertight: false,
    };
    type Prepared<L: Lane> = Prepared<L>;

    #[inline(always)]
    fn prepare<L: Lane>(token: L::Token, ray: &Ray) -> Prepared<L> {
        let splat = |v: [f32; 3]| v.map(|x| L::splat(token, x));
        Prepared {
            origin: splat(ray.origin.to_array()),
            dir: splat(ray.dir.to_array()),
        }
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &Prepared<L>,
        corners: &impl Corners<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let zero = L::splat(t_min.token(), 0.0);
        let [a, b, c] = [corner(corners, 0), corner(corners, 1), corner(corners, 2)];
        let (e1, e2) = (sub(&b, &a), sub(&c, &a));

        // Cramer's rule for o − A = −t·d + u·e1 + v·e2; det = 0: the ray is parallel to the plane.
        let p = cross(&ray.dir, &e2);
        let det = dot(&e1, &p);
        let s = sub(&ray.origin, &a);
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
        mask.any().then(|| LaneHit {
            mask,
            t,
            u: u / det_abs,
            v: v / det_abs,
        })
    }
}

#[inline(always)]
fn corner<L: Lane>(corners: &impl Corners<L>, corner: usize) -> [L; 3] {
    [
        corners.coordinate(corner, 0),
        corners.coordinate(corner, 1),
        corners.coordinate(corner, 2),
    ]
}

#[inline(always)]
fn sub<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross<L: Lane>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn dot<L: Lane>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

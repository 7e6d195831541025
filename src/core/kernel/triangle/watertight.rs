//! Ray–triangle test that two triangles sharing an edge can't both miss.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
//! Differs from it: no back-face culling; only the edge value that came out 0 is decided again in
//!   f64, lane by lane, so that a lane's answer doesn't depend on its neighbours; the weights are
//!   divided before they meet the depths, which are interpolated from A's.
//! Promises: watertight over shared edges and vertices, at any offset, for edges and distances
//!   from 1e-18 to 1e17: beyond, the product of two leaves f32's range.
//! Doesn't promise: accurate t and weights at the lower end of that, where the products are nearly
//!   subnormal; an answer for triangles of zero area (they are dropped at load); the right
//!   triangle of two where rounding the sheared vertices moves an edge across the ray.
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

use crate::kernel::{Corners, Kernel, KernelInfo, LaneHit, Tier};
use crate::lane::{Lane, LaneMask};
use crate::ray::Ray;

/// See the [module](self).
pub(super) struct Watertight;

/// The ray moved to the z axis by a permutation and a shear.
#[derive(Clone, Copy)]
pub(crate) struct Prepared<L> {
    /// Which coordinate becomes x, y and z; z is the direction's longest.
    axes: [usize; 3],
    /// The origin, its coordinates permuted.
    origin: [L; 3],
    /// d_x/d_z, d_y/d_z, d_z.
    shear: [L; 3],
}

impl Kernel for Watertight {
    const INFO: KernelInfo = KernelInfo {
        name: "watertight",
        title: "Watertight (Woop et al.)",
        tier: Some(Tier::Watertight),
        source: "Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2013",
        summary: "No ray slips through a closed mesh, at any offset, from 1e-15 to 1e16 in size.",
        is_watertight: true,
    };
    type Prepared<L: Lane> = Prepared<L>;

    #[inline(always)]
    fn prepare<L: Lane>(token: L::Token, ray: &Ray) -> Prepared<L> {
        let axes = axes_of(ray.dir.to_array());
        let lane = |x: f32| L::splat(token, x);
        let [dx, dy, dz] = axes.map(|axis| lane(ray.dir[axis]));
        Prepared {
            axes,
            origin: axes.map(|axis| lane(ray.origin[axis])),
            shear: [dx / dz, dy / dz, dz],
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

        // Translate to the ray's origin, so that the edge tests see small numbers; then shear.
        let [a, b, c] = [
            ray.to_ray_space(corners, 0),
            ray.to_ray_space(corners, 1),
            ray.to_ray_space(corners, 2),
        ];

        // Edge functions: U belongs to A and lies opposite it, V to B, W to C.
        let mut u = c[0] * b[1] - c[1] * b[0];
        let mut v = a[0] * c[1] - a[1] * c[0];
        let mut w = b[0] * a[1] - b[1] * a[0];
        let mut inside = one_sign(u, v, w, zero);
        if !inside.any() {
            return None;
        }

        // A 0 may hide a sign that f64 knows: there the products of two f32 are exact.
        let any_zero = u.eq(zero) | v.eq(zero) | w.eq(zero);
        if (any_zero & inside).any() {
            u = resolve_zero(u, &c, &b, zero);
            v = resolve_zero(v, &a, &c, zero);
            w = resolve_zero(w, &b, &a, zero);
            inside = one_sign(u, v, w, zero);
        }

        // det = 0: the triangle is seen edge-on. A NaN fails every comparison.
        let det = u + v + w;
        // Weights before depths: a product of three lengths would leave f32's range at 1e±13.
        let (l2, l3) = (v / det, w / det);
        let depth = a[2] + (l2 * (b[2] - a[2]) + l3 * (c[2] - a[2]));
        let t = depth / ray.shear[2];
        let mask = inside & zero.lt(det.abs()) & t_min.lt(t) & t.le(t_max);
        mask.any().then_some(LaneHit {
            mask,
            t,
            u: l2,
            v: l3,
        })
    }
}

impl<L: Lane> Prepared<L> {
    #[inline(always)]
    fn to_ray_space(self, corners: &impl Corners<L>, corner: usize) -> [L; 3] {
        let [x, y, z] = [
            corners.coordinate(corner, self.axes[0]) - self.origin[0],
            corners.coordinate(corner, self.axes[1]) - self.origin[1],
            corners.coordinate(corner, self.axes[2]) - self.origin[2],
        ];
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }
}

/// The direction's longest coordinate as z, the next two as x and y; swapped where z looks
/// backwards, which keeps the triangles' winding.
fn axes_of(dir: [f32; 3]) -> [usize; 3] {
    let size = dir.map(f32::abs);
    let z = if size[0] >= size[1] && size[0] >= size[2] {
        0
    } else if size[1] >= size[2] {
        1
    } else {
        2
    };
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    if dir[z] < 0.0 { [y, x, z] } else { [x, y, z] }
}

/// Where the three aren't of both signs: the ray passes inside, or along the boundary.
#[inline(always)]
fn one_sign<L: Lane>(u: L, v: L, w: L, zero: L) -> L::Mask {
    zero.le(u.lesser(v).lesser(w)) | u.greater(v).greater(w).le(zero)
}

/// The edge function of `p` and `q` from f64 products in the lanes where it came out 0.
#[inline(always)]
fn resolve_zero<L: Lane>(edge: L, p: &[L; 3], q: &[L; 3], zero: L) -> L {
    let resolved = L::map4_in_f64([p[0], q[1], p[1], q[0]], |[px, qy, py, qx]| {
        let exact = px * qy - py * qx;
        // The way back to f32 must not lose the sign again.
        if exact != 0.0 && exact.abs() < f64::from(f32::MIN_POSITIVE) {
            f64::from(f32::MIN_POSITIVE).copysign(exact)
        } else {
            exact
        }
    });
    L::select(edge.eq(zero), resolved, edge)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_axes_keep_the_winding_whichever_way_the_ray_looks() {
        for dir in [Vec3::X, Vec3::Y, Vec3::Z] {
            for sign in [1.0, -1.0] {
                let d = (dir * sign).to_array();
                let [x, y, z] = axes_of(d);
                let unit = |i: usize| {
                    Vec3::from_array(std::array::from_fn(|k| f32::from(u8::from(k == i))))
                };
                assert_eq!(unit(x).cross(unit(y)).dot(unit(z)), sign, "{d:?}");
            }
        }
    }

    #[test]
    fn a_zero_that_hides_a_sign_is_resolved_in_f64() {
        // 1e-30 · 1e-30 underflows in f32, not in f64.
        let (p, q) = ([1e-30f32, 0.0, 0.0], [0.0, 1e-30, 0.0]);
        let edge = p[0] * q[1] - p[1] * q[0];
        assert_eq!(edge, 0.0);
        assert_eq!(resolve_zero(edge, &p, &q, 0.0), f32::MIN_POSITIVE);
        assert_eq!(resolve_zero(edge, &q, &p, 0.0), -f32::MIN_POSITIVE);
    }
}

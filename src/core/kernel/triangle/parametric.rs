//! Ray–triangle test that intersects the plane first, then computes the point's two parameters.
//!
//! Source: H. Lensch, "Basic Geometry", lecture in computer graphics, Tübingen 2022, method (2).
//! Differs from the lecture: P = A + α(B − A) + β(C − A); its slide omits A. The lecture doesn't say how to
//!   solve for α and β; here they are ratios of areas: with n the normal, α = n·((P − A)×(C − A))/n·n.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at shared edges and vertices.

use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes};
use crate::lane::{Lane, LaneMask, Number, Values, cross, dot, minus, times};
use crate::shape::Triangle;

/// See the [module](self).
pub(super) struct Parametric;

impl Kernel for Parametric {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "parametric",
        title: "Parametric",
        tier: None,
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Plane first, then parameters in 3D; rays slip through edges and vertices.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "parametric-f64",
        title: "Parametric, f64",
        precision: Precision::F64,
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
        let (zero, one) = (L::of(t_min.token(), 0.0), L::of(t_min.token(), 1.0));
        let [a, b, c] = [triangles.three(0), triangles.three(3), triangles.three(6)];
        let (e1, e2) = (minus(&b, &a), minus(&c, &a));
        let normal = cross(&e1, &e2);

        // The plane: (o + t·d − A)·n = 0. The comparisons below reject NaN and infinity.
        let to_a = minus(&a, &ray.origin);
        let det = dot(&normal, &ray.dir);
        let t = dot(&normal, &to_a) / det;
        let ahead = zero.lt(det.abs()) & t_min.lt(t) & t.le(t_max);
        if !ahead.any() {
            return None;
        }

        // Scale one of the two normals to about 1: n·n, the fourth power of a length, would leave the range
        // of f32 at lengths of 1e±10.
        let longest = normal[0]
            .abs()
            .greater(normal[1].abs())
            .greater(normal[2].abs());
        let scaled = times(one / longest, &normal);
        let area = dot(&scaled, &normal);
        let p = minus(&times(t, &ray.dir), &to_a);
        let u = dot(&scaled, &cross(&p, &e2)) / area;
        let v = dot(&scaled, &cross(&e1, &p)) / area;
        let mask = ahead & zero.le(u) & zero.le(v) & (u + v).le(one);
        LaneHit::certain(mask, t, u, v)
    }
}

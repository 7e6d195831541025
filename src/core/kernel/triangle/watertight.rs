//! Ray–triangle test whose hits and misses match exact arithmetic, so that no ray passes through a closed
//! mesh. t and the weights have the accuracy of f32 or f64.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
//! Differs from it: no back-face culling. A triangle is tested again in f64, and in integers if f64 can't
//!   decide, if an edge function or t lies within its error bound of a change of the decision, or if t's
//!   error bound exceeds [`Number::T_SLACK`]. The bounds are those of `exact::filter`.
//! Promises: hit or miss and `t_min < t < t_max` as in exact arithmetic, for any finite ray and triangle; the
//!   reported t also lies in the interval. So it is watertight over shared edges and vertices. In f32, the
//!   relative error of t is at most 513u (u = 2⁻²⁴; measured: a hundredth of that). In f64, t errs by at most
//!   0.51 ulp of f32 and a weight by at most 1.02·2⁻²⁵.
//! Doesn't promise: the order of two hits whose t differ by less than these errors; the lowest of several
//!   triangles at equal t; accurate weights in f32; hits through a tree whose boxes lie at distances that
//!   aren't normal f32 numbers (see `bvh::slab`).
//!
//! The paper's test alone isn't enough: neighbours agree about their common edge, but a wrong sign assigns
//! the ray to the wrong neighbour. If the computed t places that neighbour behind the ray's origin, or if the
//! ray misses its box, both triangles are missed.

use super::exact::{self, DepthInterval, filter};
use super::shear::ShearedRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, LaneMask, Number, Values};
use crate::ray::Ray;
use crate::shape::{Shape as _, Triangle};

/// See the [module](self).
pub(super) struct Watertight;

/// A ray prepared for many tests.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay<L> {
    sheared: ShearedRay<L>,
    interval: DepthInterval<L>,
}

impl<L: Lane> From<RayLanes<L>> for PreparedRay<L> {
    #[inline(always)]
    fn from(rays: RayLanes<L>) -> Self {
        let sheared = ShearedRay::new(&rays);
        Self {
            sheared,
            interval: DepthInterval::new(&rays, &sheared),
        }
    }
}

impl Kernel for Watertight {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "watertight",
        title: "Watertight (Woop et al.)",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2013",
        summary: "Every hit and miss is correct, so no ray slips through a closed mesh.",
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
        summary: "Watertight; t and barycentric coordinates correct to the last place of f32.",
        promises: Promises {
            is_accurate: true,
            ..Self::IN_F32.promises
        },
        ..Self::IN_F32
    };
    const IS_ADAPTIVE: bool = true;
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = PreparedRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &PreparedRay<L>,
        triangles: &impl Values<L>,
        _: L,
        limit: L,
    ) -> Option<LaneHit<L>> {
        let found = filter(&ray.sheared, triangles)?;
        let (near, far) = (found.near(), found.far());

        // Hits before the interval, or behind the nearest hit so far, don't count even if other decisions are
        // open.
        let is_outside = far.lt(ray.interval.earliest) | ray.interval.deepest(limit).lt(near);
        let is_possible = !(found.missed | is_outside);
        if !is_possible.any() {
            return None;
        }

        // Whether a lane is doubtful depends only on ray and triangle, not on other hits.
        let is_within = ray.interval.contains(near, far);
        let is_known = found.certain & is_within & found.is_accurate();
        let t = found.depth / ray.interval.per_t;
        Some(LaneHit {
            mask: is_possible & is_known & t.le(limit),
            doubtful: is_possible & !is_known,
            t,
            u: found.weights[0],
            v: found.weights[1],
        })
    }

    fn decide<N: Number>(ray: &Ray, triangle: &impl Values<f32>) -> Option<[N; 3]> {
        let [t, u, v] = exact::answer_for::<N>(ray, Triangle::read(triangle).0)?.map(N::of_f64);
        // The hit lies inside the interval, but rounding may have moved it to an end.
        let [start, end] = ray.finite_interval().map(N::from);
        Some([t.greater(start.next_up()).lesser(end.next_down()), u, v])
    }
}

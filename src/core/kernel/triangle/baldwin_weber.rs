//! Ray–triangle test with a stored affine map that takes the triangle to (0, 0), (1, 0), (0, 1) in a plane.
//!
//! Source: Baldwin, Weber, "Fast Ray-Triangle Intersections by Coordinate Transformation",
//!   JCGT 5(3), 2016.
//! Differs from it: the map's trivial column is stored, because its position differs among the triangles of a
//!   SIMD block.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: a hit at shared edges and vertices; in f32, accuracy far from the world's origin, because
//!   the map's translation is rounded there. A mesh at a distance of a thousand times its size is full of
//!   holes.

use super::bounds;
use super::dominant_axis::{self, Rows};
use crate::aabb::Planes;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes};
use crate::lane::{Lane, LaneMask, Number, Values, dot, plus, times};
use crate::shape::Triangle;

/// Index of the box in the packed values.
const BOX: usize = 12;

/// See the [module](self).
pub(super) struct BaldwinWeber;

impl Kernel for BaldwinWeber {
    type Shape = Triangle;
    const IN_F32: KernelInfo = KernelInfo {
        name: "baldwin-weber",
        title: "Baldwin–Weber",
        tier: None,
        precision: Precision::F32,
        source: "Baldwin, Weber, Fast Ray-Triangle Intersections by Coordinate Transformation, JCGT 2016",
        summary: "The least arithmetic per test, twice the memory; useless far from (0, 0, 0).",
        promises: Promises {
            is_translation_invariant: false,
            ..Promises::PLAIN
        },
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "baldwin-weber-f64",
        title: "Baldwin–Weber, f64",
        precision: Precision::F64,
        summary: "Little arithmetic, four times the memory.",
        ..Self::IN_F32
    };
    const VALUES: usize = BOX + bounds::VALUES;
    type Stored<N: Number> = N;
    type Prepared<L: Lane> = RayLanes<L>;

    fn pack<N: Number>(triangle: &Triangle, values: &mut [N]) {
        let Rows { u, v, normal, a } = dominant_axis::rows(triangle.0);
        for (row, kept) in [normal, u, v].iter().zip(values[..BOX].chunks_exact_mut(4)) {
            kept[..3].copy_from_slice(row);
            kept[3] = -dot(row, &a);
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

        // In the triangle's space its plane is z = 0. The comparisons below reject NaN and infinity.
        let det = dot(&triangles.three(0), &ray.dir);
        let t = -moved(triangles, 0, &ray.origin) / det;
        let ahead = zero.lt(det.abs()) & t_min.lt(t) & t.le(t_max);
        if !ahead.any() {
            return None;
        }

        let p = plus(&ray.origin, &times(t, &ray.dir));
        let (u, v) = (moved(triangles, 4, &p), moved(triangles, 8, &p));
        let mask = ahead & zero.le(u) & zero.le(v) & (u + v).le(one);
        LaneHit::certain(mask, t, u, v)
    }
}

/// A row of the map applied to a point.
#[inline(always)]
fn moved<L: Lane>(triangles: &impl Values<L>, row: usize, p: &[L; 3]) -> L {
    dot(&triangles.three(row), p) + triangles.value(row + 3)
}

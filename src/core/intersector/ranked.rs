//! Method for kernels that decide about each primitive separately. Hits are ranked by their computed t.

use super::RankedHit;
use super::blocks::{BlockValues, Blocks, LaneOf, Row, boxes, can_be_hit, may_meet};
use super::levels::Levels;
use super::method::{BlocksOf, Method, Tester};
use super::order::{Comparison, precedes};
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, SlabRay, rank, rank_floor};
use crate::kernel::{Kernel, RayLanes};
use crate::lane::{Lane, LaneMask, Number};
use crate::ray::{Hit, Ray};
use crate::shape::{EmptyLanes, Shape as _};
use fearless_simd::Simd;
use std::cmp::Ordering;
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// Ranks hits of the kernel `K`, which computes in `N`, with code for the levels `V`.
pub(super) struct Ranked<K, N, V>(PhantomData<(K, N, V)>);

/// A hit as computed by the kernel, or the end of the ray.
#[derive(Clone, Copy)]
pub(super) struct Found<N> {
    /// The sort key of the hit: t, but no nearer than the primitive's box allows.
    pub rank: N,
    pub t: N,
    pub u: N,
    pub v: N,
    pub primitive: u32,
}

impl<N: Number> Found<N> {
    /// No hit; only hits ranked before `end` precede it.
    #[inline(always)]
    fn nothing(end: N) -> Self {
        Self {
            rank: end,
            t: -end,
            u: end,
            v: end,
            primitive: NO_PRIMITIVE,
        }
    }

    #[inline(always)]
    fn is_before(&self, other: &Self) -> bool {
        let compared = |a: N, b: N| Comparison {
            is_less: a < b,
            is_equal: a == b,
        };
        precedes(
            compared(self.rank, other.rank),
            compared(self.t, other.t),
            self.primitive < other.primitive,
        )
    }

    #[inline(always)]
    fn hit(&self) -> Hit {
        Hit {
            t: self.t.to_f32(),
            u: self.u.to_f32(),
            v: self.v.to_f32(),
            primitive: self.primitive,
        }
    }
}

impl<K: Kernel, N: Number, V: Levels> Method for Ranked<K, N, V> {
    type Shape = K::Shape;
    type Stored = K::Stored<N>;
    const VALUES: usize = K::VALUES;
    type Levels = V;
    const EMPTY: EmptyLanes = if K::IS_ADAPTIVE {
        EmptyLanes::First
    } else {
        EmptyLanes::Nowhere
    };
    type Found = Found<N>;
    type Tester<'a, S: Simd> = RankedTester<'a, K, N, S>;
    type Batch = ();

    fn pack(shape: &K::Shape, values: &mut [K::Stored<N>]) {
        K::pack::<N>(shape, values);
    }

    #[inline(always)]
    fn tester<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        ray: &'a Ray,
        scratch: &'a mut [Row<K::Stored<N>>],
    ) -> RankedTester<'a, K, N, S> {
        RankedTester {
            token,
            blocks,
            scratch,
            prepared: K::Prepared::from(RayLanes::of(token, ray)),
            t_min: Lane::of(token, ray.t_min),
            end: N::from(ray.t_max),
            ray,
        }
    }

    fn batch() {}

    #[inline(always)]
    fn keep<S: Simd>(
        _: &mut Self::Tester<'_, S>,
        nearest: Found<N>,
        index: usize,
        hits: &mut [Option<Hit>],
        _: &mut (),
    ) {
        hits[index] = Some(nearest.hit());
    }
}

/// Tests one ray.
pub(super) struct RankedTester<'a, K: Kernel, N: Number, S: Simd> {
    token: S,
    blocks: &'a Blocks<K::Shape, K::Stored<N>>,
    scratch: &'a mut [Row<K::Stored<N>>],
    prepared: K::Prepared<N::Lanes<S>>,
    t_min: N::Lanes<S>,
    end: N,
    ray: &'a Ray,
}

impl<K: Kernel, N: Number, S: Simd> RankedTester<'_, K, N, S> {
    /// Passes each hit in a block whose rank is at most `limit` to `found`, until that breaks.
    #[inline(always)]
    fn test<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        limit: N,
        mut found: impl FnMut(Found<N>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let rows =
            (self.blocks).rows::<MAYBE_COMPACT>(block, K::VALUES, self.scratch, K::pack::<N>);
        if K::IS_FILTERED
            && N::HOLDS_PRODUCTS
            && may_meet::<K::Shape, _, S>(self.token, rows, self.ray) == 0
        {
            return ControlFlow::Continue(());
        }
        let values = BlockValues::<N, S, _>::new(self.token, rows);
        let t_max = Lane::splat(self.token, limit);
        let Some(hit) = K::intersect(&self.prepared, &values, self.t_min, t_max) else {
            return ControlFlow::Continue(());
        };
        // Hits outside the primitive's own box don't count.
        let boxes = boxes::<K, N, S>(self.token, rows);
        let infinity = Lane::splat(self.token, f32::INFINITY);
        let (entries, met) = slabs.enter::<IS_BEHIND>(self.token, &boxes, infinity);
        let (t, u, v) = (N::store(hit.t), N::store(hit.u), N::store(hit.v));
        let primitives = self.blocks.bvh.lanes(block);
        let doubtful = LaneMask::bits(hit.doubtful);
        let mut lanes = (LaneMask::bits(hit.mask) | doubtful) & met;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK_SIZE;
            lanes &= lanes - 1;
            let primitive = primitives[lane];
            let [t, u, v] = if K::IS_ADAPTIVE && doubtful >> lane & 1 == 1 {
                match decide::<K, N>(self.ray, rows, primitive, lane) {
                    Some(hit) => hit,
                    None => continue,
                }
            } else {
                [t[lane], u[lane], v[lane]]
            };
            let floor = N::from(rank_floor(entries[lane]));
            let rank = rank(t, floor);
            // Hits beyond the largest finite f32, ahead or behind, are misses.
            if rank < self.end && t.to_f32().is_finite() && can_be_hit(primitive, self.ray.exclude)
            {
                found(Found {
                    rank,
                    t,
                    u,
                    v,
                    primitive,
                })?;
            }
        }
        ControlFlow::Continue(())
    }

    /// As [`test`](Self::test), for any interval and packing.
    // Compiled once for all callers.
    #[inline(never)]
    fn test_rarely(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        limit: N,
        found: &mut dyn FnMut(Found<N>),
    ) {
        _ = self.test::<true, true>(block, slabs, limit, |hit| {
            found(hit);
            ControlFlow::Continue(())
        });
    }
}

/// t, u and v of a hit that the kernel left doubtful.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
fn decide<K: Kernel, N: Number>(
    ray: &Ray,
    rows: &[Row<K::Stored<N>>],
    primitive: u32,
    lane: usize,
) -> Option<[N; 3]> {
    can_be_hit(primitive, ray.exclude).then(|| K::decide(ray, &LaneOf { rows, lane }))?
}

impl<K: Kernel, N: Number, S: Simd> Tester<S> for RankedTester<'_, K, N, S> {
    type Found = Found<N>;
    type Nearest = Found<N>;

    #[inline(always)]
    fn nothing(&self) -> Found<N> {
        Found::nothing(self.end)
    }

    #[inline(always)]
    fn nearest<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        nearest: &mut Found<N>,
    ) {
        let limit = nearest.rank;
        let mut keep = |hit: Found<N>| {
            if hit.is_before(nearest) {
                *nearest = hit;
            }
        };
        if IS_BEHIND {
            self.test_rarely(block, slabs, limit, &mut keep);
        } else {
            _ = self.test::<false, MAYBE_COMPACT>(block, slabs, limit, |hit| {
                keep(hit);
                ControlFlow::Continue(())
            });
        }
    }

    #[inline(always)]
    fn farthest(&self, nearest: &Found<N>) -> f32 {
        nearest.rank.to_f32()
    }

    #[inline(always)]
    fn found(&self, nearest: &Found<N>) -> Option<Found<N>> {
        (nearest.primitive != NO_PRIMITIVE).then_some(*nearest)
    }

    #[inline(always)]
    fn any<const MAYBE_COMPACT: bool>(&mut self, block: usize, slabs: &SlabRay<S>) -> bool {
        let end = self.end;
        self.test::<false, MAYBE_COMPACT>(block, slabs, end, |_| ControlFlow::Break(()))
            .is_break()
    }

    fn all(&mut self, block: usize, slabs: &SlabRay<S>, found: &mut Vec<Found<N>>) {
        let (end, t_min) = (self.end, self.t_min);
        // Each round finds the next crossing of each primitive.
        for round in 0..K::Shape::MOST_CROSSINGS {
            let (first, mut starts) = (found.len(), [end; BLOCK_SIZE]);
            let primitives = *self.blocks.bvh.lanes(block);
            self.test_rarely(block, slabs, end, &mut |hit| {
                let lane = primitives.iter().position(|&p| p == hit.primitive);
                starts[lane.unwrap_or(0)] = hit.t;
                found.push(hit);
            });
            if found.len() == first || round + 1 == K::Shape::MOST_CROSSINGS {
                break;
            }
            self.t_min = N::gather(self.token, starts);
        }
        self.t_min = t_min;
    }

    #[inline(always)]
    fn count(&mut self, block: usize) -> usize {
        let rows = (self.blocks).rows::<true>(block, K::VALUES, self.scratch, K::pack::<N>);
        let values = BlockValues::<N, S, _>::new(self.token, rows);
        let t_max = Lane::splat(self.token, self.end);
        let Some(hit) = K::intersect(&self.prepared, &values, self.t_min, t_max) else {
            return 0;
        };
        let [certain, doubtful] = [hit.mask, hit.doubtful].map(LaneMask::bits);
        let mut count = 0;
        for lane in 0..self.blocks.bvh.block(block).len() {
            let is_hit = certain >> lane & 1 == 1
                || (K::IS_ADAPTIVE
                    && doubtful >> lane & 1 == 1
                    && K::decide::<N>(self.ray, &LaneOf { rows, lane }).is_some());
            count += usize::from(is_hit);
        }
        count
    }

    fn compare(&mut self, first: &mut Found<N>, second: &mut Found<N>) -> Ordering {
        // No hit's t is NaN.
        let order = first.t.partial_cmp(&second.t);
        order.unwrap_or(Ordering::Equal)
    }

    fn primitive(found: &Found<N>) -> u32 {
        found.primitive
    }

    fn hit(&mut self, found: Found<N>) -> Hit {
        found.hit()
    }

    fn ranked(&mut self, found: Found<N>) -> RankedHit {
        RankedHit {
            hit: found.hit(),
            t: [found.t.into(); 2],
            exact: None,
            is_tangent: false,
        }
    }

    #[inline(always)]
    fn announce<const MAYBE_COMPACT: bool>(&self, block: usize) {
        (self.blocks).announce::<MAYBE_COMPACT, S>(self.token, block, K::VALUES);
    }
}

//! Visitors that test blocks with kernels that decide about each triangle separately.

use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, SlabRay, Visitor, rank, rank_floor};
use crate::intersector::Cost;
use crate::intersector::blocks::{BlockValues, Blocks, Row, Scratch, boxes, can_be_hit, corners};
use crate::kernel::Kernel;
use crate::lane::{Lane, LaneMask, Number};
use crate::ray::{Hit, Ray};
use fearless_simd::Simd;
use std::ops::ControlFlow;

/// A hit as computed by the kernel.
#[derive(Clone, Copy)]
pub(super) struct Found<N> {
    /// The sort key of the hit: t, but no nearer than the triangle's box allows.
    pub rank: N,
    pub t: N,
    pub u: N,
    pub v: N,
    pub primitive: u32,
}

impl<N: Number> Found<N> {
    /// No hit; only hits ranked before `end` precede it.
    #[inline(always)]
    pub fn nothing(end: N) -> Self {
        Self {
            rank: end,
            t: -end,
            u: end,
            v: end,
            primitive: NO_PRIMITIVE,
        }
    }

    #[inline(always)]
    pub fn is_before(&self, other: &Self) -> bool {
        self.rank < other.rank
            || (self.rank == other.rank
                && other.primitive != NO_PRIMITIVE
                && (self.t, self.primitive) < (other.t, other.primitive))
    }

    #[inline(always)]
    pub fn hit(&self) -> Option<Hit> {
        (self.primitive != NO_PRIMITIVE).then_some(Hit {
            t: self.t.to_f32(),
            u: self.u.to_f32(),
            v: self.v.to_f32(),
            primitive: self.primitive,
        })
    }
}

/// Tests one ray against blocks.
pub(super) struct Tester<'a, K: Kernel, N: Number, S: Simd> {
    pub token: S,
    pub blocks: &'a Blocks<K::Stored<N>>,
    pub scratch: &'a mut Scratch<K::Stored<N>>,
    pub prepared: K::Prepared<N::Lanes<S>>,
    pub t_min: N::Lanes<S>,
    pub end: N,
    pub ray: Ray,
}

impl<K: Kernel, N: Number, S: Simd> Tester<'_, K, N, S> {
    /// Passes each hit in a block whose rank is at most `limit` to `found`, until that breaks. For
    /// `IS_BEHIND` see [`SlabRay::enter`], for `MAYBE_COMPACT` see [`Blocks::rows`].
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
        let values = BlockValues::<N, S, _>::new(self.token, rows);
        let t_max = Lane::splat(self.token, limit);
        let Some(hit) = K::intersect(&self.prepared, &values, self.t_min, t_max) else {
            return ControlFlow::Continue(());
        };
        // Hits outside the triangle's own box don't count.
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
                match decide::<K, N>(&self.ray, rows, primitive, lane) {
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

    #[inline(always)]
    fn announce<const MAYBE_COMPACT: bool>(&self, block: usize) {
        (self.blocks).announce::<MAYBE_COMPACT, S>(self.token, block, K::VALUES);
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
    can_be_hit(primitive, ray.exclude).then(|| K::decide(ray, corners(rows, lane)))?
}

/// Finds the nearest hit.
pub(super) struct Nearest<'a, K: Kernel, N: Number, S: Simd, const MAYBE_COMPACT: bool> {
    pub tester: Tester<'a, K, N, S>,
    pub best: Found<N>,
}

impl<K: Kernel, N: Number, S: Simd, const MAYBE_COMPACT: bool> Visitor<S>
    for Nearest<'_, K, N, S, MAYBE_COMPACT>
{
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        let limit = self.best.rank;
        let best = &mut self.best;
        _ = self
            .tester
            .test::<false, MAYBE_COMPACT>(block, slabs, limit, |hit| {
                if hit.is_before(best) {
                    *best = hit;
                }
                ControlFlow::Continue(())
            });
        ControlFlow::Continue(self.best.rank.to_f32())
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce::<MAYBE_COMPACT>(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// Finds any hit. Visits the nearest child first, too: in any other order random rays take a twentieth longer
/// (1.1 M triangles, 2026-11).
pub(super) struct Any<'a, K: Kernel, N: Number, S: Simd, const MAYBE_COMPACT: bool> {
    pub tester: Tester<'a, K, N, S>,
    pub t_max: f32,
    pub is_hit: bool,
}

impl<K: Kernel, N: Number, S: Simd, const MAYBE_COMPACT: bool> Visitor<S>
    for Any<'_, K, N, S, MAYBE_COMPACT>
{
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        let is_hit = &mut self.is_hit;
        let end = self.tester.end;
        self.tester
            .test::<false, MAYBE_COMPACT>(block, slabs, end, |_| {
                *is_hit = true;
                ControlFlow::Break(())
            })?;
        ControlFlow::Continue(self.t_max)
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce::<MAYBE_COMPACT>(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// Passes hits to a closure and counts their cost. For rarer queries, and for rays whose interval starts
/// behind their origin.
pub(super) struct Each<'a, 'f, K: Kernel, N: Number, S: Simd> {
    pub tester: Tester<'a, K, N, S>,
    pub limit: N,
    /// Returns the farthest rank of interest.
    pub found: &'f mut dyn FnMut(Found<N>) -> ControlFlow<(), N>,
    pub cost: Cost,
}

impl<K: Kernel, N: Number, S: Simd> Visitor<S> for Each<'_, '_, K, N, S> {
    const IS_BEHIND: bool = true;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        self.cost.triangles += self.tester.blocks.bvh.block(block).len() as u32;
        let limit = &mut self.limit;
        let found = &mut self.found;
        self.tester
            .test::<true, true>(block, slabs, *limit, |hit| {
                *limit = found(hit)?;
                ControlFlow::Continue(())
            })?;
        ControlFlow::Continue(self.limit.to_f32())
    }

    #[inline(always)]
    fn announce(&self, _: usize) {}

    #[inline(always)]
    fn count_boxes(&mut self, count: u32) {
        self.cost.boxes += count;
    }
}

//! A mesh, packed for a kernel that decides about each triangle by itself.

use super::blocks::{Blocks, candidates, is_asked};
use super::{Cost, Crossing, Intersector, answer_behind, is_behind};
use crate::bvh::{BLOCK_SIZE, Bvh, NO_PRIMITIVE, SlabRay, Stack, Visitor, rank_floor, with_stack};
use crate::kernel::{Kernel, KernelInfo, RayLanes};
use crate::lane::{Lane, LaneMask, Number, PACKET, Stored};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::simd::{SimdLevel, baseline};
use fearless_simd::{Simd, dispatch};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Triangles for the kernel `K`, working in `N`.
pub(crate) struct MeshIntersector<K: Kernel, N: Number> {
    pub(super) blocks: Blocks<K::Stored<N>>,
    pub(super) level: SimdLevel,
    pub(super) kernel: &'static KernelInfo,
    /// How to trace rays that go together; not for every kernel, as that is each one's code once more.
    pub(super) packets: Option<Packets<K, N>>,
}

type Packets<K, N> = fn(&MeshIntersector<K, N>, &[Ray], &mut [Option<Hit>]);

/// A hit as the kernel computed it.
#[derive(Clone, Copy)]
struct Found<N> {
    /// What it is ordered by: t, or what its own box's entry allows.
    rank: N,
    t: N,
    u: N,
    v: N,
    primitive: u32,
}

impl<N: Number> Found<N> {
    /// No hit: none that lies at or behind `end` comes before it.
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
        self.rank < other.rank
            || (self.rank == other.rank
                && other.primitive != NO_PRIMITIVE
                && (self.t, self.primitive) < (other.t, other.primitive))
    }

    #[inline(always)]
    fn hit(&self) -> Option<Hit> {
        (self.primitive != NO_PRIMITIVE).then_some(Hit {
            t: self.t.to_f32(),
            u: self.u.to_f32(),
            v: self.v.to_f32(),
            primitive: self.primitive,
        })
    }
}

/// One ray against blocks.
struct Tester<'a, K: Kernel, N: Number, S: Simd> {
    token: S,
    blocks: &'a Blocks<K::Stored<N>>,
    ray: K::Prepared<N::Lanes<S>>,
    t_min: N::Lanes<S>,
    end: N,
    exclude: Option<u32>,
}

impl<K: Kernel, N: Number, S: Simd> Tester<'_, K, N, S> {
    /// Hands each hit in a block whose rank is at most `limit` to `found`, until that breaks.
    /// `IS_BEHIND`: as for [`SlabRay::enter`].
    #[inline(always)]
    fn test<const IS_BEHIND: bool>(
        &self,
        block: usize,
        slabs: &SlabRay<S>,
        limit: N,
        mut found: impl FnMut(Found<N>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let values = self.blocks.values::<N, S>(self.token, block, K::VALUES);
        let t_max = Lane::splat(self.token, limit);
        let Some(hit) = K::intersect(&self.ray, &values, self.t_min, t_max) else {
            return ControlFlow::Continue(());
        };
        // What a ray hits beside the triangle's own box doesn't count.
        let boxes = self.blocks.boxes::<K, N, S>(self.token, block);
        let infinity = Lane::splat(self.token, f32::INFINITY);
        let (entries, met) = slabs.enter::<IS_BEHIND>(self.token, &boxes, infinity);
        let (t, u, v) = (N::store(hit.t), N::store(hit.u), N::store(hit.v));
        let primitives = self.blocks.bvh.lanes(block);
        let mut lanes = LaneMask::bits(hit.mask) & met;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK_SIZE;
            lanes &= lanes - 1;
            let (t, primitive) = (t[lane], primitives[lane]);
            let floor = N::from(rank_floor(entries[lane]));
            let rank = if t < floor { floor } else { t };
            // What is farther than f32's largest number is a miss.
            if rank < self.end && t.to_f32() < f32::INFINITY && is_asked(primitive, self.exclude) {
                found(Found {
                    rank,
                    t,
                    u: u[lane],
                    v: v[lane],
                    primitive,
                })?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.blocks.announce(self.token, block, K::VALUES);
    }
}

/// Looks for the nearest hit.
struct Nearest<'a, K: Kernel, N: Number, S: Simd> {
    tester: Tester<'a, K, N, S>,
    best: Found<N>,
}

impl<K: Kernel, N: Number, S: Simd> Visitor<S> for Nearest<'_, K, N, S> {
    const IS_ORDERED: bool = true;
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        let limit = self.best.rank;
        let best = &mut self.best;
        _ = self.tester.test::<false>(block, slabs, limit, |hit| {
            if hit.is_before(best) {
                *best = hit;
            }
            ControlFlow::Continue(())
        });
        ControlFlow::Continue(self.best.rank.to_f32())
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// Looks for a hit, whichever.
struct Any<'a, K: Kernel, N: Number, S: Simd> {
    tester: Tester<'a, K, N, S>,
    t_max: f32,
    is_hit: bool,
}

impl<K: Kernel, N: Number, S: Simd> Visitor<S> for Any<'_, K, N, S> {
    const IS_ORDERED: bool = false;
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        let is_hit = &mut self.is_hit;
        let end = self.tester.end;
        self.tester.test::<false>(block, slabs, end, |_| {
            *is_hit = true;
            ControlFlow::Break(())
        })?;
        ControlFlow::Continue(self.t_max)
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// Hands hits to whoever asks, and counts what they cost: for rarer questions, and rays whose interval
/// begins behind their origin.
struct Each<'a, 'f, K: Kernel, N: Number, S: Simd> {
    tester: Tester<'a, K, N, S>,
    limit: N,
    /// Returns the farthest rank that is still of interest.
    found: &'f mut dyn FnMut(Found<N>) -> ControlFlow<(), N>,
    cost: Cost,
}

impl<K: Kernel, N: Number, S: Simd> Visitor<S> for Each<'_, '_, K, N, S> {
    const IS_ORDERED: bool = true;
    const IS_BEHIND: bool = true;

    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32> {
        self.cost.triangles += self.tester.blocks.bvh.block(block).len() as u32;
        let limit = &mut self.limit;
        let found = &mut self.found;
        self.tester.test::<true>(block, slabs, *limit, |hit| {
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

impl<K: Kernel, N: Number> MeshIntersector<K, N> {
    pub fn new(
        kernel: &'static KernelInfo,
        mesh: &TriangleMesh,
        bvh: Arc<Bvh>,
        level: SimdLevel,
    ) -> Self {
        let empty = Some(<K::Stored<N> as Stored<N>>::NO_TRIANGLE);
        Self {
            blocks: Blocks::new(mesh, bvh, K::VALUES, empty, K::pack::<N>),
            level,
            kernel,
            packets: None,
        }
    }

    #[inline(always)]
    fn tester<S: Simd>(&self, token: S, ray: &Ray) -> Tester<'_, K, N, S> {
        Tester {
            token,
            blocks: &self.blocks,
            ray: K::prepare(&RayLanes::of(token, ray)),
            t_min: Lane::of(token, ray.t_min),
            end: N::from(ray.t_max),
            exclude: ray.exclude,
        }
    }

    #[inline(always)]
    fn nearest<S: Simd>(&self, token: S, ray: &Ray, stack: &mut Stack) -> Option<Hit> {
        let mut visitor = Nearest {
            tester: self.tester(token, ray),
            best: Found::nothing(N::from(ray.t_max)),
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.best.hit()
    }

    #[inline(always)]
    fn any<S: Simd>(&self, token: S, ray: &Ray, stack: &mut Stack) -> bool {
        let mut visitor = Any {
            tester: self.tester(token, ray),
            t_max: ray.t_max,
            is_hit: false,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.is_hit
    }

    /// Hands each hit to `found`, which returns the farthest rank of interest.
    fn each(&self, ray: &Ray, found: &mut dyn FnMut(Found<N>) -> ControlFlow<(), N>) -> Cost {
        with_stack(|stack| {
            let token = baseline();
            let mut visitor = Each {
                tester: self.tester(token, ray),
                limit: N::from(ray.t_max),
                found,
                cost: Cost::default(),
            };
            self.blocks.bvh.walk(token, ray, stack, &mut visitor);
            visitor.cost
        })
    }

    #[inline(always)]
    fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let Tester {
            ray: prepared,
            t_min,
            ..
        } = self.tester(token, ray);
        let t_max = Lane::of(token, ray.t_max);
        let mut count = 0;
        // A plain loop: what an iterator calls may lose the CPU's features.
        for block in 0..self.blocks.bvh.block_count() {
            let values = self.blocks.values::<N, S>(token, block, K::VALUES);
            if let Some(hit) = K::intersect(&prepared, &values, t_min, t_max) {
                count += LaneMask::bits(hit.mask).count_ones() as usize;
            }
        }
        count
    }
}

impl<K: Kernel, N: Number> Intersector for MeshIntersector<K, N> {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        with_stack(|stack| {
            dispatch!(self.level.level(), token => {
                for (ray, hit) in rays.iter().zip(&mut *hits) {
                    if !is_behind(ray) {
                        *hit = self.nearest(token, ray, stack);
                    }
                }
            });
        });
        answer_behind(rays, hits, |ray| self.closest_hit_with_cost(ray).0);
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        match self.packets {
            Some(trace) => trace(self, rays, hits),
            None => self.closest_hits(rays, hits),
        }
    }

    fn rays_together(&self) -> usize {
        if self.packets.is_some() { PACKET } else { 1 }
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let mut best = Found::nothing(N::from(ray.t_max));
        let cost = self.each(ray, &mut |hit| {
            if hit.is_before(&best) {
                best = hit;
            }
            ControlFlow::Continue(best.rank)
        });
        (best.hit(), cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        with_stack(|stack| {
            dispatch!(self.level.level(), token => {
                for (ray, is_hit) in rays.iter().zip(&mut *are_hits) {
                    if !is_behind(ray) {
                        *is_hit = self.any(token, ray, stack);
                    }
                }
            });
        });
        answer_behind(rays, are_hits, |ray| {
            self.closest_hit_with_cost(ray).0.is_some()
        });
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let end = N::from(ray.t_max);
        let mut hits: Vec<(Found<N>, Hit)> = Vec::new();
        _ = self.each(ray, &mut |hit| {
            hits.extend(hit.hit().map(|rounded| (hit, rounded)));
            ControlFlow::Continue(end)
        });
        let key = |hit: &Found<N>| -> f64 { hit.t.into() };
        hits.sort_by(|(a, _), (b, _)| {
            let by_t = key(a).total_cmp(&key(b));
            by_t.then(a.primitive.cmp(&b.primitive))
        });
        hits.chunk_by(|(a, _), (b, _)| a.t == b.t)
            .map(|equal| Crossing {
                hit: equal[0].1,
                also: equal[1..].iter().map(|(hit, _)| hit.primitive).collect(),
            })
            .collect()
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        candidates(&self.blocks.bvh, ray)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        dispatch!(self.level.level(), token => self.count(token, ray))
    }

    fn bytes(&self) -> usize {
        self.blocks.bytes()
    }
}

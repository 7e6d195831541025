//! Intersector of a mesh for kernels that decide about each triangle separately.

mod visitors;

use super::blocks::{BlockValues, Blocks, Scratch, candidates, corners};
use super::compact::{EmptyLanes, Packing};
use super::{Cost, Crossing, Intersector, answer_behind, is_behind};
use crate::bvh::{Bvh, Stack, with_stack};
use crate::kernel::{Kernel, KernelInfo, MAX_VALUES, RayLanes};
use crate::lane::{Lane, LaneMask, Number, PACKET};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::simd::{SimdLevel, baseline};
use fearless_simd::{Simd, dispatch};
use std::ops::ControlFlow;
use std::sync::Arc;
use visitors::{Any, Each, Found, Nearest, Tester};

/// Triangles packed for the kernel `K`, computing in `N`.
pub(crate) struct MeshIntersector<K: Kernel, N: Number> {
    pub(super) blocks: Blocks<K::Stored<N>>,
    pub(super) level: SimdLevel,
    pub(super) kernel: &'static KernelInfo,
    /// Traces packets of coherent rays. Only for some kernels, as each needs its own copy of the code.
    pub(super) packets: Option<Packets<K, N>>,
}

type Packets<K, N> = fn(&MeshIntersector<K, N>, &[Ray], &mut [Option<Hit>]);

impl<K: Kernel, N: Number> MeshIntersector<K, N> {
    pub fn new(
        kernel: &'static KernelInfo,
        mesh: &TriangleMesh,
        bvh: Arc<Bvh>,
        level: SimdLevel,
        packing: Packing,
    ) -> Self {
        const { assert!(K::VALUES <= MAX_VALUES) };
        let empty = if K::IS_ADAPTIVE {
            EmptyLanes::First
        } else {
            EmptyLanes::Nothing
        };
        Self {
            blocks: Blocks::new(mesh, bvh, packing, K::VALUES, empty, K::pack::<N>),
            level,
            kernel,
            packets: None,
        }
    }

    #[inline(always)]
    fn tester<'a, S: Simd>(
        &'a self,
        token: S,
        ray: &Ray,
        scratch: &'a mut Scratch<K::Stored<N>>,
    ) -> Tester<'a, K, N, S> {
        Tester {
            token,
            blocks: &self.blocks,
            scratch,
            prepared: K::prepare(&RayLanes::of(token, ray)),
            t_min: Lane::of(token, ray.t_min),
            end: N::from(ray.t_max),
            ray: *ray,
        }
    }

    #[inline(always)]
    fn nearest<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        scratch: &mut Scratch<K::Stored<N>>,
    ) -> Option<Hit> {
        let mut visitor = Nearest::<_, _, _, MAYBE_COMPACT> {
            tester: self.tester(token, ray, scratch),
            best: Found::nothing(N::from(ray.t_max)),
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.best.hit()
    }

    #[inline(always)]
    fn any<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        scratch: &mut Scratch<K::Stored<N>>,
    ) -> bool {
        let mut visitor = Any::<_, _, _, MAYBE_COMPACT> {
            tester: self.tester(token, ray, scratch),
            t_max: ray.t_max,
            is_hit: false,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.is_hit
    }

    /// Finds the nearest hits of the rays whose intervals don't start behind their origins.
    #[inline(always)]
    fn find<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        for (ray, hit) in rays.iter().zip(hits) {
            if !is_behind(ray) {
                *hit = self.nearest::<MAYBE_COMPACT, S>(token, ray, stack, &mut scratch);
            }
        }
    }

    /// Finds out whether these rays hit anything.
    #[inline(always)]
    fn find_any<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        for (ray, is_hit) in rays.iter().zip(are_hits) {
            if !is_behind(ray) {
                *is_hit = self.any::<MAYBE_COMPACT, S>(token, ray, stack, &mut scratch);
            }
        }
    }

    /// Passes each hit to `found`, which returns the farthest rank of interest.
    fn each(&self, ray: &Ray, found: &mut dyn FnMut(Found<N>) -> ControlFlow<(), N>) -> Cost {
        with_stack(|stack| {
            let (token, mut scratch) = (baseline(), Scratch::new());
            let mut visitor = Each {
                tester: self.tester(token, ray, &mut scratch),
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
        let prepared = K::prepare(&RayLanes::of(token, ray));
        let (t_min, t_max) = (Lane::of(token, ray.t_min), Lane::of(token, ray.t_max));
        let (mut count, mut scratch) = (0, Scratch::new());
        // A plain loop: functions called by an iterator may be compiled without the CPU's features.
        for block in 0..self.blocks.bvh.block_count() {
            let rows = (self.blocks).rows::<true>(block, K::VALUES, &mut scratch, K::pack::<N>);
            let values = BlockValues::<N, S, _>::new(token, rows);
            if let Some(hit) = K::intersect(&prepared, &values, t_min, t_max) {
                let [certain, doubtful] = [hit.mask, hit.doubtful].map(LaneMask::bits);
                for lane in 0..self.blocks.bvh.block(block).len() {
                    let is_hit = certain >> lane & 1 == 1
                        || (K::IS_ADAPTIVE
                            && doubtful >> lane & 1 == 1
                            && K::decide::<N>(ray, corners(rows, lane)).is_some());
                    count += usize::from(is_hit);
                }
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
            if self.blocks.are_compact() {
                self.find::<true, _>(baseline(), rays, hits, stack);
            } else {
                let level = self.level.level();
                dispatch!(level, token => self.find::<false, _>(token, rays, hits, stack));
            }
        });
        answer_behind(rays, hits, |ray| self.closest_hit_with_cost(ray).0);
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        match self.packets {
            Some(trace) if !self.blocks.are_compact() => trace(self, rays, hits),
            _ => self.closest_hits(rays, hits),
        }
    }

    fn rays_together(&self) -> usize {
        if self.packets.is_some() && !self.blocks.are_compact() {
            PACKET
        } else {
            1
        }
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
            if self.blocks.are_compact() {
                self.find_any::<true, _>(baseline(), rays, are_hits, stack);
            } else {
                let level = self.level.level();
                dispatch!(level, token => self.find_any::<false, _>(token, rays, are_hits, stack));
            }
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

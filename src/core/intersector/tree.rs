//! Intersector of primitives of one shape: a tree and packed primitives, traced by any method.

use super::blocks::{Blocks, Packing, Scratch, candidates};
use super::interleaved;
use super::levels::Levels;
use super::method::{BlocksOf, Method, Tester};
use super::order::crossings;
use super::stream::StreamSearches;
use super::visitors::{Any, Each, Kept, Nearest};
use super::{Cost, Crossing, GroupIntersector, Intersector, RankedHit, answer_behind, is_behind};
use crate::aabb::Aabb;
use crate::bvh::{Bvh, LentStack, OpenedBox, Stack, Step};
use crate::kernel::{KernelInfo, MAX_VALUES};
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use crate::shape::{Primitives, Shape as _};
use crate::simd::{Baseline, SimdLevel, baseline};
use fearless_simd::Simd;
use std::marker::PhantomData;
use std::sync::Arc;

/// Primitives packed for the method `M`.
pub(super) struct TreeIntersector<M: Method> {
    pub blocks: BlocksOf<M>,
    pub level: SimdLevel,
    kernel: &'static KernelInfo,
    /// Traces many rays at once.
    streams: Option<StreamSearches<M>>,
}

impl<M: Method> TreeIntersector<M> {
    pub fn new(
        kernel: &'static KernelInfo,
        primitives: &dyn Primitives<M::Shape>,
        bvh: Arc<Bvh>,
        level: SimdLevel,
        packing: Packing,
        streams: Option<StreamSearches<M>>,
    ) -> Self {
        const { assert!(M::VALUES <= MAX_VALUES) };
        Self {
            blocks: Blocks::new(primitives, bvh, packing, M::VALUES, M::EMPTY, M::pack),
            level,
            kernel,
            streams,
        }
    }

    /// The searches of many rays at once, which need packed rows.
    fn streams(&self) -> Option<&StreamSearches<M>> {
        self.streams.as_ref().filter(|_| !self.blocks.are_compact())
    }

    /// These searches, if interleaving the rays is faster than tracing one after another.
    fn interleaved(&self, rays: &[Ray]) -> Option<&StreamSearches<M>> {
        self.streams()
            .filter(|_| interleaved::is_faster(&self.blocks, rays))
    }

    /// Finds the nearest hits of the rays whose intervals don't start behind their origins.
    #[inline(always)]
    pub(super) fn find<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        batch: &mut M::Batch,
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        let mut i = 0;
        while i < rays.len() {
            if !is_behind(&rays[i]) {
                let tester = M::tester(&self.blocks, token, &rays[i], scratch.rows());
                let mut visitor = Nearest::<S, _, MAYBE_COMPACT> {
                    nearest: tester.nothing(),
                    tester,
                };
                self.blocks.bvh.walk(token, &rays[i], stack, &mut visitor);
                hits[i] = None;
                if let Some(found) = visitor.tester.found(&visitor.nearest) {
                    M::keep::<S>(&mut visitor.tester, found, i, hits, batch);
                }
            }
            i += 1;
        }
    }

    /// Finds out whether these rays hit anything.
    #[inline(always)]
    pub(super) fn find_any<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        for (ray, is_hit) in rays.iter().zip(are_hits) {
            if !is_behind(ray) {
                let tester = M::tester(&self.blocks, token, ray, scratch.rows());
                let mut visitor = Any::<_, MAYBE_COMPACT>::new(tester, ray.t_max);
                self.blocks.bvh.walk(token, ray, stack, &mut visitor);
                *is_hit = visitor.is_hit;
            }
        }
    }

    /// Finds the nearest hit or all hits of one ray, and passes them to `finish`. Appends the steps of the walk to `steps`.
    // One function for all queries and callers, so that each kernel's code is compiled once for them.
    fn each(
        &self,
        ray: &Ray,
        query: Query,
        steps: Option<&mut Vec<Step>>,
        finish: Finish<'_, M>,
    ) -> Cost {
        let (mut lent, mut scratch) = (LentStack::new(), Scratch::new());
        let tester = M::tester(&self.blocks, baseline(), ray, scratch.rows());
        let mut visitor = Each {
            kept: match query {
                Query::Nearest => Kept::Nearest(tester.nothing()),
                Query::All => Kept::All(Vec::new()),
            },
            tester,
            t_max: ray.t_max,
            cost: Cost::default(),
            steps,
            count: &|block| self.blocks.bvh.block(block).len(),
            token: PhantomData,
        };
        self.blocks
            .bvh
            .walk(baseline(), ray, lent.get(), &mut visitor);
        let [in_f64, in_integers] = visitor.tester.work();
        let found = match visitor.kept {
            Kept::Nearest(nearest) => visitor.tester.found(&nearest).into_iter().collect(),
            Kept::All(found) => found,
        };
        finish(&mut visitor.tester, found);
        Cost {
            in_f64,
            in_integers,
            ..visitor.cost
        }
    }

    #[inline(always)]
    pub(super) fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let mut scratch = Scratch::new();
        let mut tester = M::tester(&self.blocks, token, ray, scratch.rows());
        let mut count = 0;
        // A plain loop: functions called by an iterator may be compiled without the CPU's features.
        for block in 0..self.blocks.bvh.block_count() {
            count += tester.count(block);
        }
        count
    }
}

/// Receives the tester and the hits of a ray.
type Finish<'f, M> =
    &'f mut dyn FnMut(&mut <M as Method>::Tester<'_, Baseline>, Vec<<M as Method>::Found>);

/// The query of [`TreeIntersector::each`].
enum Query {
    Nearest,
    All,
}

impl<M: Method> Intersector for TreeIntersector<M> {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        let mut lent = LentStack::new();
        let batches = rays
            .chunks(M::BATCH_SIZE)
            .zip(hits.chunks_mut(M::BATCH_SIZE));
        for (rays, hits) in batches {
            let mut batch = M::batch();
            match self.interleaved(rays) {
                Some(streams) => {
                    (streams.nearest_interleaved)(self, rays, hits, &mut batch, lent.all());
                }
                None => M::Levels::find(self, rays, hits, &mut batch, lent.get()),
            }
            // Separate from the search, which otherwise becomes a tenth slower (exact kernel, bunny, primary
            // rays, 2026-11).
            M::round(&self.blocks, self.level, rays, &batch, hits);
        }
        answer_behind(rays, hits, &|ray| self.closest_hit_with_cost(ray).0);
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        match self.streams() {
            Some(streams) => (streams.nearest_of_packets)(self, rays, hits),
            None => self.closest_hits(rays, hits),
        }
    }

    fn coherent_any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        match self.streams() {
            Some(streams) => (streams.any_of_packets)(self, rays, are_hits),
            None => self.any_hits(rays, are_hits),
        }
    }

    fn rays_together(&self) -> usize {
        self.streams().map_or(1, |_| PACKET)
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let mut hit = None;
        let cost = self.each(ray, Query::Nearest, None, &mut |tester, mut found| {
            hit = found.pop().map(|found| tester.hit(found));
        });
        (hit, cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        let mut lent = LentStack::new();
        match self.interleaved(rays) {
            Some(streams) => (streams.any_interleaved)(self, rays, are_hits, lent.all()),
            None => M::Levels::find_any(self, rays, are_hits, lent.get()),
        }
        answer_behind(rays, are_hits, &|ray| {
            self.closest_hit_with_cost(ray).0.is_some()
        });
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let mut all = Vec::new();
        self.each(ray, Query::All, None, &mut |tester, found| {
            all = crossings(tester, found);
        });
        all
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        candidates(&self.blocks.bvh, ray)
    }

    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        let mut steps = Vec::new();
        self.each(ray, Query::Nearest, Some(&mut steps), &mut |_, _| ());
        self.blocks.bvh.opened(&steps)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        M::Levels::count(self, ray)
    }

    fn bytes(&self) -> usize {
        self.blocks.bytes()
    }
}

impl<M: Method> GroupIntersector for TreeIntersector<M> {
    fn nearest_with_cost(&self, ray: &Ray) -> (Option<RankedHit>, Cost) {
        let mut hit = None;
        let cost = self.each(ray, Query::Nearest, None, &mut |tester, mut found| {
            hit = found.pop().map(|found| tester.ranked(found));
        });
        (hit, cost)
    }

    fn box_to_meet(&self) -> Option<Aabb> {
        M::Shape::IS_BOUNDED.then(|| self.blocks.bvh.bounds())
    }

    fn every_hit(&self, ray: &Ray) -> Vec<RankedHit> {
        let mut all = Vec::new();
        self.each(ray, Query::All, None, &mut |tester, found| {
            all.extend(found.into_iter().map(|found| tester.ranked(found)));
        });
        all
    }
}

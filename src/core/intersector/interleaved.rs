//! Interleaved tracing of rays: a step of one ray's walk, then a step of the next ray's. While a walk waits for the
//! next node or block, which it has prefetched, the others proceed.
//!
//! Source: O. Kocberber, B. Falsafi, B. Grot, "Asynchronous Memory Access Chaining", PVLDB 9(4), 2015.
//!
//! Speed relative to tracing one ray after another (random rays and rays from their hits, `watertight`, AMD Zen 4 with
//! 1 MB of L2 cache, 2026-11), with 4, 6, 8, 12 and 16 walks:
//!
//! ```text
//! triangles   size     random                          from hits
//!   70 000    4 MB      .89   .88   .87   .85   .83     .94   .92   .92   .90   .89
//!  280 000   15 MB     1.19  1.20  1.20                1.25  1.35  1.32
//!    1.1 M   60 MB     1.45  1.55  1.58  1.55  1.56    1.60  1.72  1.78  1.73  1.69
//!    4.4 M  240 MB     1.54  1.78  1.84                1.62  1.81  1.87
//! ```
//!
//! Rays that start near each other visit the same nodes, which stay in the cache. Interleaving makes them slower: with 8
//! walks, camera rays run at .83, and rays from the hits of neighbouring pixels at .89 (1.1 M triangles).

use super::blocks::Blocks;
use super::is_behind;
use super::method::{Method, Tester};
use super::tree::TreeIntersector;
use super::visitors::{Any, Nearest};
use crate::aabb::Aabb;
use crate::bvh::{Bvh, Stacks, Visitor, WALKS, Walk};
use crate::ray::{Hit, Ray};
use crate::shape::Shape;
use fearless_simd::{Simd, dispatch};

/// The size of a tree with its blocks, in bytes, from which interleaving is faster: between the sizes in the
/// [module](self)'s table that lose and gain.
const LARGE: usize = 8 << 20;

/// Rays are scattered if their origins are farther apart than this part of the tree's diameter.
const APART: f32 = 1.0 / 64.0;

/// Pairs of successive rays whose origins are compared.
const PAIRS: usize = 16;

/// Whether interleaving is faster than tracing one ray after another.
pub(super) fn is_faster<S, T>(blocks: &Blocks<S, T>, rays: &[Ray]) -> bool
where
    S: Shape,
    T: Copy + Default + Send + Sync,
{
    blocks.bytes() + blocks.bvh.bytes() >= LARGE && are_scattered(blocks.bvh.bounds(), rays)
}

/// Whether most successive rays start far from each other.
fn are_scattered(bounds: Aabb, rays: &[Ray]) -> bool {
    let least = APART * (bounds.max - bounds.min).length();
    let step = rays.len().div_ceil(PAIRS).max(1);
    let pairs = rays.windows(2).step_by(step);
    let (mut apart, mut count) = (0, 0);
    for pair in pairs {
        apart += usize::from(pair[0].origin.distance_squared(pair[1].origin) > least * least);
        count += 1;
    }
    2 * apart > count
}

/// The searches of a batch of rays.
trait Searches<S: Simd> {
    /// The search of one ray.
    type Search: Visitor<S>;

    /// Begins the search of a ray.
    fn start(&self, index: usize) -> Self::Search;

    /// Keeps the result of a ray whose walk is at its end.
    fn finish(&mut self, index: usize, search: &mut Self::Search);
}

/// A walk and its search.
struct Running<S: Simd, V> {
    index: usize,
    walk: Walk<S>,
    search: V,
}

/// Runs the searches of the rays whose intervals don't start behind their origins. The tree must not be empty.
#[inline(always)]
fn run<S: Simd, Q: Searches<S>>(
    bvh: &Bvh,
    token: S,
    rays: &[Ray],
    stacks: &mut Stacks,
    searches: &mut Q,
) {
    let mut slots = [const { None::<Running<S, Q::Search>> }; WALKS];
    let (mut next, mut running) = (0, 0);
    loop {
        // A plain loop: functions called by an iterator may be compiled without the CPU's features.
        let mut k = 0;
        while k < WALKS {
            if slots[k].is_none() {
                while next < rays.len() && is_behind(&rays[next]) {
                    next += 1;
                }
                if next < rays.len() {
                    slots[k] = Some(Running {
                        index: next,
                        walk: Walk::start(token, &rays[next]),
                        search: searches.start(next),
                    });
                    (next, running) = (next + 1, running + 1);
                }
            }
            if let Some(slot) = &mut slots[k]
                && slot.walk.step(bvh, token, &mut stacks[k], &mut slot.search)
            {
                searches.finish(slot.index, &mut slot.search);
                slots[k] = None;
                running -= 1;
            }
            k += 1;
        }
        if running == 0 && next == rays.len() {
            return;
        }
    }
}

/// Searches for the nearest hits.
struct NearestSearches<'a, M: Method, S> {
    intersector: &'a TreeIntersector<M>,
    token: S,
    rays: &'a [Ray],
    hits: &'a mut [Option<Hit>],
    batch: &'a mut M::Batch,
}

impl<'a, M: Method, S: Simd> Searches<S> for NearestSearches<'a, M, S> {
    type Search = Nearest<S, M::Tester<'a, S>, false>;

    #[inline(always)]
    fn start(&self, index: usize) -> Self::Search {
        let blocks = &self.intersector.blocks;
        let tester = M::tester(blocks, self.token, &self.rays[index], &mut []);
        Nearest {
            nearest: tester.nothing(),
            tester,
        }
    }

    #[inline(always)]
    fn finish(&mut self, index: usize, search: &mut Self::Search) {
        self.hits[index] = None;
        if let Some(found) = search.tester.found(&search.nearest) {
            M::keep::<S>(&mut search.tester, found, index, self.hits, self.batch);
        }
    }
}

/// Searches for any hits.
struct AnySearches<'a, M: Method, S> {
    intersector: &'a TreeIntersector<M>,
    token: S,
    rays: &'a [Ray],
    are_hits: &'a mut [bool],
}

impl<'a, M: Method, S: Simd> Searches<S> for AnySearches<'a, M, S> {
    type Search = Any<M::Tester<'a, S>, false>;

    #[inline(always)]
    fn start(&self, index: usize) -> Self::Search {
        let (blocks, ray) = (&self.intersector.blocks, &self.rays[index]);
        Any::new(M::tester(blocks, self.token, ray, &mut []), ray.t_max)
    }

    #[inline(always)]
    fn finish(&mut self, index: usize, search: &mut Self::Search) {
        self.are_hits[index] = search.is_hit;
    }
}

impl<M: Method> TreeIntersector<M> {
    /// The same as [`find`](Self::find), interleaved. Needs packed rows.
    pub(super) fn nearest_interleaved(
        &self,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        batch: &mut M::Batch,
        stacks: &mut Stacks,
    ) {
        dispatch!(self.level.level(), token => {
            let mut searches = NearestSearches { intersector: self, token, rays, hits, batch };
            run(&self.blocks.bvh, token, rays, stacks, &mut searches);
        });
    }

    /// The same as [`find_any`](Self::find_any), interleaved. Needs packed rows.
    pub(super) fn any_interleaved(&self, rays: &[Ray], are_hits: &mut [bool], stacks: &mut Stacks) {
        dispatch!(self.level.level(), token => {
            let mut searches = AnySearches { intersector: self, token, rays, are_hits };
            run(&self.blocks.bvh, token, rays, stacks, &mut searches);
        });
    }
}

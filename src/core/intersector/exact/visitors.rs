//! Visitors that test blocks with the exact kernel.

use super::{ExactIntersector, Vector};
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, SlabRay, Visitor};
use crate::intersector::Cost;
use crate::intersector::blocks::{BlockValues, Scratch, can_be_hit};
use crate::kernel::exact::{Candidate, Judge, VALUES, filter};
use crate::kernel::{ShearedRay, pack_corners};
use crate::lane::{Lane, LaneMask, Number};
use fearless_simd::Simd;
use glam::Vec3;
use std::ops::ControlFlow;

/// Tests one ray against blocks.
pub(super) struct Tester<'a, S: Simd, F, const MAYBE_COMPACT: bool> {
    pub intersector: &'a ExactIntersector,
    pub token: S,
    pub scratch: &'a mut Scratch<f32>,
    pub sheared: ShearedRay<Vector<S>>,
    pub judge: Judge<'a, F>,
    /// A depth below which hits lie before the ray's interval, among them the hit of the triangle that the
    /// ray leaves.
    pub earliest: f32,
    /// Factor from depth to t.
    pub inverse_dir_z: f32,
}

/// A lane of a block that isn't a certain miss or certainly too deep.
#[derive(Clone, Copy)]
pub(super) struct LaneCandidate {
    pub primitive: u32,
    /// The slot whose corners it has.
    pub slot: u32,
    /// Bounds of its depth.
    pub near: f32,
    pub far: f32,
    pub is_certain: bool,
}

impl LaneCandidate {
    pub fn candidate(&self) -> Candidate {
        Candidate::new(self.primitive, self.slot as usize, self.near, self.far)
    }
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool>
    Tester<'_, S, F, MAYBE_COMPACT>
{
    /// Passes each lane of a block that may be hit in the ray's interval, at a depth of at most `deepest`, to
    /// `on_candidate`, until that breaks.
    #[inline(always)]
    pub fn test(
        &mut self,
        block: usize,
        deepest: f32,
        mut on_candidate: impl FnMut(&mut Judge<'_, F>, LaneCandidate) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let blocks = &self.intersector.blocks;
        let rows = blocks.rows::<MAYBE_COMPACT>(block, VALUES, self.scratch, pack_corners);
        let values = BlockValues::<f32, S, f32>::new(self.token, rows);
        let Some(filtered) = filter(&self.sheared, &values) else {
            return ControlFlow::Continue(());
        };
        let (near, far) = (filtered.near(), filtered.far());
        let splat = |x: f32| Vector::<S>::splat(self.token, x);
        let is_outside = splat(deepest).lt(near) | far.lt(splat(self.earliest));
        let certain = filtered.certain.bits();
        let mut lanes = !(filtered.missed | is_outside).bits() & ((1 << BLOCK_SIZE) - 1);
        let (near, far) = (f32::store(near), f32::store(far));
        let primitives = blocks.bvh.lanes(block);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK_SIZE;
            lanes &= lanes - 1;
            let primitive = primitives[lane];
            if can_be_hit(primitive, self.judge.ray().exclude) {
                let hit = LaneCandidate {
                    primitive,
                    slot: (block * BLOCK_SIZE + lane) as u32,
                    near: near[lane],
                    far: far[lane],
                    is_certain: certain >> lane & 1 == 1,
                };
                on_candidate(&mut self.judge, hit)?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        (self.intersector.blocks).announce::<MAYBE_COMPACT, S>(self.token, block, VALUES);
    }
}

/// Finds the nearest hit.
pub(super) struct Nearest<'a, S: Simd, F, const MAYBE_COMPACT: bool> {
    pub tester: Tester<'a, S, F, MAYBE_COMPACT>,
    /// The nearest candidate so far, or [`NO_PRIMITIVE`] and infinity.
    pub best: LaneCandidate,
    /// The same candidate with narrowed bounds, if it needed them.
    pub narrowed: Option<Candidate>,
    pub t_max: f32,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool>
    Nearest<'_, S, F, MAYBE_COMPACT>
{
    /// The nearest hit.
    #[inline(always)]
    pub fn candidate(&self) -> Option<Candidate> {
        candidate_of(&self.best, self.narrowed)
    }
}

/// The nearest hit so far, with its narrowest known bounds.
#[inline(always)]
fn candidate_of(best: &LaneCandidate, narrowed: Option<Candidate>) -> Option<Candidate> {
    let is_hit = best.primitive != NO_PRIMITIVE;
    is_hit.then(|| narrowed.unwrap_or_else(|| best.candidate()))
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool> Visitor<S>
    for Nearest<'_, S, F, MAYBE_COMPACT>
{
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
        let (best, narrowed) = (&mut self.best, &mut self.narrowed);
        let deepest = best.far;
        _ = self.tester.test(block, deepest, |judge, hit| {
            let [start, end] = judge.interval();
            let is_inside = start < f64::from(hit.near) && f64::from(hit.far) < end;
            if hit.is_certain && is_inside && hit.far < best.near {
                (*best, *narrowed) = (hit, None);
            } else if !(hit.is_certain && best.far < hit.near) {
                let nearest = nearer(judge, &hit, candidate_of(best, *narrowed));
                if let Some(nearest) = nearest {
                    [best.near, best.far] = nearest.bounds_f32();
                    (best.primitive, *narrowed) = (nearest.primitive, Some(nearest));
                }
            }
            ControlFlow::Continue(())
        });
        // Rounded twice; the slack with which boxes are visited covers that.
        let t = self.best.far * self.tester.inverse_dir_z;
        ControlFlow::Continue(t.min(self.t_max))
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// The nearer of a hit and the best so far, if f32 can't decide.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
fn nearer<F: Fn(usize) -> [Vec3; 3]>(
    judge: &mut Judge<'_, F>,
    hit: &LaneCandidate,
    best: Option<Candidate>,
) -> Option<Candidate> {
    let Some(mut hit) = judge.within(hit.candidate(), hit.is_certain) else {
        return best;
    };
    match best {
        Some(mut best) => Some(if judge.is_before(&mut hit, &mut best) {
            hit
        } else {
            best
        }),
        None => Some(hit),
    }
}

/// Finds any hit.
pub(super) struct Any<'a, S: Simd, F, const MAYBE_COMPACT: bool> {
    pub tester: Tester<'a, S, F, MAYBE_COMPACT>,
    pub is_hit: bool,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool> Visitor<S>
    for Any<'_, S, F, MAYBE_COMPACT>
{
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
        let is_hit = &mut self.is_hit;
        self.tester.test(block, f32::INFINITY, |judge, hit| {
            *is_hit = judge.within(hit.candidate(), hit.is_certain).is_some();
            if *is_hit {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        ControlFlow::Continue(self.tester.judge.ray().t_max)
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// The hits that [`Each`] keeps.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum KeptHits {
    Nearest,
    All,
}

/// Collects hits and counts their cost. For rarer queries, and for rays whose interval starts behind their
/// origin.
pub(super) struct Each<'a, S: Simd, F> {
    pub tester: Tester<'a, S, F, true>,
    pub kept: KeptHits,
    pub hits: Vec<Candidate>,
    pub cost: Cost,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Each<'_, S, F> {
    /// The depth beyond which hits aren't kept.
    fn deepest(&self) -> f32 {
        match self.hits.first() {
            Some(nearest) if self.kept == KeptHits::Nearest => nearest.bounds_f32()[1],
            _ => f32::INFINITY,
        }
    }
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Visitor<S> for Each<'_, S, F> {
    const IS_BEHIND: bool = true;

    fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
        let primitives = self.tester.intersector.blocks.bvh.block(block);
        self.cost.triangles += primitives.len() as u32;
        let (deepest, kept, hits) = (self.deepest(), self.kept, &mut self.hits);
        _ = self.tester.test(block, deepest, |judge, hit| {
            match kept {
                KeptHits::Nearest => {
                    let nearest = nearer(judge, &hit, hits.pop());
                    hits.extend(nearest);
                }
                KeptHits::All => hits.extend(judge.within(hit.candidate(), hit.is_certain)),
            }
            ControlFlow::Continue(())
        });
        let t = self.deepest() * self.tester.inverse_dir_z;
        ControlFlow::Continue(t.min(self.tester.judge.ray().t_max))
    }

    fn announce(&self, _: usize) {}

    fn count_boxes(&mut self, count: u32) {
        self.cost.boxes += count;
    }
}

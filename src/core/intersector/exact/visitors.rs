//! What the exact kernel does with the blocks that a ray meets.

use super::{ExactIntersector, Vector};
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, SlabRay, Visitor};
use crate::intersector::Cost;
use crate::intersector::blocks::{BlockValues, Scratch, is_asked};
use crate::kernel::exact::{Candidate, Judge, VALUES, filter};
use crate::kernel::{ShearedRay, pack_corners};
use crate::lane::{Lane, LaneMask, Number};
use fearless_simd::Simd;
use glam::Vec3;
use std::ops::ControlFlow;

/// One ray against blocks.
pub(super) struct Tester<'a, S: Simd, F, const MAYBE_COMPACT: bool> {
    pub intersector: &'a ExactIntersector,
    pub token: S,
    pub scratch: &'a mut Scratch<f32>,
    pub sheared: ShearedRay<Vector<S>>,
    pub judge: Judge<'a, F>,
    /// Depths below this are before the ray's interval: among them those of the triangle that it leaves.
    pub earliest: f32,
    /// t is a depth times this.
    pub inverse_dir_z: f32,
}

/// A lane of a block that isn't a certain miss, and not certainly too deep.
#[derive(Clone, Copy)]
pub(super) struct LaneCandidate {
    pub primitive: u32,
    /// Where its corners are found.
    pub slot: u32,
    /// Bounds on its depth.
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
    /// Hands each lane of a block that may be hit in the ray's interval, at a depth of at most `deepest`, to
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
            if is_asked(primitive, self.judge.ray().exclude) {
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

/// Looks for the nearest hit.
pub(super) struct Nearest<'a, S: Simd, F, const MAYBE_COMPACT: bool> {
    pub tester: Tester<'a, S, F, MAYBE_COMPACT>,
    /// The nearest so far, or [`NO_PRIMITIVE`] and infinity.
    pub best: LaneCandidate,
    /// The same, where it had to be looked at more closely.
    pub weighed: Option<Candidate>,
    pub t_max: f32,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool>
    Nearest<'_, S, F, MAYBE_COMPACT>
{
    /// What was found.
    #[inline(always)]
    pub fn candidate(&self) -> Option<Candidate> {
        candidate_of(&self.best, self.weighed)
    }
}

/// The nearest hit so far as it was weighed last.
#[inline(always)]
fn candidate_of(best: &LaneCandidate, weighed: Option<Candidate>) -> Option<Candidate> {
    let is_hit = best.primitive != NO_PRIMITIVE;
    is_hit.then(|| weighed.unwrap_or_else(|| best.candidate()))
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3], const MAYBE_COMPACT: bool> Visitor<S>
    for Nearest<'_, S, F, MAYBE_COMPACT>
{
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
        let (best, weighed) = (&mut self.best, &mut self.weighed);
        let deepest = best.far;
        _ = self.tester.test(block, deepest, |judge, hit| {
            let [start, end] = judge.interval();
            let is_inside = start < f64::from(hit.near) && f64::from(hit.far) < end;
            if hit.is_certain && is_inside && hit.far < best.near {
                (*best, *weighed) = (hit, None);
            } else if !(hit.is_certain && best.far < hit.near) {
                let nearest = nearer(judge, &hit, candidate_of(best, *weighed));
                if let Some(nearest) = nearest {
                    [best.near, best.far] = nearest.bounds_f32();
                    (best.primitive, *weighed) = (nearest.primitive, Some(nearest));
                }
            }
            ControlFlow::Continue(())
        });
        // Rounded twice, which what boxes are allowed beyond it pays for.
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

/// The nearer of a hit and the nearest so far, where f32 doesn't tell.
// Out of line: it is the rare path, and the common one is the better for it.
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

/// Looks for a hit, whichever.
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

/// Which hits are kept.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum KeptHits {
    Nearest,
    All,
}

/// Keeps hits, and counts what they cost: for rarer questions, and rays whose interval begins behind
/// their origin.
pub(super) struct Each<'a, S: Simd, F> {
    pub tester: Tester<'a, S, F, true>,
    pub kept: KeptHits,
    pub hits: Vec<Candidate>,
    pub cost: Cost,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Each<'_, S, F> {
    /// Hits deeper than this aren't kept.
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

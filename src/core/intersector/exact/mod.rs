//! Method for triangles whose hits are decided and ordered as in exact arithmetic.

mod batch;

pub(super) use batch::round_alone;

use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, SlabRay};
use crate::intersector::blocks::{BlockValues, LaneOf, Row, can_be_hit};
use crate::intersector::levels::EveryLevel;
use crate::intersector::method::{BlocksOf, Method, Tester};
use crate::intersector::order::precedes;
use crate::intersector::{ExactT, RankedHit};
use crate::kernel::ShearedRay;
use crate::kernel::exact::{Candidate, Corners, Judge, VALUES, exact_t, filter, t_bounds};
use crate::lane::{Lane, LaneMask, Number};
use crate::ray::{Hit, Ray};
use crate::shape::{CompactBlocks, EmptyLanes, Shape, Triangle};
use crate::simd::SimdLevel;
use batch::Batch;
use fearless_simd::{Simd, dispatch};
use glam::Vec3;
use std::cmp::Ordering;
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// Decides exactly about hits of the shape `T`, which is [`Triangle`].
pub(super) struct Exact<T>(PhantomData<T>);

type Vector<S> = <f32 as Number>::Lanes<S>;

/// The corners in the slots of blocks; a slot is a lane of a block. They are read from the block, not from the
/// mesh, because the block is in the cache.
pub(super) struct SlotCorners<'a, T: Shape>(pub(super) &'a BlocksOf<Exact<T>>)
where
    T: Into<Triangle>;

impl<T: Shape + Into<Triangle>> Clone for SlotCorners<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Shape + Into<Triangle>> Copy for SlotCorners<'_, T> {}

impl<T: Shape + Into<Triangle>> Corners for SlotCorners<'_, T> {
    #[inline(always)]
    fn corners(&self, slot: usize) -> [Vec3; 3] {
        let (block, lane) = (slot / BLOCK_SIZE, slot % BLOCK_SIZE);
        match self.0.compact() {
            Some(compact) => compact.primitive(block, lane).into().0,
            None => {
                Triangle::read(&LaneOf {
                    rows: self.0.packed(block, VALUES),
                    lane,
                })
                .0
            }
        }
    }
}

impl<T: Shape + Into<Triangle>> Method for Exact<T> {
    type Shape = T;
    type Stored = f32;
    const VALUES: usize = VALUES;
    type Levels = EveryLevel;
    const EMPTY: EmptyLanes = EmptyLanes::First;
    type Found = Candidate;
    type Tester<'a, S: Simd> = ExactTester<'a, T, S>;
    type Batch = Batch;
    /// Large enough that few lanes stay empty.
    const BATCH_SIZE: usize = 64;

    fn pack(shape: &T, values: &mut [f32]) {
        shape.write(values);
    }

    #[inline(always)]
    fn tester<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        ray: &'a Ray,
        scratch: &'a mut [Row<f32>],
    ) -> ExactTester<'a, T, S> {
        let judge = Judge::new(ray, SlotCorners(blocks));
        ExactTester {
            blocks,
            token,
            scratch,
            sheared: ShearedRay::of(token, ray),
            earliest: judge.earliest(),
            judge,
            inverse_dir_z: 1.0 / ray.dir.abs().max_element(),
        }
    }

    fn batch() -> Batch {
        Batch::EMPTY
    }

    #[inline(always)]
    fn keep<S: Simd>(
        tester: &mut ExactTester<'_, T, S>,
        nearest: Candidate,
        index: usize,
        _: &mut [Option<Hit>],
        batch: &mut Batch,
    ) {
        // Store the corners now, while they are in the cache.
        let corners = SlotCorners(tester.blocks).corners(nearest.slot);
        batch.add(index, tester.judge.ray(), &nearest, corners);
    }

    fn round(
        blocks: &BlocksOf<Self>,
        level: SimdLevel,
        rays: &[Ray],
        batch: &Batch,
        hits: &mut [Option<Hit>],
    ) {
        dispatch!(level.level(), token => batch::round(blocks, token, rays, batch, hits));
    }
}

/// Tests one ray.
pub(super) struct ExactTester<'a, T: Shape + Into<Triangle>, S: Simd> {
    blocks: &'a BlocksOf<Exact<T>>,
    token: S,
    scratch: &'a mut [Row<f32>],
    sheared: ShearedRay<Vector<S>>,
    judge: Judge<'a, SlotCorners<'a, T>>,
    /// A depth below which hits lie before the ray's interval, among them the hit of the triangle that the
    /// ray leaves.
    earliest: f32,
    /// Factor from depth to t.
    inverse_dir_z: f32,
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

/// The nearest hit so far, or [`NO_PRIMITIVE`] and infinity.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    best: LaneCandidate,
    /// The same candidate with narrowed bounds, if it needed them.
    narrowed: Option<Candidate>,
}

impl Nearest {
    /// The hit with its narrowest known bounds.
    #[inline(always)]
    fn candidate(&self) -> Option<Candidate> {
        let is_hit = self.best.primitive != NO_PRIMITIVE;
        is_hit.then(|| self.narrowed.unwrap_or_else(|| self.best.candidate()))
    }
}

impl<'a, T: Shape + Into<Triangle>, S: Simd> ExactTester<'a, T, S> {
    /// Passes each lane of a block that may be hit in the ray's interval, at a depth of at most `deepest`, to
    /// `on_candidate`, until that breaks.
    #[inline(always)]
    fn test<const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        deepest: f32,
        mut on_candidate: impl FnMut(
            &mut Judge<'a, SlotCorners<'a, T>>,
            LaneCandidate,
        ) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let rows =
            (self.blocks).rows::<MAYBE_COMPACT>(block, VALUES, self.scratch, Exact::<T>::pack);
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
        let primitives = self.blocks.bvh.lanes(block);
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
}

/// The nearer of a hit and the nearest so far, if f32 can't decide.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
pub(super) fn nearer<C: Corners>(
    judge: &mut Judge<'_, C>,
    hit: &LaneCandidate,
    nearest: Option<Candidate>,
) -> Option<Candidate> {
    let Some(mut hit) = judge.within(hit.candidate(), hit.is_certain) else {
        return nearest;
    };
    let Some(mut nearest) = nearest else {
        return Some(hit);
    };
    let order = judge.compare(&mut hit, &mut nearest).into();
    let is_before = precedes(order, order, hit.primitive < nearest.primitive);
    Some(if is_before { hit } else { nearest })
}

impl<T: Shape + Into<Triangle>, S: Simd> Tester<S> for ExactTester<'_, T, S> {
    type Found = Candidate;
    type Nearest = Nearest;

    #[inline(always)]
    fn nothing(&self) -> Nearest {
        Nearest {
            best: LaneCandidate {
                primitive: NO_PRIMITIVE,
                slot: 0,
                near: f32::INFINITY,
                far: f32::INFINITY,
                is_certain: true,
            },
            narrowed: None,
        }
    }

    #[inline(always)]
    fn nearest<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        _: &SlabRay<S>,
        nearest: &mut Nearest,
    ) {
        let deepest = nearest.best.far;
        _ = self.test::<MAYBE_COMPACT>(block, deepest, |judge, hit| {
            let Nearest { best, narrowed } = nearest;
            let [start, end] = judge.interval();
            let is_inside = start < f64::from(hit.near) && f64::from(hit.far) < end;
            if hit.is_certain && is_inside && hit.far < best.near {
                (*best, *narrowed) = (hit, None);
            } else if !(hit.is_certain && best.far < hit.near)
                && let Some(found) = nearer(judge, &hit, nearest.candidate())
            {
                [nearest.best.near, nearest.best.far] = found.bounds_f32();
                (nearest.best.primitive, nearest.narrowed) = (found.primitive, Some(found));
            }
            ControlFlow::Continue(())
        });
    }

    #[inline(always)]
    fn farthest(&self, nearest: &Nearest) -> f32 {
        // Rounded twice; the slack with which boxes are visited covers that.
        let t = nearest.best.far * self.inverse_dir_z;
        t.min(self.judge.ray().t_max)
    }

    #[inline(always)]
    fn found(&self, nearest: &Nearest) -> Option<Candidate> {
        nearest.candidate()
    }

    #[inline(always)]
    fn any<const MAYBE_COMPACT: bool>(&mut self, block: usize, _: &SlabRay<S>) -> bool {
        let test = self.test::<MAYBE_COMPACT>(block, f32::INFINITY, |judge, hit| {
            if judge.within(hit.candidate(), hit.is_certain).is_some() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        test.is_break()
    }

    fn all(&mut self, block: usize, _: &SlabRay<S>, found: &mut Vec<Candidate>) {
        _ = self.test::<true>(block, f32::INFINITY, |judge, hit| {
            let mut hit = judge.within(hit.candidate(), hit.is_certain);
            // Narrowed once, as each hit is compared with several others.
            hit.as_mut().map(|hit| judge.narrow(hit));
            found.extend(hit);
            ControlFlow::Continue(())
        });
    }

    #[inline(always)]
    fn count(&mut self, block: usize) -> usize {
        let mut count = 0;
        _ = self.test::<true>(block, f32::INFINITY, |judge, hit| {
            count += usize::from(judge.within(hit.candidate(), hit.is_certain).is_some());
            ControlFlow::Continue(())
        });
        count
    }

    fn compare(&mut self, first: &mut Candidate, second: &mut Candidate) -> Ordering {
        self.judge.compare(first, second)
    }

    fn primitive(found: &Candidate) -> u32 {
        found.primitive
    }

    fn hit(&mut self, found: Candidate) -> Hit {
        self.judge.hit(found)
    }

    fn ranked(&mut self, found: Candidate) -> RankedHit {
        let values = self.judge.values(found);
        let (ray, corners) = (
            *self.judge.ray(),
            SlotCorners(self.blocks).corners(found.slot),
        );
        RankedHit {
            hit: found.hit(values),
            t: t_bounds(values[0]),
            exact: Some(ExactT::new(move || exact_t(&ray, corners))),
            is_tangent: false,
        }
    }

    #[inline(always)]
    fn announce<const MAYBE_COMPACT: bool>(&self, block: usize) {
        (self.blocks).announce::<MAYBE_COMPACT, S>(self.token, block, VALUES);
    }

    fn work(&self) -> [u32; 2] {
        [self.judge.work.in_f64, self.judge.work.in_integers]
    }
}

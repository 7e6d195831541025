//! Method for shapes that state their crossings as polynomials: hits are decided and ordered as in exact arithmetic.

use super::blocks::{BlockValues, Blocks, LaneOf, Row, can_be_hit, may_meet, stored};
use super::levels::Levels;
use super::method::{BlocksOf, Method, Tester};
use super::order::precedes;
use super::{ExactT, RankedHit};
use crate::algebra::{Crossing, CrossingSolver, Pieces};
use crate::bvh::{BLOCK_SIZE, SlabRay, end_slackened};
use crate::lane::Lane;
use crate::ray::{Hit, Ray};
use crate::shape::{EmptyLanes, Shape};
use fearless_simd::{Simd, f32x8};
use std::cmp::Ordering;
use std::marker::PhantomData;

/// Decides exactly about hits of the shape `T`, with code for the levels `V`.
pub(super) struct Algebraic<T, V>(PhantomData<(T, V)>);

/// A point at which the ray crosses a primitive.
#[derive(Clone)]
pub(super) struct Found<T> {
    primitive: u32,
    shape: T,
    crossing: Crossing,
}

impl<T: Shape + Pieces, V: Levels> Method for Algebraic<T, V> {
    type Shape = T;
    type Stored = f32;
    const VALUES: usize = T::NUMBERS;
    type Levels = V;
    const EMPTY: EmptyLanes = EmptyLanes::Nowhere;
    type Found = Found<T>;
    type Tester<'a, S: Simd> = AlgebraicTester<'a, T, S>;
    type Batch = ();

    fn pack(shape: &T, values: &mut [f32]) {
        shape.write(values);
    }

    #[inline(always)]
    fn tester<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        ray: &'a Ray,
        scratch: &'a mut [Row<f32>],
    ) -> AlgebraicTester<'a, T, S> {
        AlgebraicTester {
            blocks,
            token,
            scratch,
            ray,
            solver: CrossingSolver::new(ray),
        }
    }

    fn batch() {}

    #[inline(always)]
    fn keep<S: Simd>(
        tester: &mut AlgebraicTester<'_, T, S>,
        nearest: Found<T>,
        index: usize,
        hits: &mut [Option<Hit>],
        _: &mut (),
    ) {
        hits[index] = Some(tester.hit(nearest));
    }
}

/// The order of two crossings by t.
fn compared<T: Pieces>(
    solver: &mut CrossingSolver<'_>,
    first: &mut Found<T>,
    second: &mut Found<T>,
) -> Ordering {
    solver.compare(
        (&first.shape, &mut first.crossing),
        (&second.shape, &mut second.crossing),
    )
}

/// Tests one ray.
pub(super) struct AlgebraicTester<'a, T: Shape + Pieces, S: Simd> {
    blocks: &'a Blocks<T, f32>,
    token: S,
    scratch: &'a mut [Row<f32>],
    ray: &'a Ray,
    solver: CrossingSolver<'a>,
}

/// The primitives of a block that the ray may hit.
struct Candidates<'a, T> {
    rows: &'a [Row<f32>],
    primitives: &'a [u32; BLOCK_SIZE],
    exclude: Option<u32>,
    /// A bit per lane.
    lanes: u32,
    shape: PhantomData<T>,
}

impl<T: Shape> Iterator for Candidates<'_, T> {
    type Item = (u32, T);

    #[inline(always)]
    fn next(&mut self) -> Option<(u32, T)> {
        while self.lanes != 0 {
            let (rows, lane) = (self.rows, self.lanes.trailing_zeros() as usize % BLOCK_SIZE);
            self.lanes &= self.lanes - 1;
            if can_be_hit(self.primitives[lane], self.exclude) {
                return Some((self.primitives[lane], T::read(&LaneOf { rows, lane })));
            }
        }
        None
    }
}

impl<'a, T: Shape + Pieces, S: Simd> AlgebraicTester<'a, T, S> {
    /// The solver, and the primitives of a block whose boxes the ray enters before `limit`, or all if there is no
    /// limit.
    #[inline(always)]
    fn candidates<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        limit: f32,
    ) -> (&mut CrossingSolver<'a>, Candidates<'_, T>) {
        let rows = (self.blocks).rows::<MAYBE_COMPACT>(block, T::NUMBERS, self.scratch, T::write);
        let mut lanes = may_meet::<T, f32, S>(self.token, rows, self.ray);
        if lanes != 0 {
            let values = BlockValues::<f32, S, f32>::new(self.token, rows);
            let boxes = stored(T::planes::<f32x8<S>>(&values));
            let limit = Lane::splat(self.token, limit);
            lanes &= slabs.enter::<IS_BEHIND>(self.token, &boxes, limit).1;
        }
        let candidates = Candidates {
            rows,
            primitives: self.blocks.bvh.lanes(block),
            exclude: self.ray.exclude,
            lanes,
            shape: PhantomData,
        };
        (&mut self.solver, candidates)
    }
}

impl<T: Shape + Pieces, S: Simd> Tester<S> for AlgebraicTester<'_, T, S> {
    type Found = Found<T>;
    type Nearest = Option<Found<T>>;

    #[inline(always)]
    fn nothing(&self) -> Option<Found<T>> {
        None
    }

    #[inline(always)]
    fn nearest<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        nearest: &mut Option<Found<T>>,
    ) {
        // Visited boxes have the same slack.
        let limit = end_slackened(self.farthest(nearest));
        let (solver, candidates) = self.candidates::<IS_BEHIND, MAYBE_COMPACT>(block, slabs, limit);
        for (primitive, shape) in candidates {
            let Some(crossing) = solver.first(&shape) else {
                continue;
            };
            let mut found = Found {
                primitive,
                shape,
                crossing,
            };
            let is_before = nearest.as_mut().is_none_or(|nearest| {
                let order = compared(solver, &mut found, nearest).into();
                precedes(order, order, found.primitive < nearest.primitive)
            });
            if is_before {
                *nearest = Some(found);
            }
        }
    }

    #[inline(always)]
    fn farthest(&self, nearest: &Option<Found<T>>) -> f32 {
        nearest.as_ref().map_or(self.ray.t_max, |nearest| {
            let farthest = nearest.crossing.t().hi as f32;
            farthest.next_up().min(self.ray.t_max)
        })
    }

    #[inline(always)]
    fn found(&self, nearest: &Option<Found<T>>) -> Option<Found<T>> {
        nearest.clone()
    }

    #[inline(always)]
    fn any<const MAYBE_COMPACT: bool>(&mut self, block: usize, slabs: &SlabRay<S>) -> bool {
        let (solver, mut candidates) =
            self.candidates::<false, MAYBE_COMPACT>(block, slabs, f32::INFINITY);
        candidates.any(|(_, shape)| solver.first(&shape).is_some())
    }

    fn all(&mut self, block: usize, slabs: &SlabRay<S>, found: &mut Vec<Found<T>>) {
        let (solver, candidates) = self.candidates::<true, true>(block, slabs, f32::INFINITY);
        for (primitive, shape) in candidates {
            for crossing in solver.crossings(&shape) {
                found.push(Found {
                    primitive,
                    shape: shape.clone(),
                    crossing,
                });
            }
        }
    }

    fn count(&mut self, block: usize) -> usize {
        let rows = (self.blocks).rows::<true>(block, T::NUMBERS, self.scratch, T::write);
        let lanes = 0..self.blocks.bvh.block(block).len();
        let shapes = lanes.map(|lane| T::read(&LaneOf { rows, lane }));
        let counts = shapes.map(|shape| self.solver.crossings(&shape).len());
        counts.sum()
    }

    fn compare(&mut self, first: &mut Found<T>, second: &mut Found<T>) -> Ordering {
        compared(&mut self.solver, first, second)
    }

    fn primitive(found: &Found<T>) -> u32 {
        found.primitive
    }

    fn hit(&mut self, mut found: Found<T>) -> Hit {
        let t = self.solver.t_in_f32(&found.shape, &mut found.crossing);
        Hit {
            t: t.min(f32::MAX),
            u: f32::from(found.crossing.part()),
            v: 0.0,
            primitive: found.primitive,
        }
    }

    fn ranked(&mut self, found: Found<T>) -> RankedHit {
        let bounds = found.crossing.t();
        let is_tangent = found.crossing.is_tangent();
        let (ray, shape, crossing) = (*self.ray, found.shape.clone(), found.crossing.clone());
        let exact = move || {
            let mut crossing = crossing.clone();
            let mut solver = CrossingSolver::new(&ray);
            solver.exact(&shape, &mut crossing).clone()
        };
        RankedHit {
            hit: self.hit(found),
            t: [bounds.lo, bounds.hi],
            exact: Some(ExactT::new(exact)),
            is_tangent,
        }
    }

    #[inline(always)]
    fn announce<const MAYBE_COMPACT: bool>(&self, block: usize) {
        (self.blocks).announce::<MAYBE_COMPACT, S>(self.token, block, T::NUMBERS);
    }

    fn work(&self) -> [u32; 2] {
        let work = self.solver.work;
        let exact = work.exact_pieces + work.exact_roots;
        [0, exact.min(u64::from(u32::MAX)) as u32]
    }
}

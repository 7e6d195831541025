//! The methods by which an intersector finds hits in blocks, orders them, and rounds them.

use super::RankedHit;
use super::blocks::{Blocks, Row};
use super::levels::Levels;
use crate::bvh::SlabRay;
use crate::ray::{Hit, Ray};
use crate::shape::{EmptyLanes, Shape};
use crate::simd::SimdLevel;
use fearless_simd::Simd;
use std::cmp::Ordering;

/// The packed primitives of a method.
pub(super) type BlocksOf<M> = Blocks<<M as Method>::Shape, <M as Method>::Stored>;

/// A way to find hits: `ranked` for kernels that decide about each primitive separately, `exact` for the kernel
/// that compares hits with each other.
pub(super) trait Method: Send + Sync + Sized + 'static {
    /// The shape of the primitives.
    type Shape: Shape;
    /// The type of the packed values.
    type Stored: Copy + Default + Send + Sync;
    /// The number of packed values per primitive.
    const VALUES: usize;
    /// The SIMD levels for which there is code.
    type Levels: Levels;
    /// The contents of lanes without a primitive.
    const EMPTY: EmptyLanes;
    /// A hit before it is rounded.
    type Found: Clone;
    /// Tests one ray.
    type Tester<'a, S: Simd>: Tester<S, Found = Self::Found>;
    /// Hits of several rays that are rounded together.
    type Batch;
    /// The number of rays whose hits are rounded together.
    const BATCH_SIZE: usize = usize::MAX;

    /// Packs a primitive.
    fn pack(shape: &Self::Shape, values: &mut [Self::Stored]);

    /// Prepares a ray.
    fn tester<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        ray: &'a Ray,
        scratch: &'a mut [Row<Self::Stored>],
    ) -> Self::Tester<'a, S>;

    /// An empty batch.
    fn batch() -> Self::Batch;

    /// Writes the nearest hit of ray `index` to `hits`, or keeps it in the batch.
    fn keep<S: Simd>(
        tester: &mut Self::Tester<'_, S>,
        nearest: Self::Found,
        index: usize,
        hits: &mut [Option<Hit>],
        batch: &mut Self::Batch,
    );

    /// Rounds the hits in the batch.
    fn round(
        _blocks: &BlocksOf<Self>,
        _level: SimdLevel,
        _rays: &[Ray],
        _batch: &Self::Batch,
        _hits: &mut [Option<Hit>],
    ) {
    }
}

/// Tests one ray against blocks.
///
/// For `IS_BEHIND` see [`SlabRay::enter`], for `MAYBE_COMPACT` see [`Blocks::rows`].
pub(super) trait Tester<S: Simd> {
    /// A hit before it is rounded.
    type Found: Clone;
    /// The nearest hit so far, or none.
    type Nearest;

    /// No hit so far.
    fn nothing(&self) -> Self::Nearest;

    /// Replaces `nearest` by the nearest hit in a block if that precedes it.
    fn nearest<const IS_BEHIND: bool, const MAYBE_COMPACT: bool>(
        &mut self,
        block: usize,
        slabs: &SlabRay<S>,
        nearest: &mut Self::Nearest,
    );

    /// The farthest t of hits that could precede `nearest`.
    fn farthest(&self, nearest: &Self::Nearest) -> f32;

    /// The hit.
    fn found(&self, nearest: &Self::Nearest) -> Option<Self::Found>;

    /// Whether a block contains any hit.
    fn any<const MAYBE_COMPACT: bool>(&mut self, block: usize, slabs: &SlabRay<S>) -> bool;

    /// Appends all hits in a block, in any order.
    fn all(&mut self, block: usize, slabs: &SlabRay<S>, found: &mut Vec<Self::Found>);

    /// The number of hits in a block, whether or not the ray meets the primitives' boxes.
    fn count(&mut self, block: usize) -> usize;

    /// Compares the t of two hits.
    fn compare(&mut self, first: &mut Self::Found, second: &mut Self::Found) -> Ordering;

    /// The hit's primitive.
    fn primitive(found: &Self::Found) -> u32;

    /// The hit, rounded.
    fn hit(&mut self, found: Self::Found) -> Hit;

    /// The hit, rounded, and its t as computed.
    fn ranked(&mut self, found: Self::Found) -> RankedHit;

    /// Prefetches a block.
    fn announce<const MAYBE_COMPACT: bool>(&self, block: usize);

    /// The number of hits that were computed again in f64, and of decisions in integers.
    fn work(&self) -> [u32; 2] {
        [0, 0]
    }
}

//! Storage of a tree's primitives in little memory; their values are packed again for every test.

use super::{Primitives, Shape};
use crate::bvh::{BLOCK_SIZE, Bvh};
use crate::simd::prefetch;
use fearless_simd::Simd;

/// Contents of lanes without a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmptyLanes {
    /// A primitive that no kernel hits.
    Nowhere,
    /// A copy of the block's first primitive.
    First,
}

/// Blocks per chunk that a thread packs.
pub(crate) const BLOCKS_AT_ONCE: usize = 1024;

/// The primitives of a tree's blocks.
pub trait CompactBlocks<S>: Sized + Send + Sync {
    /// Stores the primitives of all blocks.
    fn of(primitives: &dyn Primitives<S>, bvh: &Bvh, empty: EmptyLanes) -> Self;

    /// The primitive in a lane of a block.
    fn primitive(&self, block: usize, lane: usize) -> S;

    /// Prefetches a block.
    fn announce<I: Simd>(&self, token: I, block: usize);

    /// Size in bytes.
    fn bytes(&self) -> usize;
}

/// Primitives that share nothing, block by block.
pub struct Slots<S>(Vec<S>);

impl<S: Shape> CompactBlocks<S> for Slots<S> {
    fn of(primitives: &dyn Primitives<S>, bvh: &Bvh, empty: EmptyLanes) -> Self {
        let mut slots = Vec::with_capacity(bvh.block_count() * BLOCK_SIZE);
        for block in 0..bvh.block_count() {
            let indices = bvh.block(block);
            slots.extend(
                (0..BLOCK_SIZE).map(|lane| match (indices.get(lane), empty) {
                    (Some(&index), _) => primitives.primitive(index),
                    (None, EmptyLanes::First) => primitives.primitive(indices[0]),
                    (None, EmptyLanes::Nowhere) => S::nowhere(),
                }),
            );
        }
        Self(slots)
    }

    #[inline(always)]
    fn primitive(&self, block: usize, lane: usize) -> S {
        self.0[block * BLOCK_SIZE + lane].clone()
    }

    #[inline(always)]
    fn announce<I: Simd>(&self, token: I, block: usize) {
        prefetch(
            token,
            &self.0,
            block * BLOCK_SIZE,
            BLOCK_SIZE * size_of::<S>(),
        );
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }
}

//! Storage of a tree's primitives in little memory; their values are packed again for every test.

use super::Primitives;
use crate::bvh::Bvh;
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
    fn of(primitives: &impl Primitives<S>, bvh: &Bvh, empty: EmptyLanes) -> Self;

    /// The primitive in a lane of a block.
    fn primitive(&self, block: usize, lane: usize) -> S;

    /// Prefetches a block.
    fn announce<I: Simd>(&self, token: I, block: usize);

    /// Size in bytes.
    fn bytes(&self) -> usize;
}

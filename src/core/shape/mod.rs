//! Shapes of primitives: one file per shape.

mod compact;
mod shared_corners;
mod triangle;

pub(crate) use compact::{BLOCKS_AT_ONCE, CompactBlocks, EmptyLanes};
pub use triangle::Triangle;

use crate::aabb::Aabb;
use std::fmt::Debug;

/// The parameters of a primitive, in f32. They are the question that kernels answer.
pub trait Shape: Clone + Debug + Send + Sync + 'static {
    /// Storage for packing in little memory.
    type Compact: CompactBlocks<Self>;

    /// A primitive that no ray hits, for unused lanes.
    fn nowhere() -> Self;

    /// The primitive's box in the tree. It encloses the primitive, also as kernels recompute it from packed
    /// values. Empty or not finite if no ray can hit the primitive.
    fn bounds(&self) -> Aabb;
}

/// A list of primitives of one shape.
pub trait Primitives<S>: Send + Sync {
    /// The number of primitives.
    fn count(&self) -> usize;

    /// The primitive of an index.
    ///
    /// # Panics
    /// If the index isn't below the count.
    fn primitive(&self, index: u32) -> S;
}

impl<S: Shape> Primitives<S> for Vec<S> {
    fn count(&self) -> usize {
        self.len()
    }

    fn primitive(&self, index: u32) -> S {
        self[index as usize].clone()
    }
}

/// A function that returns the boxes of primitives, from which trees are built.
pub fn bounds_in<S: Shape>(primitives: &impl Primitives<S>) -> impl Fn(u32) -> Aabb + Sync {
    |index| primitives.primitive(index).bounds()
}

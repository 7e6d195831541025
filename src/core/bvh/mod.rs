//! Bounding volume hierarchy over boxes, with eight children per node. It doesn't depend on the type of
//! primitives in the boxes.
//!
//! [`Bvh::build`] builds it. `walk` passes the blocks of primitives that a ray meets to a visitor, nearest
//! first; `packet` passes the blocks that any of sixteen rays meets; `hybrid` splits a packet into single rays. `nearest`
//! passes the blocks near a point. `record` turns the steps of a walk into boxes.

mod build;
mod hybrid;
mod nearest;
mod packet;
mod record;
mod slab;
mod walk;

use crate::aabb::{Aabb, Planes};
use crate::simd::prefetch;
use fearless_simd::Simd;
pub(crate) use hybrid::SubtreeLists;
pub(crate) use packet::{PacketVisitor, RayPacket, Slabs};
pub(crate) use record::Step;
pub use record::{BoxContents, OpenedBox};
pub(crate) use slab::{BoxRay, SlabRay};
pub(crate) use walk::{
    LentStack, Stack, Stacks, Visitor, WALKS, Walk, end_slackened, rank, rank_floor,
};

/// Primitives per block; a SIMD test takes a whole block.
pub const BLOCK_SIZE: usize = 8;

/// Upper bound on the peak memory per primitive while a tree is built, including the finished tree: 50 bytes were measured
/// with 2 threads and 1.1 million triangles, 59 with 16 threads (2026-11).
pub(crate) const BYTES_WHILE_BUILDING: usize = 64;

/// Children per node.
pub(crate) const WIDTH: usize = 8;

/// Largest depth of a node; the root has depth 1. It keeps the stack of a walk from overflowing: on each level a node
/// defers at most seven of its children. While a packet is split, the last node defers all eight.
const MAX_DEPTH: usize = 34;

/// Largest number of blocks per leaf.
const LEAF_BLOCKS: usize = 2;

/// Marks a lane of a block without a primitive.
pub(crate) const NO_PRIMITIVE: u32 = u32::MAX;

/// A node's child: a node, a leaf, or nothing.
///
/// A leaf is a run of blocks: the highest bit is set, three bits hold the number of blocks minus one, the
/// rest holds the index of the first block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

impl Child {
    /// No child. Its box is empty, so no ray meets it.
    const NONE: Self = Self(u32::MAX);
    const LEAF: u32 = 1 << 31;
    const INDEX: u32 = (1 << 28) - 1;

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn leaf(first: usize, blocks: usize) -> Self {
        Self(Self::LEAF | (blocks as u32 - 1) << 28 | first as u32)
    }

    #[inline(always)]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    fn node_index(self) -> usize {
        self.0 as usize
    }

    #[inline(always)]
    fn first_block(self) -> usize {
        (self.0 & Self::INDEX) as usize
    }

    #[inline(always)]
    fn block_count(self) -> usize {
        (self.0 >> 28 & 7) as usize + 1
    }

    /// The same child after `nodes` nodes and `blocks` blocks were inserted before its own.
    fn moved(self, nodes: usize, blocks: usize) -> Self {
        if self == Self::NONE {
            self
        } else if self.is_leaf() {
            Self(self.0 + blocks as u32)
        } else {
            Self(self.0 + nodes as u32)
        }
    }
}

/// Eight children and their boxes: four cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Node {
    planes: Planes<[f32; WIDTH]>,
    child: [Child; WIDTH],
}

impl Node {
    /// A node without children.
    const EMPTY: Self = {
        let (lower, upper) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self {
            planes: [lower, upper, lower, upper, lower, upper],
            child: [Child::NONE; WIDTH],
        }
    };
}

/// A bounding volume hierarchy.
///
/// Sources: S. M. Rubin, T. Whitted, "A 3-Dimensional Representation for Fast Rendering of Complex
/// Scenes", SIGGRAPH 1980; H. Dammertz, J. Hanika, A. Keller, "Shallow Bounding Volume Hierarchies for
/// Fast SIMD Ray Tracing of Incoherent Rays", EGSR 2008.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The first node is the root; empty for a tree without primitives.
    nodes: Vec<Node>,
    /// The primitives of each block; unused lanes come last.
    blocks: Vec<[u32; BLOCK_SIZE]>,
    bounds: Aabb,
}

impl Bvh {
    /// The box around all primitives; [`Aabb::EMPTY`] for a tree without primitives.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The number of blocks.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// The primitives of a block.
    pub fn block(&self, index: usize) -> &[u32] {
        let lanes = self.lanes(index);
        let count = lanes.iter().position(|&p| p == NO_PRIMITIVE);
        &lanes[..count.unwrap_or(BLOCK_SIZE)]
    }

    /// The primitive in each lane of a block, or [`NO_PRIMITIVE`].
    #[inline(always)]
    pub(crate) fn lanes(&self, block: usize) -> &[u32; BLOCK_SIZE] {
        &self.blocks[block]
    }

    /// Prefetches [`lanes`](Self::lanes).
    #[inline(always)]
    pub(crate) fn announce_lanes<S: Simd>(&self, token: S, block: usize) {
        prefetch(token, &self.blocks, block, size_of::<[u32; BLOCK_SIZE]>());
    }

    /// Size of the tree in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..])
    }
}

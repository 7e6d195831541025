//! Which boxes does a ray meet, nearest first?
//!
//! A binary tree over boxes; it knows nothing of what lies in them. [`Bvh::build`] makes it,
//! [`Bvh::traverse`] hands the leaves that a ray meets to a closure.

mod build;
mod slab;
mod traverse;

use crate::aabb::Aabb;

/// Most primitives in a leaf: the lanes of one block of triangles.
pub const LEAF_SIZE: usize = 4;

/// No leaf lies deeper, so that the traversal's stack can't overflow.
const MAX_DEPTH: usize = 63;

/// A node's child: an inner node, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn leaf(index: usize) -> Self {
        Self(index as u32 | Self::LEAF)
    }

    /// The leaf's index, if it is one.
    fn as_leaf(self) -> Option<usize> {
        (self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }

    fn index(self) -> usize {
        self.0 as usize
    }
}

/// Two children, each with the box around all that lies below it.
#[derive(Clone, Debug)]
struct Node {
    bounds: [Aabb; 2],
    child: [Child; 2],
}

/// A bounding volume hierarchy: the tree over boxes.
///
/// A node is two boxes and two children; a leaf is a run of at most [`LEAF_SIZE`] primitives.
///
/// Source: S. M. Rubin, T. Whitted, "A 3-Dimensional Representation for Fast Rendering of Complex
/// Scenes", SIGGRAPH 1980.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Where each leaf's run starts in `order`, and after the last one the end.
    leaf_starts: Vec<u32>,
    /// The primitives, leaf by leaf.
    order: Vec<u32>,
    bounds: Aabb,
    /// `None` for a tree over nothing.
    root: Option<Child>,
}

impl Bvh {
    /// The box around everything; [`Aabb::EMPTY`] for a tree over nothing.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How many leaves there are.
    pub fn leaf_count(&self) -> usize {
        self.leaf_starts.len() - 1
    }

    /// The primitives of a leaf.
    pub fn leaf(&self, leaf: usize) -> &[u32] {
        &self.order[self.leaf_starts[leaf] as usize..self.leaf_starts[leaf + 1] as usize]
    }

    /// Bytes that the tree takes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.leaf_starts[..])
            + size_of_val(&self.order[..])
    }
}

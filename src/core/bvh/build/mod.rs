//! Tree builder: builds a binary tree by the surface-area heuristic, then collapses it to nodes with eight children at the
//! least cost.
//!
//! Source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007 (bins over the
//!   centroids' box); see `forest` for the second step. Differs from it: costs count blocks, as a SIMD test costs the same
//!   with full and with empty lanes; near the root several threads bin and partition a range together; below it each
//!   thread builds and later collapses whole subtrees, whose nodes are joined at the end.

mod binary;
mod collapse;
mod forest;
mod join;
mod partition;
mod quick;
mod split;
#[cfg(test)]
mod tests;
mod unbounded;

use super::{BLOCK_SIZE, Bvh, Child, LEAF_BLOCKS, MAX_DEPTH, NO_PRIMITIVE, Node, WIDTH};
use crate::aabb::Aabb;
use crate::progress::Cancelled;
use binary::Builder;
use collapse::Collapse;
use glam::{Vec3A, Vec4};
use join::joined;
use rayon::prelude::*;
use split::Scale;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Subtrees with fewer primitives are built by one thread.
const MIN_JOB_SIZE: usize = 4096;
/// Smallest number of subtrees that the threads share.
const MIN_JOB_COUNT: usize = 256;
/// The most levels of a binary tree. A node with eight children usually replaces three levels, so nodes are rarely deeper
/// than [`MAX_DEPTH`]. If one is, the tree is built again with at most `MAX_DEPTH` levels.
const USUAL_LEVELS: usize = 128;

/// A primitive during the build: its box and its index.
///
/// The fourth lane of each corner holds half of the index as the low bits of a number from 1 to 2. The index itself,
/// interpreted as an f32, would be a subnormal number, on which an operation takes an Intel processor some 150 cycles.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Item {
    lower: Vec4,
    upper: Vec4,
}

impl Item {
    fn new(bounds: Aabb, index: u32) -> Self {
        let half = |bits: u32| f32::from_bits(1.0f32.to_bits() | bits & 0xffff);
        Self {
            lower: bounds.min.extend(half(index)),
            upper: bounds.max.extend(half(index >> 16)),
        }
    }

    fn index(&self) -> u32 {
        let bits = |half: f32| half.to_bits() & 0xffff;
        bits(self.lower.w) | bits(self.upper.w) << 16
    }

    #[inline(always)]
    fn bounds(&self) -> Bounds {
        Bounds {
            lower: Vec3A::from_vec4(self.lower),
            upper: Vec3A::from_vec4(self.upper),
        }
    }
}

/// The primitives that rays can hit: those whose boxes aren't empty and hold no NaN or infinity.
fn items_of(count: usize, bounds_of: BoundsOf) -> Vec<Item> {
    let has_invalid = AtomicBool::new(false);
    let item = |index| {
        let bounds = bounds_of(index);
        let is_valid = !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite();
        if is_valid {
            return Item::new(bounds, index);
        }
        has_invalid.store(true, Relaxed);
        Item::new(Aabb::EMPTY, index)
    };
    // Written in place by several threads, which a filter couldn't do.
    let indices = (0..count as u32).into_par_iter();
    let mut items: Vec<Item> = indices.map(item).collect();
    if has_invalid.into_inner() {
        items.retain(|item| item.lower.x <= item.upper.x);
    }
    items
}

/// A box in registers.
#[derive(Clone, Copy)]
struct Bounds {
    lower: Vec3A,
    upper: Vec3A,
}

impl Bounds {
    const EMPTY: Self = Self {
        lower: Vec3A::INFINITY,
        upper: Vec3A::NEG_INFINITY,
    };

    #[inline(always)]
    fn grow(&mut self, other: Self) {
        self.lower = self.lower.min(other.lower);
        self.upper = self.upper.max(other.upper);
    }
}

impl From<Bounds> for Aabb {
    fn from(bounds: Bounds) -> Self {
        Self {
            min: bounds.lower.into(),
            max: bounds.upper.into(),
        }
    }
}

/// A run of primitives with the box around them and the box around their centres.
struct Range<'a> {
    items: &'a mut [Item],
    bounds: Bounds,
    centres: Bounds,
}

/// A part of the tree; its nodes and blocks are numbered from 0.
#[derive(Default)]
struct Subtree {
    nodes: Vec<Node>,
    blocks: Vec<[u32; BLOCK_SIZE]>,
}

/// A part of the tree whose children are made by several threads.
enum Part {
    /// Made by one thread: the root and the tree below it.
    Subtree(Child, Subtree),
    /// A node and its children.
    Node(Box<Node>, Vec<Part>),
}

/// A function that returns the box of a primitive.
type BoundsOf<'a> = &'a (dyn Fn(u32) -> Aabb + Sync);

type KeepGoing<'a> = &'a (dyn Fn() -> Result<(), Cancelled> + Sync);

impl Bvh {
    /// Builds a tree over `count` primitives; `bounds_of` gives the box of each.
    ///
    /// Primitives whose boxes are empty or hold a NaN or an infinity are omitted: no ray can hit them.
    /// `keep_going` is called while the binary tree is built, which takes nearly all the time. The result doesn't depend on
    /// the number of threads.
    ///
    /// # Errors
    /// [`Cancelled`] if `keep_going` returned it.
    pub fn build(
        count: usize,
        bounds_of: BoundsOf,
        keep_going: KeepGoing,
    ) -> Result<Self, Cancelled> {
        keep_going()?;
        let mut items = items_of(count, bounds_of);
        let build = Build::new(&items, keep_going);
        let mut bvh = Self {
            nodes: Vec::new(),
            blocks: Vec::new(),
            bounds: build.bounds.into(),
        };
        if items.is_empty() {
            return Ok(bvh);
        }
        let part = match build.collapsed(&mut items, USUAL_LEVELS, MAX_DEPTH)? {
            Some(part) => part,
            None => build
                .collapsed(&mut items, MAX_DEPTH, MAX_DEPTH)?
                .expect("a node is no deeper than its binary tree"),
        };
        let (tree, ()) = rayon::join(|| joined(part), || drop(items));
        (bvh.nodes, bvh.blocks) = (tree.nodes, tree.blocks);
        Ok(bvh)
    }
}

/// Parameters of a build.
#[derive(Clone, Copy)]
struct Build<'k> {
    bounds: Bounds,
    scale: Scale,
    keep_going: KeepGoing<'k>,
    /// Trees of at most this many primitives are built and collapsed by one thread.
    job_size: usize,
}

impl<'k> Build<'k> {
    fn new(items: &[Item], keep_going: KeepGoing<'k>) -> Self {
        let bounds = split::around(items);
        Self {
            bounds,
            scale: Scale::of(bounds),
            keep_going,
            job_size: (items.len() / MIN_JOB_COUNT).max(MIN_JOB_SIZE),
        }
    }

    /// Builds a binary tree of at most `levels` levels and collapses it. Returns `None` if a node would be deeper than
    /// `max_depth`, which is impossible with that many levels.
    fn collapsed(
        &self,
        items: &mut [Item],
        levels: usize,
        max_depth: usize,
    ) -> Result<Option<Part>, Cancelled> {
        let range = Range {
            centres: self.scale.centres(items),
            bounds: self.bounds,
            items,
        };
        let (tree, _) = Builder::new(*self, levels).tree(range, 0, 0)?;
        let collapse = Collapse {
            items,
            job_size: self.job_size,
            max_depth,
        };
        Ok(collapse.root(tree))
    }
}

impl Node {
    fn set_bounds(&mut self, slot: usize, bounds: Aabb) {
        let (lower, upper) = (bounds.min.to_array(), bounds.max.to_array());
        for axis in 0..3 {
            self.planes[2 * axis][slot] = lower[axis];
            self.planes[2 * axis + 1][slot] = upper[axis];
        }
    }
}

//! Top-down tree builder: splits directly into eight children, by the surface-area heuristic.
//!
//! Source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007 (bins over the
//!   centroids' box). Differs from it: a node's largest child is split until there are eight; costs count
//!   blocks, as a SIMD test costs the same with full and with empty lanes; near the root several threads bin
//!   and partition a range together; below it each thread builds separate subtrees, which are joined at the end.

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
use glam::{Vec3A, Vec4};
use join::joined;
use rayon::prelude::*;
use split::{Scale, Splitter};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Subtrees with fewer primitives are built by one thread.
const MIN_JOB_SIZE: usize = 4096;
/// Smallest number of subtrees that the threads share.
const MIN_JOB_COUNT: usize = 256;
/// Ranges with fewer primitives are built without a check for cancellation.
const CANCELLABLE_FROM: usize = 1024;

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

/// A part of the tree whose children are built by several threads.
enum Part {
    /// Built by one thread: the root and the tree below it.
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
    /// `keep_going` is called periodically. The result doesn't depend on the number of threads.
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
        let bounds = split::around(&items);
        let scale = Scale::of(bounds);
        let mut bvh = Self {
            nodes: Vec::new(),
            blocks: Vec::new(),
            bounds: bounds.into(),
        };
        if items.is_empty() {
            return Ok(bvh);
        }
        let range = Range {
            centres: scale.centres(&items),
            bounds,
            items: &mut items,
        };
        let parts = Parts {
            scale,
            keep_going,
            job_size: (count / MIN_JOB_COUNT).max(MIN_JOB_SIZE),
        };
        let root = parts.root(range)?;
        let (tree, ()) = rayon::join(|| joined(root), || drop(items));
        (bvh.nodes, bvh.blocks) = (tree.nodes, tree.blocks);
        Ok(bvh)
    }
}

/// Builds the top of the tree, where several threads share the work.
struct Parts<'k> {
    scale: Scale,
    keep_going: KeepGoing<'k>,
    /// Ranges of at most this many primitives are built by one thread.
    job_size: usize,
}

impl<'k> Parts<'k> {
    fn builder(&self) -> Builder<'k> {
        Builder {
            splitter: Splitter::new(self.scale),
            keep_going: self.keep_going,
            tree: Subtree::default(),
        }
    }

    /// Builds the root. It is a node even if the tree has one leaf, so that its box is tested.
    fn root(&self, range: Range) -> Result<Part, Cancelled> {
        let mut builder = self.builder();
        match builder.split(range, 0) {
            Ok(halves) => self.node(builder, halves, 0),
            Err(range) => {
                let mut node = Node::EMPTY;
                node.set_bounds(0, range.bounds);
                let leaf = builder.leaf(range.items);
                Ok(Part::Node(
                    Box::new(node),
                    vec![Part::Subtree(leaf, builder.tree)],
                ))
            }
        }
    }

    fn part(&self, range: Range, depth: usize) -> Result<Part, Cancelled> {
        let mut builder = self.builder();
        if range.items.len() <= self.job_size {
            let root = builder.child(range, depth)?;
            return Ok(Part::Subtree(root, builder.tree));
        }
        match builder.split(range, depth) {
            Ok(halves) => self.node(builder, halves, depth),
            Err(range) => Ok(Part::Subtree(builder.leaf(range.items), builder.tree)),
        }
    }

    /// Builds a node above the two ranges.
    fn node(
        &self,
        mut builder: Builder,
        halves: [Range; 2],
        depth: usize,
    ) -> Result<Part, Cancelled> {
        let (node, ranges) = builder.ranges(halves, depth)?;
        drop(builder);
        let parts = ranges.into_par_iter().with_max_len(1);
        let parts = parts.map(|range| self.part(range, depth + 1));
        Ok(Part::Node(Box::new(node), parts.collect::<Result<_, _>>()?))
    }
}

/// Builds a subtree.
struct Builder<'k> {
    splitter: Splitter,
    keep_going: KeepGoing<'k>,
    tree: Subtree,
}

impl Builder<'_> {
    /// Builds a range as a node or a leaf.
    fn child(&mut self, range: Range, depth: usize) -> Result<Child, Cancelled> {
        match self.split(range, depth) {
            Ok(halves) => self.node(halves, depth),
            Err(range) => Ok(self.leaf(range.items)),
        }
    }

    /// Splits a range in two, or returns it if a leaf is cheaper.
    fn split<'a>(&mut self, range: Range<'a>, depth: usize) -> Result<[Range<'a>; 2], Range<'a>> {
        let count = range.items.len();
        if count <= BLOCK_SIZE {
            return Err(range);
        }
        // Halving by index keeps depth + log₂(n) ≤ MAX_DEPTH for any input.
        if depth + count.ilog2() as usize + 2 > MAX_DEPTH {
            return Ok(self.splitter.halve(range));
        }
        self.splitter.split(range)
    }

    /// Builds a node above the two ranges.
    fn node(&mut self, halves: [Range; 2], depth: usize) -> Result<Child, Cancelled> {
        let (node, ranges) = self.ranges(halves, depth)?;
        let index = self.tree.nodes.len();
        self.tree.nodes.push(node);
        for (slot, range) in ranges.into_iter().enumerate() {
            self.tree.nodes[index].child[slot] = self.child(range, depth + 1)?;
        }
        Ok(Child::node(index))
    }

    /// Splits two ranges further until there are eight; returns them and a node with their boxes.
    fn ranges<'a>(
        &mut self,
        [first, second]: [Range<'a>; 2],
        depth: usize,
    ) -> Result<(Node, Vec<Range<'a>>), Cancelled> {
        if first.items.len() + second.items.len() >= CANCELLABLE_FROM {
            (self.keep_going)()?;
        }
        let mut ranges: [Option<Range<'a>>; WIDTH] = [const { None }; WIDTH];
        // The area of each range that may be split again, else 0.
        let mut weight = [0.0; WIDTH];
        (weight[0], weight[1]) = (self.weight(&first), self.weight(&second));
        (ranges[0], ranges[1]) = (Some(first), Some(second));
        for count in 2..WIDTH {
            let Some((slot, range)) = take_largest(&mut ranges, &mut weight) else {
                break;
            };
            match self.split(range, depth) {
                Ok([first, second]) => {
                    (weight[slot], weight[count]) = (self.weight(&first), self.weight(&second));
                    (ranges[slot], ranges[count]) = (Some(first), Some(second));
                }
                Err(range) => ranges[slot] = Some(range),
            }
        }
        let ranges: Vec<Range<'a>> = ranges.into_iter().flatten().collect();
        let mut node = Node::EMPTY;
        for (slot, range) in ranges.iter().enumerate() {
            node.set_bounds(slot, range.bounds);
        }
        Ok((node, ranges))
    }

    fn weight(&self, range: &Range) -> f32 {
        if range.items.len() > BLOCK_SIZE {
            let area = self.splitter.scale.half_area(range.bounds);
            area.max(f32::MIN_POSITIVE)
        } else {
            0.0
        }
    }

    fn leaf(&mut self, items: &[Item]) -> Child {
        debug_assert!(items.len() <= LEAF_BLOCKS * BLOCK_SIZE);
        let first = self.tree.blocks.len();
        for part in items.chunks(BLOCK_SIZE) {
            let mut block = [NO_PRIMITIVE; BLOCK_SIZE];
            for (lane, item) in block.iter_mut().zip(part) {
                *lane = item.index();
            }
            self.tree.blocks.push(block);
        }
        Child::leaf(first, self.tree.blocks.len() - first)
    }
}

/// Takes the range with the largest weight from its slot and sets that weight to 0. Of equal weights, which
/// identical boxes have, takes the range with more primitives.
fn take_largest<'a>(
    ranges: &mut [Option<Range<'a>>; WIDTH],
    weight: &mut [f32; WIDTH],
) -> Option<(usize, Range<'a>)> {
    let count = |slot: usize| ranges[slot].as_ref().map_or(0, |range| range.items.len());
    let by_weight = |&a: &usize, &b: &usize| {
        let by_weight = weight[a].total_cmp(&weight[b]);
        by_weight.then(count(a).cmp(&count(b)))
    };
    let slot = (0..WIDTH)
        .max_by(by_weight)
        .filter(|&slot| weight[slot] > 0.0)?;
    weight[slot] = 0.0;
    Some((slot, ranges[slot].take()?))
}

impl Node {
    fn set_bounds(&mut self, slot: usize, bounds: Bounds) {
        let (lower, upper) = (bounds.lower.to_array(), bounds.upper.to_array());
        for axis in 0..3 {
            self.planes[2 * axis][slot] = lower[axis];
            self.planes[2 * axis + 1][slot] = upper[axis];
        }
    }
}

//! Traversal of the blocks that a ray meets, nearest first.
//!
//! A walk never omits a block whose hits could count, and the hits that count don't depend on the tree. A
//! kernel may accept a ray that passes outside the triangle, at a t that lies before it; for slivers and
//! triangles seen edge-on the error exceeds any padding. So a hit counts if
//!
//! 1. the ray meets the triangle's own box (see [`triangle_bounds`](crate::kernel::triangle_bounds)), by the
//!    same padded operations as the tree's boxes; and it ranks
//! 2. by its t, but as no nearer than [`rank_floor`] of the distance at which the ray enters that box.
//!
//! Both depend on the ray and the triangle alone. A box of the tree encloses the boxes of the triangles below
//! it, and each operation that computes where a ray enters and leaves it is monotone in its planes, rounded
//! or not. So the ray also meets the tree's box, and enters it no later. The walk skips a box only if the ray
//! enters it behind the best rank so far; all hits in it then rank behind that. The hits of the exact kernel
//! lie in their boxes and are ordered exactly, so it needs neither rule. `slab` derives the padding that a
//! box needs for the hits that its triangles' kernels are right to accept.

use super::hybrid::SubtreeLists;
use super::slab::SlabRay;
use super::{Bvh, Child, MAX_DEPTH, Node, WIDTH};
use crate::lane::Lane;
use crate::ray::Ray;
use crate::simd::prefetch;
use fearless_simd::{Simd, f32x8};
use std::cell::Cell;
use std::ops::ControlFlow;

/// Relative distance by which boxes are visited beyond the farthest t of interest and beyond the interval's
/// ends: 24 ulp. It exceeds [`RANK_SLACK`] by 8 ulp for the rounding of either product.
const SLACK: f32 = 24.0 * f32::EPSILON;

/// Relative distance by which a hit may rank before its box's entry: 16 ulp.
///
/// A kernel rounds t some nine times and an entry is rounded three times. So of hits at equal t in two boxes
/// one may be reported before its box is entered, yet the lowest triangle must count. Measured on overlapping
/// triangles in one plane, where this shows: of 5 M rays the lowest triangle lost 15 with 3 ulp, 9 with 4, 5
/// with 8, none with 16 (with the leaf's box, which is entered no later, 2026-11). With kernels
/// that decide exactly, 3 ulp suffice in all known cases: none of 18 M rays at 40 such meshes hit another
/// triangle (2026-11).
const RANK_SLACK: f32 = 16.0 * f32::EPSILON;

/// Deferred children: the bits of the distance at which the ray enters them, above the child. Nearer children
/// compare less. A one-byte index can't leave the stack; the tree's depth keeps it from wrapping.
pub(crate) type Stack = [u64; 256];

const _: () = assert!(MAX_DEPTH * (WIDTH - 1) + 1 < 256);

/// The number of interleaved walks, each with its own stack; see [`interleaved`](crate::intersector::interleaved).
pub(crate) const WALKS: usize = 8;

/// The stacks of interleaved walks.
pub(crate) type Stacks = [Stack; WALKS];

/// The scratch memory of a thread's walks.
struct WalkScratch {
    stacks: Stacks,
    lists: SubtreeLists,
}

thread_local! {
    static SPARE: Cell<Option<Box<WalkScratch>>> = const { Cell::new(None) };
}

/// Scratch memory that returns to its thread when dropped. Zeroing a stack for each ray costs 10 to 25 % (2026-11).
pub(crate) struct LentStack(Option<Box<WalkScratch>>);

impl LentStack {
    /// The thread's scratch memory, or new memory if that is lent.
    pub fn new() -> Self {
        Self(SPARE.take())
    }

    /// The stack of one walk.
    pub fn get(&mut self) -> &mut Stack {
        &mut self.all()[0]
    }

    /// The stack of one walk, and the lists of a packet's rays.
    pub fn with_lists(&mut self) -> (&mut Stack, &mut SubtreeLists) {
        let scratch = self.scratch();
        (&mut scratch.stacks[0], &mut scratch.lists)
    }

    /// The stacks of interleaved walks.
    pub fn all(&mut self) -> &mut Stacks {
        &mut self.scratch().stacks
    }

    fn scratch(&mut self) -> &mut WalkScratch {
        self.0.get_or_insert_with(|| {
            Box::new(WalkScratch {
                stacks: [[0; 256]; WALKS],
                lists: SubtreeLists::EMPTY,
            })
        })
    }
}

impl Drop for LentStack {
    fn drop(&mut self) {
        SPARE.set(self.0.take());
    }
}

/// Handler of the blocks that a ray meets.
pub(crate) trait Visitor<S: Simd> {
    /// Whether the ray's interval may begin behind its origin.
    const IS_BEHIND: bool;

    /// Whether a tree's only block is visited only by rays that meet its box. Hits don't depend on that test, but lists of
    /// boxes and candidates do.
    const NEEDS_BOX_TEST: bool;

    /// Processes a block and returns the farthest t of interest; a break ends the walk. Boxes at exactly that
    /// distance and a little behind it are still visited.
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32>;

    /// Announces a block that will be visited soon, unless a hit makes that unnecessary.
    fn announce(&self, block: usize);

    /// Notes that a node is opened: its [`WIDTH`] boxes are tested.
    fn open(&mut self, node: usize);
}

/// Lower bound of a hit's rank in a box entered at `entry`.
#[inline(always)]
pub(crate) fn rank_floor<L: Lane>(entry: L) -> L {
    entry - entry.abs() * L::of(entry.token(), RANK_SLACK)
}

/// A hit's rank; see [`rank_floor`].
#[inline(always)]
pub(crate) fn rank<L: Lane>(t: L, floor: L) -> L {
    L::select(t.lt(floor), floor, t)
}

/// The state of a ray's walk through a tree, which is at a node or a leaf.
pub(crate) struct Walk<S: Simd> {
    slabs: SlabRay<S>,
    /// The distance up to which boxes are visited; −∞ once the visitor has ended the walk.
    limit: f32,
    /// The number of deferred children.
    depth: u8,
    /// The node or leaf.
    // Not its key: the address of the next node would have to wait for the distance.
    current: Child,
}

impl<S: Simd> Walk<S> {
    /// A walk at the root of a tree, which must not be empty.
    #[inline(always)]
    pub fn start(token: S, ray: &Ray) -> Self {
        Self {
            slabs: SlabRay::new(token, ray, start_slackened(ray.t_min)),
            limit: end_slackened(ray.t_max),
            depth: 0,
            current: Child::node(0),
        }
    }

    /// Opens the node, or passes the leaf's blocks to the visitor, and goes on to the next node or leaf. Returns whether
    /// the walk has ended.
    #[inline(always)]
    pub fn step<V: Visitor<S>>(
        &mut self,
        bvh: &Bvh,
        token: S,
        stack: &mut Stack,
        visitor: &mut V,
    ) -> bool {
        let child = self.current;
        if child.is_leaf() {
            let (start, count) = (child.first_block(), child.block_count());
            for block in start..start + count {
                match visitor.visit(block, &self.slabs) {
                    ControlFlow::Continue(t) => self.limit = end_slackened(t),
                    ControlFlow::Break(()) => {
                        self.limit = f32::NEG_INFINITY;
                        return true;
                    }
                }
            }
        } else if self.open(bvh, token, child.node_index(), stack, visitor) {
            return false;
        }
        self.pop(stack)
    }

    /// Goes to the nearest child of a node that the ray meets, and defers the others. Returns whether the ray meets any.
    #[inline(always)]
    fn open<V: Visitor<S>>(
        &mut self,
        bvh: &Bvh,
        token: S,
        index: usize,
        stack: &mut Stack,
        visitor: &mut V,
    ) -> bool {
        let node = &bvh.nodes[index];
        visitor.open(index);
        let far: f32x8<S> = Lane::splat(token, self.limit);
        let (entries, mut met) = if V::IS_BEHIND {
            self.slabs.enter::<true>(token, &node.planes, far)
        } else {
            self.slabs.enter::<false>(token, &node.planes, far)
        };
        if met == 0 {
            return false;
        }
        let a = bvh.next(token, &mut met, &node.child, &entries, visitor);
        if met == 0 {
            self.current = child_of(a);
            return true;
        }
        let (first, mut depth) = (self.depth, self.depth);
        let b = bvh.next(token, &mut met, &node.child, &entries, visitor);
        let (mut nearest, mut farther) = (a.min(b), a.max(b));
        // Sort two and three children without unpredictable branches.
        if met != 0 {
            let c = bvh.next(token, &mut met, &node.child, &entries, visitor);
            stack[usize::from(depth)] = farther.max(c);
            depth = depth.wrapping_add(1);
            let middle = farther.min(c);
            (nearest, farther) = (nearest.min(middle), nearest.max(middle));
        }
        stack[usize::from(depth)] = farther;
        depth = depth.wrapping_add(1);
        while met != 0 {
            let next = bvh.next(token, &mut met, &node.child, &entries, visitor);
            insert(stack, first, depth, nearest.max(next));
            nearest = nearest.min(next);
            depth = depth.wrapping_add(1);
        }
        (self.current, self.depth) = (child_of(nearest), depth);
        true
    }

    /// Goes to the last deferred child that doesn't lie behind the hit. Returns whether there is none.
    #[inline(always)]
    fn pop(&mut self, stack: &Stack) -> bool {
        let mut depth = self.depth;
        while depth != 0 {
            depth -= 1;
            let key = stack[usize::from(depth)];
            if entry_of(key) <= self.limit {
                (self.current, self.depth) = (child_of(key), depth);
                return false;
            }
        }
        true
    }
}

impl Bvh {
    /// Passes each block that the ray meets to the visitor.
    #[inline(always)]
    pub(crate) fn walk<S: Simd, V: Visitor<S>>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        visitor: &mut V,
    ) {
        if !self.nodes.is_empty() {
            let mut walk = Walk::start(token, ray);
            if self.block_count() == 1 && !V::NEEDS_BOX_TEST {
                // Hits don't depend on the box test of a single block, so it is skipped.
                _ = visitor.visit(0, &walk.slabs);
                return;
            }
            while !walk.step(self, token, stack, visitor) {}
        }
    }

    /// Passes to the visitor each block that the ray meets in the subtrees with these keys, nearest first.
    #[inline(always)]
    pub(crate) fn walk_subtrees<S: Simd, V: Visitor<S>>(
        &self,
        token: S,
        ray: &Ray,
        keys: &[u64],
        stack: &mut Stack,
        visitor: &mut V,
    ) {
        let mut walk = Walk::start(token, ray);
        // A plain loop: functions called by an iterator may be compiled without the CPU's features.
        let mut i = 0;
        while i < keys.len() {
            if entry_of(keys[i]) <= walk.limit {
                (walk.current, walk.depth) = (child_of(keys[i]), 0);
                while !walk.step(self, token, stack, visitor) {}
            }
            i += 1;
        }
    }

    /// Removes the lowest child from `met`, prefetches it and returns its key.
    #[inline(always)]
    fn next<S: Simd, V: Visitor<S>>(
        &self,
        token: S,
        met: &mut u32,
        child: &[Child; WIDTH],
        entries: &[f32; WIDTH],
        visitor: &V,
    ) -> u64 {
        let lane = met.trailing_zeros() as usize % WIDTH;
        *met &= *met - 1;
        let child = child[lane];
        if child.is_leaf() {
            visitor.announce(child.first_block());
        } else {
            prefetch(token, &self.nodes, child.node_index(), size_of::<Node>());
        }
        key(entries[lane], child)
    }
}

/// Inserts a key between `first` and `depth`, sorted so that the nearest is last.
#[inline(always)]
pub(super) fn insert(stack: &mut Stack, first: u8, depth: u8, key: u64) {
    let mut at = depth;
    while at > first && stack[usize::from(at.wrapping_sub(1))] < key {
        stack[usize::from(at)] = stack[usize::from(at.wrapping_sub(1))];
        at = at.wrapping_sub(1);
    }
    stack[usize::from(at)] = key;
}

#[inline(always)]
pub(super) fn key(entry: f32, child: Child) -> u64 {
    u64::from(entry.to_bits()) << 32 | u64::from(child.0)
}

#[inline(always)]
pub(super) fn child_of(key: u64) -> Child {
    Child(key as u32)
}

#[inline(always)]
pub(super) fn entry_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// The distance up to which boxes are visited for hits before `t`.
#[inline(always)]
pub(crate) fn end_slackened<L: Lane>(t: L) -> L {
    t + t.abs() * L::of(t.token(), SLACK)
}

/// The distance from which boxes are visited for hits behind `t`.
#[inline(always)]
pub(super) fn start_slackened<L: Lane>(t: L) -> L {
    t - t.abs() * L::of(t.token(), SLACK)
}

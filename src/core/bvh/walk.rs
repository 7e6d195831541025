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

const _: () = assert!(MAX_DEPTH * (WIDTH - 1) < 256);

thread_local! {
    static SPARE: Cell<Option<Box<Stack>>> = const { Cell::new(None) };
}

/// A stack that returns to its thread when dropped. Zeroing a stack for each ray costs 10 to 25 % (2026-11).
pub(crate) struct LentStack(Option<Box<Stack>>);

impl LentStack {
    /// The thread's stack, or a new one if that is lent.
    pub fn new() -> Self {
        Self(SPARE.take())
    }

    pub fn get(&mut self) -> &mut Stack {
        self.0.get_or_insert_with(|| Box::new([0; 256]))
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

impl Bvh {
    /// Passes each block that the ray meets to the visitor. In one piece, because a part of its own that changed the
    /// depth of the stack cost 3 % (bunny, 2026-11).
    #[inline(always)]
    pub(crate) fn walk<S: Simd, V: Visitor<S>>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        visitor: &mut V,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let slabs = SlabRay::new(token, ray, start_slackened(ray.t_min));
        let mut limit = end_slackened(ray.t_max);
        let mut far: f32x8<S> = Lane::splat(token, limit);
        let mut depth = 0u8;
        let mut current = key(ray.t_min, Child::node(0));
        loop {
            while !child_of(current).is_leaf() {
                let index = child_of(current).node_index();
                let node = &self.nodes[index];
                visitor.open(index);
                let (entries, mut met) = if V::IS_BEHIND {
                    slabs.enter::<true>(token, &node.planes, far)
                } else {
                    slabs.enter::<false>(token, &node.planes, far)
                };
                if met == 0 {
                    current = NOTHING;
                    break;
                }
                let a = self.next(token, &mut met, &node.child, &entries, visitor);
                if met == 0 {
                    current = a;
                    continue;
                }
                let first = depth;
                let b = self.next(token, &mut met, &node.child, &entries, visitor);
                let (mut nearest, mut farther) = (a.min(b), a.max(b));
                // Sort two and three children without unpredictable branches.
                if met != 0 {
                    let c = self.next(token, &mut met, &node.child, &entries, visitor);
                    stack[usize::from(depth)] = farther.max(c);
                    depth = depth.wrapping_add(1);
                    let middle = farther.min(c);
                    (nearest, farther) = (nearest.min(middle), nearest.max(middle));
                }
                stack[usize::from(depth)] = farther;
                depth = depth.wrapping_add(1);
                while met != 0 {
                    let next = self.next(token, &mut met, &node.child, &entries, visitor);
                    insert(stack, first, depth, nearest.max(next));
                    nearest = nearest.min(next);
                    depth = depth.wrapping_add(1);
                }
                current = nearest;
            }
            if current != NOTHING {
                let leaf = child_of(current);
                let (start, count) = (leaf.first_block(), leaf.block_count());
                for block in start..start + count {
                    match visitor.visit(block, &slabs) {
                        ControlFlow::Continue(t) => limit = end_slackened(t),
                        ControlFlow::Break(()) => return,
                    }
                }
                far = Lane::splat(token, limit);
            }
            // Pop a deferred child, skipping those that now lie behind the hit.
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                current = stack[usize::from(depth)];
                if entry_of(current) <= limit {
                    break;
                }
            }
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

/// Key of no child; compares greater than all others.
pub(super) const NOTHING: u64 = u64::MAX;

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

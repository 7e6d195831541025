//! Visiting the blocks that a ray meets, nearest first.
//!
//! A walk never leaves out what could still count, and what counts doesn't depend on the tree. A kernel may
//! accept a ray that passes beside the triangle, at a t that lies before it, by more than any padding would
//! cover where the triangle is a sliver or seen edge-on. So its hit counts if
//!
//! 1. the ray meets the triangle's own box (see [`triangle_bounds`](crate::kernel::triangle_bounds)), by the
//!    same padded operations as the tree's; and it ranks
//! 2. by its t, but as no nearer than [`rank_floor`] of where the ray enters that box.
//!
//! Both are of the ray and the triangle alone. A box of the tree holds the boxes of the triangles below it, and
//! each operation that tells where a ray enters and leaves it is monotone in its planes, rounded or not: so
//! the ray meets it, too, and enters it no later. The walk puts it aside only if the ray enters it behind the
//! best rank so far, and with it only hits that rank behind that. The exact kernel's hits lie in their boxes
//! and are ordered exactly: it needs neither. That a box is padded enough for what its
//! triangles' kernels are right to accept is another matter: see `slab`.

use super::slab::SlabRay;
use super::{Bvh, Child, MAX_DEPTH, Node, WIDTH};
use crate::lane::Lane;
use crate::ray::Ray;
use crate::simd::prefetch;
use fearless_simd::{Simd, f32x8};
use std::cell::RefCell;
use std::ops::ControlFlow;

/// How much farther than the farthest t of interest, and how much beyond the interval's ends, boxes are
/// visited, relatively: 24 ulp. By 8 more than hits rank before their boxes' entries, for the rounding of
/// either product.
const SLACK: f32 = 24.0 * f32::EPSILON;

/// How much nearer than its box's entry a hit may rank, relatively: 16 ulp.
///
/// A kernel's t is rounded some nine times and an entry three, so that of hits at equal t in two boxes one
/// may be reported before its box is entered, and the lowest triangle is to count. Measured on overlapping
/// triangles in one plane, where that shows: of 5 M rays the lowest triangle lost 15 with 3 ulp, 9 with
/// 4, 5 with 8, none with 16 (with the leaf's box, which is entered no later, 2026-11).
const RANK_SLACK: f32 = 16.0 * f32::EPSILON;

/// Children that were put off: the bits of where the ray enters them, above the child. Nearer ones are
/// smaller. An index of one byte can't leave it; the tree's depth keeps it from wrapping.
pub(crate) type Stack = [u64; 256];

const _: () = assert!(MAX_DEPTH * (WIDTH - 1) < 256);

/// Lends the thread's stack, which mustn't be asked for again meanwhile. To zero one for each ray costs 10
/// to 25 % (2026-11).
pub(crate) fn with_stack<T>(walk: impl FnOnce(&mut Stack) -> T) -> T {
    thread_local! {
        static STACK: RefCell<Stack> = const { RefCell::new([0; 256]) };
    }
    STACK.with_borrow_mut(walk)
}

/// What is done with the blocks that a ray meets.
pub(crate) trait Visitor<S: Simd> {
    /// Whether the ray's interval may begin behind its origin.
    const IS_BEHIND: bool;

    /// Looks at a block, and returns the farthest t that is still of interest; a break ends the walk. Boxes
    /// at exactly that distance are still visited, and those a little behind it.
    fn visit(&mut self, block: usize, slabs: &SlabRay<S>) -> ControlFlow<(), f32>;

    /// A block will be visited soon, unless a hit comes in between.
    fn announce(&self, block: usize);

    /// So many boxes were tested.
    fn count_boxes(&mut self, count: u32);
}

/// The least that a hit is ranked by in a box entered at `entry`.
#[inline(always)]
pub(crate) fn rank_floor<L: Lane>(entry: L) -> L {
    entry - entry.abs() * L::of(entry.token(), RANK_SLACK)
}

/// What a hit is ranked by; see [`rank_floor`].
#[inline(always)]
pub(crate) fn rank<L: Lane>(t: L, floor: L) -> L {
    L::select(t.lt(floor), floor, t)
}

impl Bvh {
    /// Hands each block that the ray meets to the visitor.
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
                let node = &self.nodes[child_of(current).node_index()];
                visitor.count_boxes(WIDTH as u32);
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
                // All this in line: a function of its own, which must be lent the depth, costs 3 %
                // (bunny, 2026-11).
                let first = depth;
                let b = self.next(token, &mut met, &node.child, &entries, visitor);
                let (mut nearest, mut farther) = (a.min(b), a.max(b));
                // Two and three are sorted without branches that nobody could foretell.
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
            // Back to what was put off, but for what has since turned out to lie behind the hit.
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

    /// Takes the lowest child out of `met`, and asks for it.
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

/// Puts a key among those from `first` to `depth`, the nearest last.
#[inline(always)]
pub(super) fn insert(stack: &mut Stack, first: u8, depth: u8, key: u64) {
    let mut at = depth;
    while at > first && stack[usize::from(at.wrapping_sub(1))] < key {
        stack[usize::from(at)] = stack[usize::from(at.wrapping_sub(1))];
        at = at.wrapping_sub(1);
    }
    stack[usize::from(at)] = key;
}

/// No child: behind all others.
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

/// Until where boxes are visited that lie before `t`.
#[inline(always)]
pub(super) fn end_slackened<L: Lane>(t: L) -> L {
    t + t.abs() * L::of(t.token(), SLACK)
}

/// From where on boxes are visited that lie behind `t`.
#[inline(always)]
pub(super) fn start_slackened<L: Lane>(t: L) -> L {
    t - t.abs() * L::of(t.token(), SLACK)
}

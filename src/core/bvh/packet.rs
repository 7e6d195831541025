//! Visiting the blocks that any of sixteen rays meets, for rays that look much the same way.
//!
//! Source: I. Wald, S. Boulos, P. Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume
//! Hierarchies", ACM TOG 26(1), 2007. Differs from it: a node's eight boxes are tested at once against the
//! interval that holds all the rays; of the boxes that it meets each is then tested against all the rays at
//! once, not against the first one that meets it.
//!
//! Each ray gets the bits that it gets alone. The interval's bounds are rounded as the rays' distances are,
//! and rounding is monotone, so that no box is left out that a ray meets; and a block is tested for just
//! those rays that meet the leaf's own box, at the entry that [`Bvh::walk`] tells. A ray that meets a leaf's box
//! meets those around it, again because rounding is monotone.

use super::slab::{AHEAD, MOST_INVERSE, at_least, at_most};
use super::walk::{Stack, end_slackened, insert, start_slackened};
use super::{Bvh, Child, Node, WIDTH};
use crate::lane::PACKET;
use crate::ray::Ray;
use crate::simd::prefetch;
use fearless_simd::{Simd, f32x8, f32x16, mask32x16, prelude::*};

/// What is done with the blocks that rays meet.
pub(crate) trait PacketVisitor<S: Simd> {
    /// Looks at a block of a leaf whose box the rays of `met` enter at `entry`. Returns the farthest t that
    /// is still of interest, ray by ray.
    fn visit(&mut self, block: usize, entry: f32x16<S>, met: mask32x16<S>) -> f32x16<S>;

    /// A block will be visited soon, unless hits come in between.
    fn announce(&self, block: usize);
}

/// Sixteen rays whose directions' coordinates have the same signs.
#[derive(Clone, Copy)]
pub(crate) struct RayPacket<S: Simd> {
    pub origin: [f32x16<S>; 3],
    pub dir: [f32x16<S>; 3],
    pub t_min: f32x16<S>,
    pub t_max: f32x16<S>,
    inverse: [f32x16<S>; 3],
    /// Axis by axis whether the directions go down.
    is_down: [bool; 3],
}

impl<S: Simd> RayPacket<S> {
    /// `None` where rays go different ways, begin behind their origins or exclude a primitive: those are
    /// traced one by one.
    #[inline(always)]
    pub fn new(token: S, rays: &[Ray; PACKET]) -> Option<Self> {
        let mut is_plain = true;
        let mut rows = [[0.0; PACKET]; 8];
        // Plain loops, here as below: what an iterator calls may lose the CPU's features.
        let mut i = 0;
        while i < PACKET {
            let ray = &rays[i];
            is_plain &= ray.t_min >= 0.0 && ray.exclude.is_none();
            let ([x, y, z], [dx, dy, dz]) = (ray.origin.to_array(), ray.dir.to_array());
            (rows[0][i], rows[1][i], rows[2][i]) = (x, y, z);
            (rows[3][i], rows[4][i], rows[5][i]) = (dx, dy, dz);
            (rows[6][i], rows[7][i]) = (ray.t_min, ray.t_max);
            i += 1;
        }
        let row = |k: usize| f32x16::load_array_ref(token, &rows[k]);
        let dir = [row(3), row(4), row(5)];
        let (zero, one) = (f32x16::splat(token, 0.0), f32x16::splat(token, 1.0));
        let inverse = [one / dir[0], one / dir[1], one / dir[2]];
        let mut is_down = [false; 3];
        let mut axis = 0;
        while axis < 3 {
            let down = inverse[axis].simd_lt(zero);
            is_down[axis] = down.all_true();
            is_plain &= is_down[axis] || !down.any_true();
            // Of 0·∞ and numbers together the interval's bounds would make either.
            let most = f32x16::splat(token, MOST_INVERSE);
            let is_finite = inverse[axis].abs().simd_le(most).all_true();
            is_plain &= is_finite || dir[axis].simd_eq(zero).all_true();
            axis += 1;
        }
        is_plain.then_some(Self {
            origin: [row(0), row(1), row(2)],
            dir,
            t_min: row(6),
            t_max: row(7),
            inverse,
            is_down,
        })
    }
}

/// The rays made ready for boxes: one by one, and the interval that holds them all.
struct Slabs<S: Simd> {
    origin: [f32x16<S>; 3],
    inv_near: [f32x16<S>; 3],
    inv_far: [f32x16<S>; 3],
    t_min: f32x16<S>,
    /// Which of a node's rows holds the planes that the rays meet first, axis by axis.
    near: [usize; 3],
    /// The origin for near planes and for far ones that gives the least and the greatest distance.
    origins: [[f32x8<S>; 2]; 3],
    /// The least and the greatest inverse for near planes, and for far ones.
    inverses: [[f32x8<S>; 4]; 3],
    least_t_min: f32x8<S>,
}

impl<S: Simd> Slabs<S> {
    #[inline(always)]
    fn new(token: S, rays: &RayPacket<S>) -> Self {
        let ahead = f32x16::splat(token, AHEAD);
        let t_min = start_slackened(rays.t_min);
        let all = |x: f32| f32x8::splat(token, x);
        let zero = all(0.0);
        let mut slabs = Self {
            origin: rays.origin,
            inv_near: rays.inverse,
            inv_far: rays.inverse,
            t_min,
            near: [0; 3],
            origins: [[zero; 2]; 3],
            inverses: [[zero; 4]; 3],
            least_t_min: all(t_min.reduce_min()),
        };
        let mut axis = 0;
        while axis < 3 {
            let (near, far) = (rays.inverse[axis], rays.inverse[axis] * ahead);
            slabs.inv_far[axis] = far;
            slabs.near[axis] = 2 * axis + usize::from(rays.is_down[axis]);
            let (least, most) = (
                all(rays.origin[axis].reduce_min()),
                all(rays.origin[axis].reduce_max()),
            );
            slabs.origins[axis] = if rays.is_down[axis] {
                [least, most]
            } else {
                [most, least]
            };
            slabs.inverses[axis] = [
                all(near.reduce_min()),
                all(near.reduce_max()),
                all(far.reduce_min()),
                all(far.reduce_max()),
            ];
            axis += 1;
        }
        slabs
    }

    /// Which of a node's boxes any ray may enter before `t_max`, a bit each, and where at the earliest.
    #[inline(always)]
    fn enter_any(&self, token: S, node: &Node, t_max: f32) -> ([f32; WIDTH], u32) {
        let (mut near, mut far) = (self.least_t_min, f32x8::splat(token, t_max));
        let mut axis = 0;
        while axis < 3 {
            let row = self.near[axis];
            let [for_near, for_far] = self.origins[axis];
            let [a, b, c, d] = self.inverses[axis];
            let first = f32x8::load_array_ref(token, &node.planes[row]) - for_near;
            let last = f32x8::load_array_ref(token, &node.planes[row ^ 1]) - for_far;
            near = at_least(near, (first * a).min(first * b));
            far = at_most(far, (last * c).max(last * d));
            axis += 1;
        }
        (near.to_array(), near.simd_le(far).to_bitmask() as u32)
    }

    /// Where each ray enters one of a node's boxes, and whether it does so before its `t_max`.
    #[inline(always)]
    fn enter_one(
        &self,
        token: S,
        node: &Node,
        slot: usize,
        t_max: f32x16<S>,
    ) -> (f32x16<S>, mask32x16<S>) {
        let (mut near, mut far) = (self.t_min, t_max);
        let mut axis = 0;
        while axis < 3 {
            let row = self.near[axis];
            let first = f32x16::splat(token, node.planes[row][slot]) - self.origin[axis];
            let last = f32x16::splat(token, node.planes[row ^ 1][slot]) - self.origin[axis];
            near = at_least(near, first * self.inv_near[axis]);
            far = at_most(far, last * self.inv_far[axis]);
            axis += 1;
        }
        (near, near.simd_le(far))
    }
}

/// Where a child is found: its node's index, and its slot in the lowest three bits.
#[derive(Clone, Copy)]
struct Place(u32);

impl Place {
    fn key(self, entry: f32) -> u64 {
        u64::from(entry.to_bits()) << 32 | u64::from(self.0)
    }

    fn slot(self) -> usize {
        self.0 as usize % WIDTH
    }

    fn node(self) -> usize {
        self.0 as usize / WIDTH
    }
}

impl Bvh {
    /// Hands each block that any of the rays meets to the visitor.
    #[inline(always)]
    pub(crate) fn walk_packet<S: Simd, V: PacketVisitor<S>>(
        &self,
        token: S,
        rays: &RayPacket<S>,
        stack: &mut Stack,
        visitor: &mut V,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let slabs = Slabs::new(token, rays);
        let mut limits = end_slackened(rays.t_max);
        let mut farthest = limits.reduce_max();
        let mut depth = 0u8;
        let mut index = 0;
        loop {
            // Down to the nearest leaf.
            let place = loop {
                let node = &self.nodes[index];
                let (entries, mut met) = slabs.enter_any(token, node, farthest);
                let (first, mut nearest) = (depth, u64::MAX);
                while met != 0 {
                    let slot = met.trailing_zeros() as usize % WIDTH;
                    met &= met - 1;
                    self.announce(token, node.child[slot], visitor);
                    let key = Place((index * WIDTH + slot) as u32).key(entries[slot]);
                    if nearest == u64::MAX {
                        nearest = key;
                    } else {
                        insert(stack, first, depth, nearest.max(key));
                        nearest = nearest.min(key);
                        depth = depth.wrapping_add(1);
                    }
                }
                if nearest == u64::MAX {
                    break None;
                }
                let place = Place(nearest as u32);
                let child = node.child[place.slot()];
                if child.is_leaf() {
                    break Some(place);
                }
                index = child.node_index();
            };
            if let Some(place) = place {
                self.leaf(token, place, &slabs, &mut limits, visitor);
                farthest = limits.reduce_max();
            }
            // Back to what was put off, but for what has since turned out to lie behind all hits.
            index = loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                let key = stack[usize::from(depth)];
                if f32::from_bits((key >> 32) as u32) > farthest {
                    continue;
                }
                let place = Place(key as u32);
                let child = self.nodes[place.node()].child[place.slot()];
                if !child.is_leaf() {
                    break child.node_index();
                }
                self.leaf(token, place, &slabs, &mut limits, visitor);
                farthest = limits.reduce_max();
            };
        }
    }

    /// Visits a leaf's blocks, unless all its rays have found nearer hits by now.
    #[inline(always)]
    fn leaf<S: Simd, V: PacketVisitor<S>>(
        &self,
        token: S,
        place: Place,
        slabs: &Slabs<S>,
        limits: &mut f32x16<S>,
        visitor: &mut V,
    ) {
        let node = &self.nodes[place.node()];
        let (entry, met) = slabs.enter_one(token, node, place.slot(), *limits);
        if !met.any_true() {
            return;
        }
        let leaf = node.child[place.slot()];
        let first = leaf.first_block();
        for block in first..first + leaf.block_count() {
            *limits = end_slackened(visitor.visit(block, entry, met));
        }
    }

    #[inline(always)]
    fn announce<S: Simd, V: PacketVisitor<S>>(&self, token: S, child: Child, visitor: &V) {
        if child.is_leaf() {
            visitor.announce(child.first_block());
        } else {
            prefetch(token, &self.nodes, child.node_index(), size_of::<Node>());
        }
    }
}

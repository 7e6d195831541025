//! Traversal of a tree by packets of sixteen rays with similar directions.
//!
//! Source: I. Wald, S. Boulos, P. Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume
//! Hierarchies", ACM TOG 26(1), 2007. Differs from it: a node's eight boxes are tested at once against the
//! interval that encloses all the rays, and so are the boxes of a block's triangles, which avoids tests of
//! the leaves that no ray comes near. Testing the boxes that the interval meets against all the rays would
//! cull only one in a hundred while the rays are close together; `hybrid` tests them, too, once the rays diverge.
//!
//! Each ray gets bit for bit the same result as alone. The interval's bounds are rounded like the rays'
//! distances, and rounding is monotone, so no box that a ray meets is omitted. A hit counts if the ray meets
//! the triangle's own box, in a packet or alone.

use super::slab::{AHEAD, MAX_INVERSE, at_least, at_most};
use super::walk::{Stack, child_of, end_slackened, entry_of, insert, key, start_slackened};
use super::{Bvh, Child, Node, WIDTH};
use crate::aabb::Planes;
use crate::lane::PACKET;
use crate::ray::Ray;
use crate::simd::prefetch;
use fearless_simd::{Simd, f32x4, f32x8, f32x16, mask32x16, prelude::*};

/// Key of no child; compares greater than all others.
const NOTHING: u64 = u64::MAX;

/// Handler of the blocks that rays meet.
pub(crate) trait PacketVisitor<S: Simd> {
    /// Processes a block and returns the farthest t of interest of each ray, or `None` to give up the packet. `farthest`
    /// is the largest of these over all rays, plus a small margin.
    fn visit(&mut self, block: usize, slabs: &Slabs<S>, farthest: f32) -> Option<f32x16<S>>;

    /// Announces a block that will be visited soon, unless a hit makes that unnecessary.
    fn announce(&self, block: usize);
}

/// Sixteen rays whose directions have the same signs.
#[derive(Clone, Copy)]
pub(crate) struct RayPacket<S: Simd> {
    pub origin: [f32x16<S>; 3],
    pub dir: [f32x16<S>; 3],
    pub t_min: f32x16<S>,
    pub t_max: f32x16<S>,
    inverse: [f32x16<S>; 3],
    /// Per axis, whether the directions are negative.
    is_down: [bool; 3],
}

impl<S: Simd> RayPacket<S> {
    /// Makes a packet. `None` if the rays' directions differ in sign, or if a ray starts or ends behind its origin or
    /// excludes a primitive; such rays are traced one by one.
    #[inline(always)]
    pub fn new(token: S, rays: &[Ray; PACKET]) -> Option<Self> {
        let ([starts, rests], mut is_plain) = rows(rays);
        let [x, y, z, dx] = columns(token, &starts);
        let [dy, dz, t_min, t_max] = columns(token, &rests);
        let dir = [dx, dy, dz];
        let (zero, one) = (f32x16::splat(token, 0.0), f32x16::splat(token, 1.0));
        let inverse = [one / dir[0], one / dir[1], one / dir[2]];
        let mut is_down = [false; 3];
        // Plain loops, here and below: functions called by an iterator may be compiled without the CPU's features.
        let mut axis = 0;
        while axis < 3 {
            let down = inverse[axis].simd_lt(zero);
            is_down[axis] = down.all_true();
            is_plain &= is_down[axis] || !down.any_true();
            // A mix of 0·∞ and numbers would make the interval's bounds arbitrary.
            let most = f32x16::splat(token, MAX_INVERSE);
            let is_finite = inverse[axis].abs().simd_le(most).all_true();
            is_plain &= is_finite || dir[axis].simd_eq(zero).all_true();
            axis += 1;
        }
        is_plain.then_some(Self {
            origin: [x, y, z],
            dir,
            t_min,
            t_max,
            inverse,
            is_down,
        })
    }
}

/// The first and the next four numbers of each ray, and whether no ray starts or ends behind its origin or excludes a
/// primitive.
// Not inlined: otherwise the compiler replaces the shuffles of `columns` by gathers, which take a ninth of the time of a
// packet (bunny, AVX-512, AMD Zen 4, 2026-11).
#[inline(never)]
fn rows(rays: &[Ray; PACKET]) -> ([[[f32; 4]; PACKET]; 2], bool) {
    let (mut rows, mut is_plain) = ([[[0.0; 4]; PACKET]; 2], true);
    for (i, ray) in rays.iter().enumerate() {
        is_plain &= ray.t_min >= 0.0 && ray.t_max >= 0.0 && ray.exclude.is_none();
        let ([x, y, z], [dx, dy, dz]) = (ray.origin.to_array(), ray.dir.to_array());
        rows[0][i] = [x, y, z, dx];
        rows[1][i] = [dy, dz, ray.t_min, ray.t_max];
    }
    (rows, is_plain)
}

/// Transposes rows to columns.
#[inline(always)]
fn columns<S: Simd>(token: S, rows: &[[f32; 4]; PACKET]) -> [f32x16<S>; 4] {
    let row = |i: usize| f32x4::load_array_ref(token, &rows[i]);
    let two = |i: usize| row(i).combine(row(i + 1));
    let four = |i: usize| two(i).combine(two(i + 2));
    let (a, b, c, d) = (four(0), four(4), four(8), four(12));
    let (even, even_too) = (a.unzip_low(b), c.unzip_low(d));
    let (odd, odd_too) = (a.unzip_high(b), c.unzip_high(d));
    [
        even.unzip_low(even_too),
        odd.unzip_low(odd_too),
        even.unzip_high(even_too),
        odd.unzip_high(odd_too),
    ]
}

/// The rays prepared for box tests: each ray, and the interval that encloses all of them.
pub(crate) struct Slabs<S: Simd> {
    origin: [f32x16<S>; 3],
    inv_near: [f32x16<S>; 3],
    inv_far: [f32x16<S>; 3],
    t_min: f32x16<S>,
    /// Per axis, the row of a node's planes that the rays meet first.
    near: [usize; 3],
    /// Per axis, the origin that gives the least distance of near planes and the one that gives the greatest
    /// distance of far planes.
    origins: [[f32x8<S>; 2]; 3],
    /// Per axis, the least and the greatest inverse for near planes, then for far planes.
    inverses: [[f32x8<S>; 4]; 3],
    least_t_min: f32x8<S>,
}

impl<S: Simd> Slabs<S> {
    #[inline(always)]
    pub fn new(token: S, rays: &RayPacket<S>) -> Self {
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

    /// A bit mask of the boxes that any ray may enter before `t_max`, and the earliest distances at which it
    /// does.
    #[inline(always)]
    pub fn enter_any(
        &self,
        token: S,
        boxes: &Planes<[f32; WIDTH]>,
        t_max: f32,
    ) -> ([f32; WIDTH], u32) {
        let (mut near, mut far) = (self.least_t_min, f32x8::splat(token, t_max));
        let mut axis = 0;
        while axis < 3 {
            let row = self.near[axis];
            let [for_near, for_far] = self.origins[axis];
            let [a, b, c, d] = self.inverses[axis];
            let first = f32x8::load_array_ref(token, &boxes[row]) - for_near;
            let last = f32x8::load_array_ref(token, &boxes[row ^ 1]) - for_far;
            near = at_least(near, (first * a).min(first * b));
            far = at_most(far, (last * c).max(last * d));
            axis += 1;
        }
        (near.to_array(), near.simd_le(far).to_bitmask() as u32)
    }

    /// The distance at which each ray enters one of the boxes, and whether it does; bit for bit as
    /// [`SlabRay::enter`](super::SlabRay::enter).
    #[inline(always)]
    pub fn enter_one(
        &self,
        token: S,
        boxes: &Planes<[f32; WIDTH]>,
        slot: usize,
    ) -> (f32x16<S>, mask32x16<S>) {
        let (mut near, mut far) = (self.t_min, f32x16::splat(token, f32::INFINITY));
        let mut axis = 0;
        while axis < 3 {
            let row = self.near[axis];
            let first = f32x16::splat(token, boxes[row][slot]) - self.origin[axis];
            let last = f32x16::splat(token, boxes[row ^ 1][slot]) - self.origin[axis];
            near = at_least(near, first * self.inv_near[axis]);
            far = at_most(far, last * self.inv_far[axis]);
            axis += 1;
        }
        (near, near.simd_le(far))
    }
}

impl Bvh {
    /// Passes to the visitor each block that any of the rays may meet before its end. Returns whether the visitor processed
    /// them all.
    #[inline(always)]
    pub(crate) fn walk_packet<S: Simd, V: PacketVisitor<S>>(
        &self,
        token: S,
        slabs: &Slabs<S>,
        ends: f32x16<S>,
        stack: &mut Stack,
        visitor: &mut V,
    ) -> bool {
        if self.nodes.is_empty() {
            return true;
        }
        let mut farthest = end_slackened(ends).reduce_max();
        let mut depth = 0u8;
        let mut current = Child::node(0);
        loop {
            // Descend to the nearest leaf.
            while !current.is_leaf() {
                let node = &self.nodes[current.node_index()];
                let (entries, mut met) = slabs.enter_any(token, &node.planes, farthest);
                let (first, mut nearest) = (depth, NOTHING);
                while met != 0 {
                    let slot = met.trailing_zeros() as usize % WIDTH;
                    met &= met - 1;
                    self.announce(token, node.child[slot], visitor);
                    let key = key(entries[slot], node.child[slot]);
                    if nearest == NOTHING {
                        nearest = key;
                    } else {
                        insert(stack, first, depth, nearest.max(key));
                        nearest = nearest.min(key);
                        depth = depth.wrapping_add(1);
                    }
                }
                current = child_of(nearest);
            }
            if current != Child::NONE {
                let first = current.first_block();
                for block in first..first + current.block_count() {
                    let Some(limits) = visitor.visit(block, slabs, farthest) else {
                        return false;
                    };
                    farthest = end_slackened(limits).reduce_max();
                }
            }
            // Pop a deferred child, skipping those that now lie behind all hits.
            loop {
                if depth == 0 {
                    return true;
                }
                depth -= 1;
                let put_off = stack[usize::from(depth)];
                if entry_of(put_off) <= farthest {
                    current = child_of(put_off);
                    break;
                }
            }
        }
    }

    /// Prefetches a child.
    #[inline(always)]
    pub(super) fn announce<S: Simd, V: PacketVisitor<S>>(
        &self,
        token: S,
        child: Child,
        visitor: &V,
    ) {
        if child.is_leaf() {
            visitor.announce(child.first_block());
        } else {
            prefetch(token, &self.nodes, child.node_index(), size_of::<Node>());
        }
    }
}

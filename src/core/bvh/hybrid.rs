//! Hybrid traversal: packets first, single rays where the packet's rays diverge.
//!
//! A node that at least [`SWITCH_THRESHOLD`] of a packet's rays meet is opened once for all of them. Of its other children,
//! and of leaves, each ray that meets one gets an entry in a list, and traverses it alone.
//!
//! Source: C. Benthin, I. Wald, S. Woop, M. Ernst, W. R. Mark, "Combining Single and Packet-Ray Tracing for Arbitrary Ray
//! Distributions on the Intel MIC Architecture", IEEE TVCG 18(9), 2012. Differs from it: the lists are complete before the
//! first single ray is traced, so a hit doesn't save the packet any work. Most rays that seek any hit have none.
//!
//! Nodes per ray of rays to a lamp (`hitscope bench`, workload `lamp`; all packets split, 2026-11):
//!
//! ```text
//! triangles   single rays   packet ÷ 16   single rays after the split
//!   1.1 M        10.3           0.8                 0.2
//!   6.4 M         8.1           0.6                 1.0
//! ```

use super::packet::{PacketVisitor, Slabs};
use super::walk::{Stack, child_of, end_slackened, insert, key};
use super::{Bvh, Child, WIDTH};
use crate::lane::PACKET;
use fearless_simd::{Simd, f32x16, prelude::*};

/// The least number of rays for which a node is opened once for the packet. With 3 and 8, times differed by less than a
/// tenth (rays to a lamp, 1.1 M and 6.4 M triangles, AMD Zen 3, 2026-11).
const SWITCH_THRESHOLD: u32 = 5;

/// The capacity of a ray's list. In the measurements above, lists had two to four entries on average.
const MAX_SUBTREES: usize = 48;

const _: () = assert!(MAX_SUBTREES <= u8::MAX as usize);

/// For each ray of a packet, the subtrees that it is to traverse alone.
pub(crate) struct SubtreeLists {
    /// The keys of children, nearest first.
    keys: [[u64; MAX_SUBTREES]; PACKET],
    counts: [u8; PACKET],
}

impl SubtreeLists {
    pub const EMPTY: Self = Self {
        keys: [[0; MAX_SUBTREES]; PACKET],
        counts: [0; PACKET],
    };

    /// The keys of a ray's subtrees, nearest first.
    #[inline(always)]
    pub fn of(&self, ray: usize) -> &[u64] {
        &self.keys[ray][..usize::from(self.counts[ray])]
    }

    /// Whether no ray has a subtree.
    pub fn are_empty(&self) -> bool {
        self.counts == [0; PACKET]
    }

    /// Adds a child to the lists of the rays whose bits are set. Returns whether there is room.
    #[inline(always)]
    fn add(&mut self, child: Child, entries: &[f32; PACKET], mut bits: u32) -> bool {
        while bits != 0 {
            let ray = bits.trailing_zeros() as usize % PACKET;
            bits &= bits - 1;
            let (keys, count) = (&mut self.keys[ray], usize::from(self.counts[ray]));
            if count >= MAX_SUBTREES {
                return false;
            }
            let added = key(entries[ray], child);
            let mut at = count;
            while at > 0 && keys[at - 1] > added {
                keys[at] = keys[at - 1];
                at -= 1;
            }
            keys[at] = added;
            self.counts[ray] += 1;
        }
        true
    }
}

impl Bvh {
    /// Splits a packet: replaces `lists` with the subtrees that each ray meets before its end. Returns whether there is room
    /// for them. The list of a ray with a negative end is empty.
    #[inline(always)]
    pub(crate) fn split_packet<S: Simd, V: PacketVisitor<S>>(
        &self,
        token: S,
        slabs: &Slabs<S>,
        ends: f32x16<S>,
        stack: &mut Stack,
        lists: &mut SubtreeLists,
        visitor: &V,
    ) -> bool {
        lists.counts = [0; PACKET];
        if self.nodes.is_empty() {
            return true;
        }
        let ends = end_slackened(ends);
        let farthest = ends.reduce_max();
        stack[0] = key(0.0, Child::node(0));
        let mut depth = 1u8;
        while depth != 0 {
            depth -= 1;
            // Open the next node for the whole packet.
            let node = &self.nodes[child_of(stack[usize::from(depth)]).node_index()];
            let (entries, mut met) = slabs.enter_any(token, &node.planes, farthest);
            let first = depth;
            while met != 0 {
                let slot = met.trailing_zeros() as usize % WIDTH;
                met &= met - 1;
                let (child, (entry, enters)) =
                    (node.child[slot], slabs.enter_one(token, &node.planes, slot));
                let bits = (enters & entry.simd_le(ends)).to_bitmask() as u32;
                if bits == 0 {
                    continue;
                }
                self.announce(token, child, visitor);
                if bits.count_ones() >= SWITCH_THRESHOLD && !child.is_leaf() {
                    // Sorted, so that the lists fill almost in order.
                    insert(stack, first, depth, key(entries[slot], child));
                    depth = depth.wrapping_add(1);
                } else if !lists.add(child, &entry.to_array(), bits) {
                    return false;
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::packet::RayPacket;
    use super::super::slab::SlabRay;
    use super::super::walk::{LentStack, Visitor, entry_of};
    use super::*;
    use crate::aabb::Aabb;
    use crate::ray::Ray;
    use crate::simd::{SimdLevel, baseline};
    use fearless_simd::dispatch;
    use glam::{Vec2, Vec3};
    use std::ops::ControlFlow;

    /// Notes the blocks of a walk up to `t_max`, and ends it after `most`.
    struct Visited {
        blocks: Vec<usize>,
        most: usize,
        t_max: f32,
    }

    impl<S: Simd> Visitor<S> for Visited {
        const IS_BEHIND: bool = false;
        const NEEDS_BOX_TEST: bool = true;

        fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
            self.blocks.push(block);
            if self.blocks.len() == self.most {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(self.t_max)
        }

        fn announce(&self, _: usize) {}

        fn open(&mut self, _: usize) {}
    }

    impl<S: Simd> PacketVisitor<S> for Visited {
        fn visit(&mut self, _: usize, _: &Slabs<S>, _: f32) -> Option<f32x16<S>> {
            None
        }

        fn announce(&self, _: usize) {}
    }

    /// A tree of cubes of this size about points.
    fn tree(points: &[Vec3], size: f32) -> Bvh {
        let bounds = |i: u32| {
            let point = points[i as usize];
            Aabb::around([point - 0.5 * size, point + 0.5 * size])
        };
        Bvh::build(points.len(), &bounds, &|| Ok(())).expect("never cancelled")
    }

    /// A grid of 4 × 4 rays upwards from the plane z = 0, `step` apart.
    fn rays(step: f32) -> [Ray; PACKET] {
        std::array::from_fn(|i| {
            let place = step * Vec2::new((i % 4) as f32, (i / 4) as f32);
            Ray::new(place.extend(0.0), Vec3::new(0.1, 0.01, 1.0)).expect("a ray")
        })
    }

    /// Splits a packet at each SIMD level, and passes on whether there was room, and the lists.
    fn split(
        bvh: &Bvh,
        rays: &[Ray; PACKET],
        ends: [f32; PACKET],
        check: &dyn Fn(bool, &SubtreeLists),
    ) {
        for level in SimdLevel::available() {
            let mut lent = LentStack::new();
            let (stack, lists) = lent.with_lists();
            let visitor = Visited {
                blocks: Vec::new(),
                most: 0,
                t_max: 0.0,
            };
            let has_room = dispatch!(level.level(), token => {
                let packet = RayPacket::new(token, rays).expect("coherent rays");
                let slabs = Slabs::new(token, &packet);
                let ends = f32x16::load_array(token, ends);
                bvh.split_packet(token, &slabs, ends, stack, lists, &visitor)
            });
            check(has_room, lists);
        }
    }

    /// The blocks that a ray visits in the tree, or in a list of subtrees.
    fn visited(bvh: &Bvh, ray: &Ray, list: Option<&[u64]>, most: usize) -> Vec<usize> {
        let (mut lent, token) = (LentStack::new(), baseline());
        let mut visitor = Visited {
            blocks: Vec::new(),
            most,
            t_max: ray.t_max,
        };
        match list {
            Some(keys) => bvh.walk_subtrees(token, ray, keys, lent.get(), &mut visitor),
            None => bvh.walk(token, ray, lent.get(), &mut visitor),
        }
        visitor.blocks
    }

    /// 20 000 cubes in a grid.
    fn grid() -> Bvh {
        let point = |i| Vec3::new((i % 31) as f32, (i / 31 % 29) as f32, (i / 899) as f32);
        tree(&(0..20_000).map(point).collect::<Vec<_>>(), 0.9)
    }

    #[test]
    fn a_ray_visits_the_same_blocks_in_its_list_as_in_the_tree() {
        let bvh = grid();
        // Rays that stay together, rays that diverge low and high in the tree, and rays of which some miss it.
        for step in [0.0, 0.1, 1.0, 7.0, 12.0] {
            for t_max in [f32::INFINITY, 9.0] {
                let mut rays = rays(step);
                for (i, ray) in rays.iter_mut().enumerate() {
                    ray.t_max = t_max + i as f32;
                }
                let alone = rays.each_ref().map(|ray| {
                    let mut blocks = visited(&bvh, ray, None, usize::MAX);
                    blocks.sort_unstable();
                    blocks
                });
                assert!(alone.iter().map(Vec::len).sum::<usize>() > 16, "{step}");
                split(
                    &bvh,
                    &rays,
                    rays.map(|ray| ray.t_max),
                    &|has_room, lists| {
                        assert!(has_room && !lists.are_empty(), "{step}");
                        for (i, ray) in rays.iter().enumerate() {
                            let keys = lists.of(i);
                            assert!(keys.is_sorted_by_key(|&key| entry_of(key)), "{step} {i}");
                            let mut blocks = visited(&bvh, ray, Some(keys), usize::MAX);
                            let first = visited(&bvh, ray, Some(keys), 1);
                            assert_eq!(first, blocks[..blocks.len().min(1)], "{step} {i}");
                            blocks.sort_unstable();
                            assert_eq!(blocks, alone[i], "{step} {i}");
                        }
                    },
                );
            }
        }
    }

    #[test]
    fn nodes_that_few_rays_meet_are_left_to_them() {
        let (bvh, ends) = (grid(), [f32::INFINITY; PACKET]);
        let are_leaves = |lists: &SubtreeLists| {
            let mut keys = (0..PACKET).flat_map(|ray| lists.of(ray));
            keys.all(|&key| child_of(key).is_leaf())
        };
        split(&bvh, &rays(0.0), ends, &|_, lists| {
            assert!(are_leaves(lists));
        });
        split(&bvh, &rays(7.0), ends, &|_, lists| {
            assert!(!are_leaves(lists));
        });
    }

    #[test]
    fn lists_that_are_full_are_reported() {
        let rays = rays(10.0);
        let along = |i: usize| rays[i % PACKET].at((10 * (i / PACKET)) as f32).as_vec3();
        let bvh = tree(&(0..800 * PACKET).map(along).collect::<Vec<_>>(), 1.0);
        split(&bvh, &rays, [f32::INFINITY; PACKET], &|has_room, _| {
            assert!(!has_room);
        });
    }

    #[test]
    fn the_list_of_a_ray_with_a_negative_end_is_empty() {
        let bvh = tree(&[Vec3::Z; 100], 1.5);
        let mut ends = [f32::INFINITY; PACKET];
        ends[5] = -1.0;
        split(&bvh, &rays(0.01), ends, &|has_room, lists| {
            assert!(has_room && lists.of(5).is_empty() && !lists.of(6).is_empty());
        });
    }
}

//! Searches of packets, for the nearest hits or any hits.

use super::back_off::{Allowance, BackOff, EXCESS_OF_ANY, EXCESS_OF_NEAREST};
use super::{BlockLane, PacketMethod, PacketTester};
use crate::bvh::{
    BLOCK_SIZE, LentStack, NO_PRIMITIVE, PacketVisitor, RayPacket, Slabs, Stack, SubtreeLists,
};
use crate::intersector::Intersector;
use crate::intersector::blocks::Blocks;
use crate::intersector::tree::TreeIntersector;
use crate::intersector::visitors::Any;
use crate::kernel::RayLanes;
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use crate::simd::prefetch;
use fearless_simd::{Simd, dispatch, f32x16, prelude::*, u32x8};

/// Finds the nearest hit of each ray, or any hit if `IS_ANY`.
struct Search<'a, M: PacketMethod, S: Simd, const IS_ANY: bool> {
    token: S,
    blocks: &'a Blocks<M::Shape, M::Stored>,
    tester: M::Packet<'a, S>,
    /// The ends of the rays without a hit; −1 for those with one. If not `IS_ANY`, the ends of all rays.
    ends: f32x16<S>,
    allowance: Allowance,
}

impl<M: PacketMethod, S: Simd, const IS_ANY: bool> PacketVisitor<S> for Search<'_, M, S, IS_ANY> {
    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &Slabs<S>, farthest: f32) -> Option<f32x16<S>> {
        if !self.allowance.takes_block() {
            return None;
        }
        let rows = self.blocks.packed(block, M::VALUES);
        let boxes = M::boxes::<S>(self.token, rows);
        let (_, near) = slabs.enter_any(self.token, &boxes, farthest);
        let lanes = self.blocks.bvh.lanes(block);
        let primitives = u32x8::load_array_ref(self.token, lanes);
        let mut near = near & primitives.simd_lt(NO_PRIMITIVE).to_bitmask() as u32;
        self.allowance.tested(near.count_ones());
        while near != 0 {
            let lane = near.trailing_zeros() as usize % BLOCK_SIZE;
            near &= near - 1;
            let primitive = BlockLane {
                rows,
                boxes: &boxes,
                primitive: lanes[lane],
                block,
                lane,
            };
            if IS_ANY {
                let is_hit = self.tester.any(&primitive, slabs, self.ends);
                self.ends = is_hit.select(f32x16::splat(self.token, -1.0), self.ends);
            } else {
                self.tester.nearest(&primitive, slabs);
            }
        }
        Some(if IS_ANY {
            self.ends
        } else {
            self.tester.farthest()
        })
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        (self.blocks).announce::<false, S>(self.token, block, M::VALUES);
    }
}

/// The most rays whose packets are traced with one choice of the SIMD level: one bit per packet marks those that
/// aren't coherent.
const AT_ONCE: usize = u64::BITS as usize * PACKET;

impl<M: PacketMethod> TreeIntersector<M> {
    /// Finds the nearest hits of coherent rays.
    pub(in crate::intersector) fn nearest_of_packets(
        &self,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
    ) {
        let nearest = |rays: &[Ray], hits: &mut [Option<Hit>]| self.closest_hits(rays, hits);
        in_packets(rays, hits, nearest, |packets, hits| {
            let mut lent = LentStack::new();
            let stack = lent.get();
            dispatch!(self.level.level(), token => self.nearest_at(token, packets, hits, stack))
        });
    }

    /// Finds out which coherent rays hit anything.
    pub(in crate::intersector) fn any_of_packets(&self, rays: &[Ray], are_hits: &mut [bool]) {
        let any = |rays: &[Ray], are_hits: &mut [bool]| self.any_hits(rays, are_hits);
        in_packets(rays, are_hits, any, |packets, are_hits| {
            let mut lent = LentStack::new();
            let (stack, lists) = lent.with_lists();
            dispatch!(self.level.level(), token => self.any_at(token, packets, are_hits, stack, lists))
        });
    }

    /// Finds the nearest hits of packets; returns the bits of those that aren't coherent.
    #[inline(always)]
    fn nearest_at<S: Simd>(
        &self,
        token: S,
        packets: &[[Ray; PACKET]],
        hits: &mut [[Option<Hit>; PACKET]],
        stack: &mut Stack,
    ) -> u64 {
        let (mut incoherent, mut back_off) = (0, BackOff::resumed());
        // A plain loop, here and below: functions called by an iterator may be compiled without the CPU's features.
        let mut i = 0;
        while i < packets.len() {
            announce_next(token, packets, i);
            let (packet, hits) = (&packets[i], &mut hits[i]);
            let is_complete = self.nearest_of_packet(token, packet, hits, stack, &mut back_off);
            incoherent |= u64::from(!is_complete) << i;
            i += 1;
        }
        back_off.keep();
        incoherent
    }

    /// Finds the nearest hits of a packet. Returns `false` if it isn't coherent: if [`search`](Self::search) returns `None`,
    /// or if the rays test too many primitives together.
    #[inline(always)]
    fn nearest_of_packet<S: Simd>(
        &self,
        token: S,
        rays: &[Ray; PACKET],
        hits: &mut [Option<Hit>; PACKET],
        stack: &mut Stack,
        back_off: &mut BackOff,
    ) -> bool {
        let allowance = back_off.allowance(EXCESS_OF_NEAREST);
        let Some((slabs, mut search)) = self.search::<S, false>(token, rays, allowance) else {
            return false;
        };
        let is_complete =
            (self.blocks.bvh).walk_packet(token, &slabs, search.ends, stack, &mut search);
        back_off.note(search.allowance, !is_complete);
        if is_complete {
            M::write(&search.tester, hits);
        }
        is_complete
    }

    /// Finds out which rays of packets hit anything; returns the bits of the packets that aren't coherent.
    #[inline(always)]
    fn any_at<S: Simd>(
        &self,
        token: S,
        packets: &[[Ray; PACKET]],
        are_hits: &mut [[bool; PACKET]],
        stack: &mut Stack,
        lists: &mut SubtreeLists,
    ) -> u64 {
        let (mut incoherent, mut back_off) = (0, BackOff::resumed());
        let mut i = 0;
        while i < packets.len() {
            announce_next(token, packets, i);
            let (packet, are_hits) = (&packets[i], &mut are_hits[i]);
            let is_complete =
                self.any_of_packet(token, packet, are_hits, stack, lists, &mut back_off);
            incoherent |= u64::from(!is_complete) << i;
            i += 1;
        }
        back_off.keep();
        incoherent
    }

    /// Finds out which rays of a packet hit anything. Splits it if the rays test too many primitives together. Returns
    /// `false` if [`search`](Self::search) returns `None`, or if a ray's list of subtrees is full.
    #[inline(always)]
    fn any_of_packet<S: Simd>(
        &self,
        token: S,
        rays: &[Ray; PACKET],
        are_hits: &mut [bool; PACKET],
        stack: &mut Stack,
        lists: &mut SubtreeLists,
        back_off: &mut BackOff,
    ) -> bool {
        let allowance = back_off.allowance(EXCESS_OF_ANY);
        let Some((slabs, mut search)) = self.search::<S, true>(token, rays, allowance) else {
            return false;
        };
        let bvh = &self.blocks.bvh;
        let splits_at_once = allowance.is_used_up();
        let is_complete = if splits_at_once {
            false
        } else {
            bvh.walk_packet(token, &slabs, search.ends, stack, &mut search)
        };
        let ends = search.ends.to_array();
        let mut i = 0;
        while i < PACKET {
            are_hits[i] = ends[i] < 0.0;
            i += 1;
        }
        if is_complete {
            back_off.note(search.allowance, false);
            return true;
        }
        let has_room = bvh.split_packet(token, &slabs, search.ends, stack, lists, &search);
        // Packets that meet nothing don't count.
        if !splits_at_once || !lists.are_empty() {
            back_off.note(search.allowance, true);
        }
        if !has_room {
            return false;
        }
        i = 0;
        while i < PACKET {
            if !are_hits[i] {
                let tester = M::tester(&self.blocks, token, &rays[i], &mut []);
                let mut visitor = Any::<_, false>::new(tester, rays[i].t_max);
                bvh.walk_subtrees(token, &rays[i], lists.of(i), stack, &mut visitor);
                are_hits[i] = visitor.is_hit;
            }
            i += 1;
        }
        true
    }

    /// Prepares the search of a packet. Returns `None` where [`RayPacket::new`] or [`RayLanes::side_by_side`] does.
    #[inline(always)]
    fn search<'a, S: Simd, const IS_ANY: bool>(
        &'a self,
        token: S,
        rays: &'a [Ray; PACKET],
        allowance: Allowance,
    ) -> Option<(Slabs<S>, Search<'a, M, S, IS_ANY>)> {
        let packet = RayPacket::new(token, rays)?;
        let interval = [packet.t_min, packet.t_max];
        let lanes = RayLanes::side_by_side(packet.origin, packet.dir, interval)?;
        let search = Search {
            token,
            blocks: &self.blocks,
            tester: M::packet(&self.blocks, token, rays, &packet, lanes),
            ends: packet.t_max,
            allowance,
        };
        Some((Slabs::new(token, &packet), search))
    }
}

/// Prefetches the rays of the packet after this one. Tracing a packet takes less time than loading its rays from
/// memory: without the prefetch throughput is a quarter lower (bunny, 2026-11).
#[inline(always)]
fn announce_next<S: Simd>(token: S, packets: &[[Ray; PACKET]], index: usize) {
    prefetch(token, packets, index + 1, size_of::<[Ray; PACKET]>());
}

/// Answers rays in packets by `together`, which returns the bits of packets that aren't coherent, and the rays of those
/// and of the last, incomplete packet by `alone`.
fn in_packets<T>(
    rays: &[Ray],
    answers: &mut [T],
    alone: impl Fn(&[Ray], &mut [T]),
    together: impl Fn(&[[Ray; PACKET]], &mut [[T; PACKET]]) -> u64,
) {
    for (rays, answers) in rays.chunks(AT_ONCE).zip(answers.chunks_mut(AT_ONCE)) {
        let (packets, rest) = rays.as_chunks();
        let (of_packets, of_rest) = answers.as_chunks_mut();
        let mut incoherent = together(packets, of_packets);
        while incoherent != 0 {
            let i = incoherent.trailing_zeros() as usize;
            incoherent &= incoherent - 1;
            alone(&packets[i], &mut of_packets[i]);
        }
        alone(rest, of_rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::exact_triangle_kernel;
    use crate::mesh::shapes::{Placement, torus};
    use crate::scene::scene;
    use glam::Vec3;

    /// A grid of parallel rays onto the torus, `step` apart, in packets of 4 × 4.
    fn rays(step: f32) -> Vec<Ray> {
        let index = |k: u32, shift: u32| (k >> shift & 3) + 4 * (k >> shift >> 4 & 3);
        let at = |k: u32, shift: u32| step * (index(k, shift) as f32 - 7.5);
        let origin = |k: u32| Vec3::new(1.0 + at(k, 0), at(k, 2), 9.0);
        let ray = |k: u32| Ray::new(origin(k), Vec3::NEG_Z).expect("a ray");
        (0..256).map(ray).collect()
    }

    #[test]
    fn packets_whose_rays_lie_farther_apart_than_triangles_are_abandoned() {
        BackOff::default().keep();
        let scene = scene(torus(600, 300, Placement::UNIT));
        let intersector = scene.intersector(exact_triangle_kernel());
        let last = |step: f32| {
            let rays = rays(step);
            let (mut together, mut alone) = (vec![None; 256], vec![None; 256]);
            intersector.coherent_hits(&rays, &mut together);
            let last = BackOff::resumed();
            intersector.closest_hits(&rays, &mut alone);
            assert_eq!(together, alone, "{step}");
            assert!(alone.iter().flatten().count() > 128, "{step}");
            last
        };
        assert_eq!(last(0.001), BackOff::default());
        assert_ne!(last(0.02), BackOff::default());
        // The first packets of the next call pay for these; then packets are in use again.
        last(0.001);
        assert_eq!(last(0.001), BackOff::default());
    }

    #[test]
    fn any_hits_of_packets_equal_those_of_single_rays_before_and_after_a_split() {
        let scene = scene(torus(600, 300, Placement::UNIT));
        let intersector = scene.intersector(exact_triangle_kernel());
        for (step, is_split) in [(0.001, false), (0.02, true), (0.2, true)] {
            BackOff::default().keep();
            let mut rays = rays(step);
            for ray in rays.iter_mut().step_by(3) {
                ray.t_max = 8.8;
            }
            let (mut together, mut alone) = ([false; 256], [false; 256]);
            intersector.any_hits(&rays, &mut alone);
            assert!(alone.contains(&true) && alone.contains(&false), "{step}");
            // The second time, the first packets are split at once if the last ones were split.
            for _ in 0..2 {
                together.fill(false);
                intersector.coherent_any_hits(&rays, &mut together);
                assert_eq!(together, alone, "{step}");
                assert_eq!(BackOff::resumed() != BackOff::default(), is_split, "{step}");
            }
        }
    }
}

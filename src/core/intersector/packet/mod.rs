//! Traces packets of sixteen rays, one ray per lane. For rays with similar origins and directions, such as a
//! camera's or those to one lamp.
//!
//! [`PacketMethod`] is the capability of a [`Method`]; its testers are `ranked` and `exact`. `back_off` decides when
//! single rays are faster.

mod back_off;
mod exact;
mod ranked;

use super::Intersector;
use super::blocks::{Blocks, Row};
use super::method::{BlocksOf, Method};
use super::tree::TreeIntersector;
use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, LentStack, NO_PRIMITIVE, PacketVisitor, RayPacket, Slabs, Stack};
use crate::kernel::RayLanes;
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use crate::simd::prefetch;
use back_off::{Allowance, BackOff, EXCESS_OF_ANY, EXCESS_OF_NEAREST};
use fearless_simd::{Simd, dispatch, f32x16, mask32x16, prelude::*, u32x8};

/// A method that can also test sixteen rays against one primitive.
pub(super) trait PacketMethod: Method {
    /// Tests a packet.
    type Packet<'a, S: Simd>: PacketTester<S, Self::Stored>;

    /// Prepares a packet. `lanes` holds the same rays as `packet` and `rays`.
    fn packet<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        rays: &'a [Ray; PACKET],
        packet: &RayPacket<S>,
        lanes: RayLanes<f32x16<S>>,
    ) -> Self::Packet<'a, S>;

    /// The box around each of a block's primitives.
    fn boxes<S: Simd>(token: S, rows: &[Row<Self::Stored>]) -> Planes<[f32; BLOCK_SIZE]>;

    /// Writes the nearest hits.
    fn write<S: Simd>(tester: &Self::Packet<'_, S>, hits: &mut [Option<Hit>; PACKET]);
}

/// Tests a packet against primitives.
pub(super) trait PacketTester<S: Simd, T> {
    /// Replaces the nearest hits so far by the primitive's hits that precede them.
    fn nearest(&mut self, primitive: &BlockLane<'_, T>, slabs: &Slabs<S>);

    /// The farthest t of hits that could precede the nearest so far.
    fn farthest(&self) -> f32x16<S>;

    /// The rays that hit the primitive. Those with a negative end are of no interest; the other ends are those
    /// of the rays.
    fn any(
        &mut self,
        primitive: &BlockLane<'_, T>,
        slabs: &Slabs<S>,
        ends: f32x16<S>,
    ) -> mask32x16<S>;
}

/// A primitive in a lane of a block.
pub(super) struct BlockLane<'a, T> {
    rows: &'a [Row<T>],
    boxes: &'a Planes<[f32; BLOCK_SIZE]>,
    primitive: u32,
    block: usize,
    lane: usize,
}

/// Finds the nearest hit of each ray, or any hit if `IS_ANY`.
struct Search<'a, M: PacketMethod, S: Simd, const IS_ANY: bool> {
    token: S,
    blocks: &'a Blocks<M::Shape, M::Stored>,
    tester: M::Packet<'a, S>,
    /// The ends of the rays without a hit; −1 for those with one. Only if `IS_ANY`.
    ends: f32x16<S>,
    allowance: Allowance,
    is_abandoned: bool,
}

impl<M: PacketMethod, S: Simd, const IS_ANY: bool> PacketVisitor<S> for Search<'_, M, S, IS_ANY> {
    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &Slabs<S>, farthest: f32) -> f32x16<S> {
        if !self.allowance.takes_block() {
            self.is_abandoned = true;
            // Nothing is of interest, which ends the walk.
            return f32x16::splat(self.token, -1.0);
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
        if IS_ANY {
            self.ends
        } else {
            self.tester.farthest()
        }
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
    pub(super) fn nearest_of_packets(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        let nearest = |rays: &[Ray], hits: &mut [Option<Hit>]| self.closest_hits(rays, hits);
        in_packets(rays, hits, nearest, |packets, hits| {
            let mut lent = LentStack::new();
            let stack = lent.get();
            dispatch!(self.level.level(), token => self.nearest_at(token, packets, hits, stack))
        });
    }

    /// Finds out which coherent rays hit anything.
    pub(super) fn any_of_packets(&self, rays: &[Ray], are_hits: &mut [bool]) {
        let any = |rays: &[Ray], are_hits: &mut [bool]| self.any_hits(rays, are_hits);
        in_packets(rays, are_hits, any, |packets, are_hits| {
            let mut lent = LentStack::new();
            let stack = lent.get();
            dispatch!(self.level.level(), token => self.any_at(token, packets, are_hits, stack))
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
            match self.search::<S, false>(token, &packets[i], stack, &mut back_off) {
                Some(search) => M::write(&search.tester, &mut hits[i]),
                None => incoherent |= 1 << i,
            }
            i += 1;
        }
        back_off.keep();
        incoherent
    }

    /// Finds out which rays of packets hit anything; returns the bits of the packets that aren't coherent.
    #[inline(always)]
    fn any_at<S: Simd>(
        &self,
        token: S,
        packets: &[[Ray; PACKET]],
        are_hits: &mut [[bool; PACKET]],
        stack: &mut Stack,
    ) -> u64 {
        let (mut incoherent, mut back_off) = (0, BackOff::resumed());
        let mut i = 0;
        while i < packets.len() {
            announce_next(token, packets, i);
            match self.search::<S, true>(token, &packets[i], stack, &mut back_off) {
                Some(search) => {
                    let ends = search.ends.to_array();
                    let mut lane = 0;
                    while lane < PACKET {
                        are_hits[i][lane] = ends[lane] < 0.0;
                        lane += 1;
                    }
                }
                None => incoherent |= 1 << i,
            }
            i += 1;
        }
        back_off.keep();
        incoherent
    }

    /// Traces a packet; returns `None` if its rays aren't coherent: if their directions differ much, or if they
    /// test too many primitives.
    #[inline(always)]
    fn search<'a, S: Simd, const IS_ANY: bool>(
        &'a self,
        token: S,
        rays: &'a [Ray; PACKET],
        stack: &mut Stack,
        back_off: &mut BackOff,
    ) -> Option<Search<'a, M, S, IS_ANY>> {
        let packet = RayPacket::new(token, rays)?;
        let interval = [packet.t_min, packet.t_max];
        let lanes = RayLanes::side_by_side(packet.origin, packet.dir, interval)?;
        let excess = if IS_ANY {
            EXCESS_OF_ANY
        } else {
            EXCESS_OF_NEAREST
        };
        let mut search = Search {
            token,
            blocks: &self.blocks,
            tester: M::packet(&self.blocks, token, rays, &packet, lanes),
            ends: packet.t_max,
            allowance: back_off.allowance(excess),
            is_abandoned: false,
        };
        (self.blocks.bvh).walk_packet(token, &packet, stack, &mut search);
        back_off.note(search.allowance, search.is_abandoned);
        (!search.is_abandoned).then_some(search)
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
}

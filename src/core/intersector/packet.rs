//! Traces packets of sixteen rays, one ray per lane. For rays with a common origin and similar
//! directions, such as a camera's.

use super::Intersector;
use super::blocks::{Blocks, LaneOf, LaneValues, Row, Scratch, boxes};
use super::levels::EveryLevel;
use super::order::{Comparison, precedes};
use super::ranked::Ranked;
use super::tree::TreeIntersector;
use crate::bvh::{
    BLOCK_SIZE, LentStack, NO_PRIMITIVE, PacketVisitor, RayPacket, Slabs, Stack, rank, rank_floor,
};
use crate::kernel::{Kernel, RayLanes};
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use crate::simd::prefetch;
use fearless_simd::{Simd, dispatch, f32x16, mask32x16, prelude::*, u32x8, u32x16};

/// Finds the nearest hit of each ray.
struct Nearest<'a, K: Kernel, S: Simd> {
    token: S,
    all: &'a [Ray; PACKET],
    blocks: &'a Blocks<K::Shape, K::Stored<f32>>,
    scratch: &'a mut Scratch<K::Stored<f32>>,
    rays: K::Prepared<f32x16<S>>,
    t_min: f32x16<S>,
    end: f32x16<S>,
    rank: f32x16<S>,
    t: f32x16<S>,
    u: f32x16<S>,
    v: f32x16<S>,
    primitive: u32x16<S>,
}

impl<K: Kernel, S: Simd> PacketVisitor<S> for Nearest<'_, K, S> {
    #[inline(always)]
    fn visit(&mut self, block: usize, slabs: &Slabs<S>, farthest: f32) -> f32x16<S> {
        let rows = (self.blocks).rows::<false>(block, K::VALUES, self.scratch, K::pack::<f32>);
        let boxes = boxes::<K, f32, S>(self.token, rows);
        let (_, near) = slabs.enter_any(self.token, &boxes, farthest);
        let infinity = f32x16::splat(self.token, f32::INFINITY);
        let lanes = self.blocks.bvh.lanes(block);
        let primitives = u32x8::load_array_ref(self.token, lanes);
        let mut near = near & primitives.simd_lt(NO_PRIMITIVE).to_bitmask() as u32;
        while near != 0 {
            let lane = near.trailing_zeros() as usize % BLOCK_SIZE;
            near &= near - 1;
            let values = LaneValues::new(self.token, rows, lane);
            if let Some(hit) = K::intersect(&self.rays, &values, self.t_min, self.rank) {
                let (entry, met) = slabs.enter_one(self.token, &boxes, lane);
                let floor = rank_floor(entry);
                let primitive = u32x16::splat(self.token, lanes[lane]);
                let (mut is_hit, [mut t, mut u, mut v]) = (hit.mask & met, [hit.t, hit.u, hit.v]);
                let doubtful = if K::IS_ADAPTIVE {
                    (hit.doubtful & met).to_bitmask() as u32
                } else {
                    0
                };
                if doubtful != 0 {
                    let mut values = [t.to_array(), u.to_array(), v.to_array()];
                    let hits = decide::<K>(self.all, rows, lane, doubtful, &mut values);
                    is_hit |= SimdMask::from_bitmask(self.token, u64::from(hits));
                    [t, u, v] = values.map(|x| f32x16::load_array(self.token, x));
                }
                let rank = rank(t, floor);
                let counts = is_hit & rank.simd_lt(self.end) & t.simd_lt(infinity);
                let is_best = counts
                    & precedes(
                        compared(rank, self.rank),
                        compared(t, self.t),
                        primitive.simd_lt(self.primitive),
                    );
                self.rank = is_best.select(rank, self.rank);
                self.t = is_best.select(t, self.t);
                self.u = is_best.select(u, self.u);
                self.v = is_best.select(v, self.v);
                self.primitive = is_best.select(primitive, self.primitive);
            }
        }
        self.rank
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        (self.blocks).announce::<false, S>(self.token, block, K::VALUES);
    }
}

#[inline(always)]
fn compared<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> Comparison<mask32x16<S>> {
    Comparison {
        is_less: a.simd_lt(b),
        is_equal: a.simd_eq(b),
    }
}

/// Decides about the rays whose bits are set, and returns the bits of those that hit.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
fn decide<K: Kernel>(
    rays: &[Ray; PACKET],
    rows: &[Row<K::Stored<f32>>],
    lane: usize,
    mut doubtful: u32,
    [t, u, v]: &mut [[f32; PACKET]; 3],
) -> u32 {
    let mut hits = 0;
    while doubtful != 0 {
        let i = doubtful.trailing_zeros() as usize % PACKET;
        doubtful &= doubtful - 1;
        if let Some(hit) = K::decide::<f32>(&rays[i], &LaneOf { rows, lane }) {
            [t[i], u[i], v[i]] = hit;
            hits |= 1 << i;
        }
    }
    hits
}

impl<K: Kernel> TreeIntersector<Ranked<K, f32, EveryLevel>> {
    /// Traces coherent rays as packets.
    pub fn trace_packets(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        /// One bit per packet marks those that aren't coherent.
        const AT_ONCE: usize = u64::BITS as usize * PACKET;
        for (rays, hits) in rays.chunks(AT_ONCE).zip(hits.chunks_mut(AT_ONCE)) {
            let (packets, rest) = rays.as_chunks::<PACKET>();
            let (hits_of_packets, hits_of_rest) = hits.as_chunks_mut::<PACKET>();
            let mut scratch = Scratch::new();
            let mut lent = LentStack::new();
            let stack = lent.get();
            let mut incoherent = dispatch!(self.level.level(), token => {
                    let mut incoherent = 0u64;
                    for (i, (rays, hits)) in packets.iter().zip(&mut *hits_of_packets).enumerate() {
                        // Tracing a packet takes less time than loading its rays from memory: without the
                        // prefetch throughput is a quarter lower (bunny, 2026-11).
                        prefetch(token, packets, i + 1, size_of_val(rays));
                        incoherent |= u64::from(!self.packet(token, rays, hits, stack, &mut scratch)) << i;
                    }
                    incoherent
            });
            while incoherent != 0 {
                let i = incoherent.trailing_zeros() as usize;
                incoherent &= incoherent - 1;
                self.closest_hits(&packets[i], &mut hits_of_packets[i]);
            }
            self.closest_hits(rest, hits_of_rest);
        }
    }

    /// Finds the hits of coherent rays; returns `false` if they aren't coherent.
    #[inline(always)]
    fn packet<S: Simd>(
        &self,
        token: S,
        rays: &[Ray; PACKET],
        hits: &mut [Option<Hit>; PACKET],
        stack: &mut Stack,
        scratch: &mut Scratch<K::Stored<f32>>,
    ) -> bool {
        let Some(packet) = RayPacket::new(token, rays) else {
            return false;
        };
        let Some(lanes) =
            RayLanes::side_by_side(packet.origin, packet.dir, [packet.t_min, packet.t_max])
        else {
            return false;
        };
        let nothing = -packet.t_max;
        let mut visitor = Nearest::<K, S> {
            token,
            all: rays,
            blocks: &self.blocks,
            scratch,
            rays: K::Prepared::from(lanes),
            t_min: packet.t_min,
            end: packet.t_max,
            rank: packet.t_max,
            t: nothing,
            u: nothing,
            v: nothing,
            primitive: u32x16::splat(token, NO_PRIMITIVE),
        };
        self.blocks
            .bvh
            .walk_packet(token, &packet, stack, &mut visitor);
        let (t, u, v) = (
            visitor.t.to_array(),
            visitor.u.to_array(),
            visitor.v.to_array(),
        );
        let primitive = visitor.primitive.to_array();
        let mut i = 0;
        while i < PACKET {
            hits[i] = (primitive[i] != NO_PRIMITIVE).then_some(Hit {
                t: t[i],
                u: u[i],
                v: v[i],
                primitive: primitive[i],
            });
            i += 1;
        }
        true
    }
}

//! Packets for kernels that decide about each primitive separately.

use super::{BlockLane, PacketMethod, PacketTester};
use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, RayPacket, Slabs, rank, rank_floor};
use crate::intersector::blocks::{LaneOf, LaneValues, Row, boxes};
use crate::intersector::levels::EveryLevel;
use crate::intersector::method::BlocksOf;
use crate::intersector::order::{Comparison, precedes};
use crate::intersector::ranked::Ranked;
use crate::kernel::{Kernel, RayLanes};
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use fearless_simd::{Simd, f32x16, mask32x16, prelude::*, u32x16};

/// Tests sixteen rays with the kernel `K`.
pub(in crate::intersector) struct RankedPacket<'a, K: Kernel, S: Simd> {
    token: S,
    all: &'a [Ray; PACKET],
    rays: K::Prepared<f32x16<S>>,
    t_min: f32x16<S>,
    end: f32x16<S>,
    rank: f32x16<S>,
    t: f32x16<S>,
    u: f32x16<S>,
    v: f32x16<S>,
    primitive: u32x16<S>,
}

/// The hits of a primitive.
struct Hits<S: Simd> {
    mask: mask32x16<S>,
    rank: f32x16<S>,
    t: f32x16<S>,
    u: f32x16<S>,
    v: f32x16<S>,
}

impl<K: Kernel> PacketMethod for Ranked<K, f32, EveryLevel> {
    type Packet<'a, S: Simd> = RankedPacket<'a, K, S>;

    #[inline(always)]
    fn packet<'a, S: Simd>(
        _: &'a BlocksOf<Self>,
        token: S,
        rays: &'a [Ray; PACKET],
        packet: &RayPacket<S>,
        lanes: RayLanes<f32x16<S>>,
    ) -> RankedPacket<'a, K, S> {
        let nothing = -packet.t_max;
        RankedPacket {
            token,
            all: rays,
            rays: K::Prepared::from(lanes),
            t_min: packet.t_min,
            end: packet.t_max,
            rank: packet.t_max,
            t: nothing,
            u: nothing,
            v: nothing,
            primitive: u32x16::splat(token, NO_PRIMITIVE),
        }
    }

    #[inline(always)]
    fn boxes<S: Simd>(token: S, rows: &[Row<K::Stored<f32>>]) -> Planes<[f32; BLOCK_SIZE]> {
        boxes::<K, f32, S>(token, rows)
    }

    #[inline(always)]
    fn write<S: Simd>(tester: &RankedPacket<'_, K, S>, hits: &mut [Option<Hit>; PACKET]) {
        let (t, u, v) = (
            tester.t.to_array(),
            tester.u.to_array(),
            tester.v.to_array(),
        );
        let primitive = tester.primitive.to_array();
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
    }
}

impl<K: Kernel, S: Simd> RankedPacket<'_, K, S> {
    /// The hits that rank no farther than `limit`.
    #[inline(always)]
    fn hits(
        &self,
        primitive: &BlockLane<'_, K::Stored<f32>>,
        slabs: &Slabs<S>,
        limit: f32x16<S>,
    ) -> Option<Hits<S>> {
        let &BlockLane {
            rows, boxes, lane, ..
        } = primitive;
        let values = LaneValues::new(self.token, rows, lane);
        let hit = K::intersect(&self.rays, &values, self.t_min, limit)?;
        let (entry, met) = slabs.enter_one(self.token, boxes, lane);
        let floor = rank_floor(entry);
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
        let infinity = f32x16::splat(self.token, f32::INFINITY);
        Some(Hits {
            mask: is_hit & rank.simd_lt(self.end) & t.simd_lt(infinity),
            rank,
            t,
            u,
            v,
        })
    }
}

impl<K: Kernel, S: Simd> PacketTester<S, K::Stored<f32>> for RankedPacket<'_, K, S> {
    #[inline(always)]
    fn nearest(&mut self, primitive: &BlockLane<'_, K::Stored<f32>>, slabs: &Slabs<S>) {
        let Some(hits) = self.hits(primitive, slabs, self.rank) else {
            return;
        };
        let Hits { rank, t, u, v, .. } = hits;
        let primitive = u32x16::splat(self.token, primitive.primitive);
        let is_best = hits.mask
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

    #[inline(always)]
    fn farthest(&self) -> f32x16<S> {
        self.rank
    }

    #[inline(always)]
    fn any(
        &mut self,
        primitive: &BlockLane<'_, K::Stored<f32>>,
        slabs: &Slabs<S>,
        ends: f32x16<S>,
    ) -> mask32x16<S> {
        match self.hits(primitive, slabs, ends) {
            Some(hits) => hits.mask,
            None => mask32x16::splat(self.token, false),
        }
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

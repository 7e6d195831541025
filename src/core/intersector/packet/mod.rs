//! Traces packets of sixteen rays, one ray per lane. For rays with similar origins and directions, such as a
//! camera's or those to one lamp.
//!
//! [`PacketMethod`] is the capability of a [`Method`]; its testers are `ranked` and `exact`. `search` traces packets, and
//! `back_off` decides when it abandons one because single rays are faster.

mod back_off;
mod exact;
mod ranked;
mod search;

use super::blocks::Row;
use super::method::{BlocksOf, Method};
use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, RayPacket, Slabs};
use crate::kernel::RayLanes;
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use fearless_simd::{Simd, f32x16, mask32x16};

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

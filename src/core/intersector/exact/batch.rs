//! Rounds the hits of several rays together.

use super::{Exact, SlotCorners};
use crate::bvh::NO_PRIMITIVE;
use crate::intersector::method::{BlocksOf, Method};
use crate::kernel::exact::{Candidate, HitLanes, Judge};
use crate::lane::LANES;
use crate::ray::{Hit, Ray};
use crate::shape::{Shape, Triangle};
use fearless_simd::Simd;
use glam::Vec3;

const BATCH_SIZE: usize = <Exact<Triangle> as Method>::BATCH_SIZE;

/// The hits of some rays, before rounding.
pub(in crate::intersector) struct Batch {
    lanes: [HitLanes; BATCH_SIZE / LANES],
    found: [Kept; BATCH_SIZE],
    count: usize,
}

impl Batch {
    pub const EMPTY: Self = Self {
        lanes: [HitLanes::EMPTY; BATCH_SIZE / LANES],
        found: [Kept::NOTHING; BATCH_SIZE],
        count: 0,
    };

    /// Adds the hit of the ray of this index.
    #[inline(always)]
    pub fn add(&mut self, index: usize, ray: &Ray, found: &Candidate, corners: [Vec3; 3]) {
        let count = self.count;
        self.lanes[count / LANES].set(count % LANES, ray, corners);
        self.found[count] = Kept {
            index: index as u32,
            primitive: found.primitive,
            slot: found.slot as u32,
        };
        self.count += 1;
    }
}

/// A hit in a batch.
#[derive(Clone, Copy)]
struct Kept {
    /// Index of the ray.
    index: u32,
    primitive: u32,
    slot: u32,
}

impl Kept {
    const NOTHING: Self = Self {
        index: 0,
        primitive: NO_PRIMITIVE,
        slot: 0,
    };
}

/// Rounds the batch's hits.
#[inline(always)]
pub(super) fn round<T: Shape + Into<Triangle>, S: Simd>(
    blocks: &BlocksOf<Exact<T>>,
    token: S,
    rays: &[Ray],
    batch: &Batch,
    hits: &mut [Option<Hit>],
) {
    let groups = batch.found[..batch.count].chunks(LANES);
    for (found, lanes) in groups.zip(&batch.lanes) {
        let values = lanes.values(token);
        for (lane, kept) in found.iter().enumerate() {
            let Kept {
                index,
                primitive,
                slot,
            } = *kept;
            let hit = &mut hits[index as usize];
            match values.of(lane, primitive) {
                Some(rounded) => *hit = Some(rounded),
                None => round_alone(&rays[index as usize], blocks, primitive, slot, hit),
            }
        }
    }
}

/// Writes the hit of a primitive in a slot, with t, u and v computed with as many digits as they need.
// Not inlined: this path is rare. It writes through `hit`: an `Option<Hit>` that comes from two paths is put together
// on the stack by small stores and copied by a large load, which waits for them. That takes 6 % of the time of a
// packet (bunny, AMD Zen 4, 2026-11).
#[inline(never)]
pub(in crate::intersector) fn round_alone<T: Shape + Into<Triangle>>(
    ray: &Ray,
    blocks: &BlocksOf<Exact<T>>,
    primitive: u32,
    slot: u32,
    hit: &mut Option<Hit>,
) {
    let slot = slot as usize;
    let candidate = Candidate::new(primitive, slot, f32::NEG_INFINITY, f32::INFINITY);
    *hit = Some(Judge::new(ray, SlotCorners(blocks)).hit(candidate));
}

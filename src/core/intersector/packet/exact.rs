//! Packets for triangles whose hits are decided and ordered as in exact arithmetic.
//!
//! The f32 filter decides about sixteen rays at once. The judge of single rays decides about those that the filter
//! leaves open: about the hit, about the interval, or about the order of two hits whose depth bounds overlap.

use super::{BlockLane, PacketMethod, PacketTester};
use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, RayPacket, Slabs};
use crate::intersector::blocks::{BlockValues, LaneValues, Row, stored};
use crate::intersector::exact::{Batch, Exact, Kept, LaneCandidate, SlotCorners, nearer};
use crate::intersector::method::BlocksOf;
use crate::kernel::exact::{Candidate, Corners as _, DepthInterval, Filtered, Judge, filter};
use crate::kernel::{RayLanes, ShearedRay};
use crate::lane::{LANES, Lane, LaneMask, PACKET};
use crate::ray::{Hit, Ray};
use crate::shape::{Shape, Triangle};
use fearless_simd::{Simd, f32x8, f32x16, mask32x16, prelude::*, u32x16};

/// Tests sixteen rays.
pub(in crate::intersector) struct ExactPacket<'a, T: Shape + Into<Triangle>, S: Simd> {
    token: S,
    rays: &'a [Ray; PACKET],
    corners: SlotCorners<'a, T>,
    lanes: RayLanes<f32x16<S>>,
    sheared: ShearedRay<f32x16<S>>,
    interval: DepthInterval<f32x16<S>>,
    /// Factor from depth to t.
    t_per_depth: f32x16<S>,
    t_max: f32x16<S>,
    /// Bounds of the depth of the nearest hit so far; infinite if there is none.
    near: f32x16<S>,
    far: f32x16<S>,
    /// The nearest triangles so far, or [`NO_PRIMITIVE`].
    primitive: u32x16<S>,
    /// Their slots.
    slot: u32x16<S>,
}

/// The nearest hits so far, ray by ray.
struct NearestEach {
    near: [f32; PACKET],
    far: [f32; PACKET],
    primitive: [u32; PACKET],
    slot: [u32; PACKET],
}

/// A triangle that some rays may hit.
struct Tested {
    primitive: u32,
    slot: u32,
    near: [f32; PACKET],
    far: [f32; PACKET],
    /// A bit for each ray whose line certainly meets the triangle.
    certain: u32,
}

impl Tested {
    fn of(&self, ray: usize) -> LaneCandidate {
        LaneCandidate {
            primitive: self.primitive,
            slot: self.slot,
            near: self.near[ray],
            far: self.far[ray],
            is_certain: self.certain >> ray & 1 == 1,
        }
    }
}

impl<T: Shape + Into<Triangle>> PacketMethod for Exact<T> {
    type Packet<'a, S: Simd> = ExactPacket<'a, T, S>;

    #[inline(always)]
    fn packet<'a, S: Simd>(
        blocks: &'a BlocksOf<Self>,
        token: S,
        rays: &'a [Ray; PACKET],
        packet: &RayPacket<S>,
        lanes: RayLanes<f32x16<S>>,
    ) -> ExactPacket<'a, T, S> {
        let sheared = ShearedRay::new(&lanes);
        let interval = DepthInterval::new(&lanes, &sheared);
        let infinity = Lane::splat(token, f32::INFINITY);
        let nothing = u32x16::splat(token, NO_PRIMITIVE);
        ExactPacket {
            token,
            rays,
            corners: SlotCorners(blocks),
            lanes,
            sheared,
            t_per_depth: <f32x16<S> as Lane>::splat(token, 1.0) / interval.per_t,
            interval,
            t_max: packet.t_max,
            near: infinity,
            far: infinity,
            primitive: nothing,
            slot: nothing,
        }
    }

    #[inline(always)]
    fn boxes<S: Simd>(token: S, rows: &[Row<f32>]) -> Planes<[f32; BLOCK_SIZE]> {
        let values = BlockValues::<f32, S, f32>::new(token, rows);
        stored(Triangle::planes::<f32x8<S>>(&values))
    }

    #[inline(always)]
    fn keep_packet<S: Simd>(
        tester: &ExactPacket<'_, T, S>,
        first: usize,
        hits: &mut [Option<Hit>],
        batch: &mut Batch,
    ) {
        hits[first..][..PACKET].fill(None);
        let (primitive, slot) = (tester.primitive.to_array(), tester.slot.to_array());
        let (origin, dir) = (halves(tester.lanes.origin), halves(tester.lanes.dir));
        let mut half = 0;
        while half < 2 {
            let start = half * LANES;
            let (primitive, slot) = (&primitive[start..][..LANES], &slot[start..][..LANES]);
            if primitive.iter().any(|&p| p != NO_PRIMITIVE) {
                let (lanes, kept) = batch.next_lanes();
                lanes.set_rays(origin[half], dir[half], tester.lanes.axes);
                let mut lane = 0;
                while lane < LANES {
                    kept[lane] = Kept {
                        index: (first + start + lane) as u32,
                        primitive: primitive[lane],
                        slot: slot[lane],
                    };
                    if primitive[lane] != NO_PRIMITIVE {
                        lanes.set_corners(lane, tester.corners.corners(slot[lane] as usize));
                    }
                    lane += 1;
                }
            }
            half += 1;
        }
    }
}

/// The first and the second half of the lanes.
#[inline(always)]
fn halves<S: Simd>([x, y, z]: [f32x16<S>; 3]) -> [[[f32; LANES]; 3]; 2] {
    let (x, y, z) = (x.split(), y.split(), z.split());
    [
        [x.0.to_array(), y.0.to_array(), z.0.to_array()],
        [x.1.to_array(), y.1.to_array(), z.1.to_array()],
    ]
}

impl<T: Shape + Into<Triangle>, S: Simd> ExactPacket<'_, T, S> {
    /// Bounds of the depth at which the rays meet a triangle, and the rays that may hit it in their interval at a
    /// depth of at most `deepest`.
    #[inline(always)]
    fn test(
        &self,
        triangle: &BlockLane<'_, f32>,
        deepest: f32x16<S>,
    ) -> Option<(Filtered<f32x16<S>>, mask32x16<S>)> {
        let values = LaneValues::new(self.token, triangle.rows, triangle.lane);
        let found = filter(&self.sheared, &values)?;
        let is_outside =
            deepest.simd_lt(found.near()) | found.far().simd_lt(self.interval.earliest);
        let is_possible = !(found.missed | is_outside);
        is_possible.any().then_some((found, is_possible))
    }

    /// The triangle with the rays' bounds in memory.
    #[inline(always)]
    fn tested(&self, triangle: &BlockLane<'_, f32>, found: &Filtered<f32x16<S>>) -> Tested {
        Tested {
            primitive: triangle.primitive,
            slot: slot_of(triangle),
            near: found.near().to_array(),
            far: found.far().to_array(),
            certain: found.certain.bits(),
        }
    }
}

#[inline(always)]
fn slot_of(triangle: &BlockLane<'_, f32>) -> u32 {
    (triangle.block * BLOCK_SIZE + triangle.lane) as u32
}

impl<T: Shape + Into<Triangle>, S: Simd> PacketTester<S, f32> for ExactPacket<'_, T, S> {
    #[inline(always)]
    fn nearest(&mut self, triangle: &BlockLane<'_, f32>, _: &Slabs<S>) {
        let Some((found, is_possible)) = self.test(triangle, self.far) else {
            return;
        };
        let (near, far) = (found.near(), found.far());
        let is_known = found.certain & self.interval.contains(near, far);
        let is_best = is_possible & is_known & far.simd_lt(self.near);
        let open = (is_possible & !is_best).bits();
        self.near = is_best.select(near, self.near);
        self.far = is_best.select(far, self.far);
        self.primitive = is_best.select(
            u32x16::splat(self.token, triangle.primitive),
            self.primitive,
        );
        self.slot = is_best.select(u32x16::splat(self.token, slot_of(triangle)), self.slot);
        if open != 0 {
            let mut each = NearestEach {
                near: self.near.to_array(),
                far: self.far.to_array(),
                primitive: self.primitive.to_array(),
                slot: self.slot.to_array(),
            };
            let tested = self.tested(triangle, &found);
            decide(self.rays, self.corners, &tested, open, &mut each);
            self.near = f32x16::load_array(self.token, each.near);
            self.far = f32x16::load_array(self.token, each.far);
            self.primitive = u32x16::load_array(self.token, each.primitive);
            self.slot = u32x16::load_array(self.token, each.slot);
        }
    }

    #[inline(always)]
    fn farthest(&self) -> f32x16<S> {
        // Rounded twice; the slack with which boxes are visited covers that.
        (self.far * self.t_per_depth).lesser(self.t_max)
    }

    #[inline(always)]
    fn any(
        &mut self,
        triangle: &BlockLane<'_, f32>,
        _: &Slabs<S>,
        ends: f32x16<S>,
    ) -> mask32x16<S> {
        let nothing = mask32x16::splat(self.token, false);
        let Some((found, is_possible)) = self.test(triangle, self.interval.deepest(ends)) else {
            return nothing;
        };
        let is_known = found.certain & self.interval.contains(found.near(), found.far());
        let open = (is_possible & !is_known).bits();
        let mut is_hit = is_possible & is_known;
        if open != 0 {
            let tested = self.tested(triangle, &found);
            let hits = decide_any(self.rays, self.corners, &tested, open);
            is_hit |= SimdMask::from_bitmask(self.token, u64::from(hits));
        }
        is_hit
    }
}

/// Decides about the rays whose bits are set.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
fn decide<T: Shape + Into<Triangle>>(
    rays: &[Ray; PACKET],
    corners: SlotCorners<'_, T>,
    tested: &Tested,
    mut open: u32,
    nearest: &mut NearestEach,
) {
    while open != 0 {
        let i = open.trailing_zeros() as usize % PACKET;
        open &= open - 1;
        let (primitive, slot) = (nearest.primitive[i], nearest.slot[i]);
        let is_hit = primitive != NO_PRIMITIVE;
        let bounds = [nearest.near[i], nearest.far[i]];
        let so_far = is_hit.then(|| Candidate::new(primitive, slot as usize, bounds[0], bounds[1]));
        let mut judge = Judge::new(&rays[i], corners);
        if let Some(found) = nearer(&mut judge, &tested.of(i), so_far) {
            [nearest.near[i], nearest.far[i]] = found.bounds_f32();
            (nearest.primitive[i], nearest.slot[i]) = (found.primitive, found.slot as u32);
        }
    }
}

/// Decides about the rays whose bits are set, and returns the bits of those that hit.
#[inline(never)]
fn decide_any<T: Shape + Into<Triangle>>(
    rays: &[Ray; PACKET],
    corners: SlotCorners<'_, T>,
    tested: &Tested,
    mut open: u32,
) -> u32 {
    let mut hits = 0;
    while open != 0 {
        let i = open.trailing_zeros() as usize % PACKET;
        open &= open - 1;
        let hit = tested.of(i);
        let mut judge = Judge::new(&rays[i], corners);
        if judge.within(hit.candidate(), hit.is_certain).is_some() {
            hits |= 1 << i;
        }
    }
    hits
}

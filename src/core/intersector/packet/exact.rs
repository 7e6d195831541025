//! Packets for triangles whose hits are decided and ordered as in exact arithmetic.
//!
//! The f32 filter decides about sixteen rays at once. The judge of single rays decides about those that the filter
//! leaves open: about the hit, about the interval, or about the order of two hits whose depth bounds overlap.

use super::{BlockLane, PacketMethod, PacketTester};
use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, NO_PRIMITIVE, RayPacket, Slabs};
use crate::intersector::blocks::{BlockValues, LaneValues, Row, stored};
use crate::intersector::exact::{Exact, LaneCandidate, SlotCorners, nearer, round_alone};
use crate::intersector::method::BlocksOf;
use crate::kernel::exact::{Candidate, DepthInterval, Filtered, HitLanes, Judge, VALUES, filter};
use crate::kernel::{RayLanes, ShearedRay};
use crate::lane::{LANES, Lane, LaneMask, PACKET, Values as _};
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
    fn write<S: Simd>(tester: &ExactPacket<'_, T, S>, hits: &mut [Option<Hit>; PACKET]) {
        *hits = [None; PACKET];
        let is_hit = tester.primitive.simd_lt(NO_PRIMITIVE).to_bitmask() as u32;
        if is_hit == 0 {
            return;
        }
        let (primitive, slot) = (tester.primitive.to_array(), tester.slot.to_array());
        let groups = tester.hit_lanes(is_hit, &slot);
        let mut half = 0;
        while half < groups.len() {
            let values = groups[half].values(tester.token);
            let mut lane = 0;
            while lane < LANES {
                let i = half * LANES + lane;
                if is_hit >> i & 1 == 1 {
                    match values.of(lane, primitive[i]) {
                        Some(hit) => hits[i] = Some(hit),
                        None => round_alone(
                            &tester.rays[i],
                            tester.corners.0,
                            primitive[i],
                            slot[i],
                            &mut hits[i],
                        ),
                    }
                }
                lane += 1;
            }
            half += 1;
        }
    }
}

/// The first and the second half of the lanes.
#[inline(always)]
fn halves<S: Simd, const COUNT: usize>(rows: &[f32x16<S>; COUNT]) -> [[[f32; LANES]; COUNT]; 2] {
    let mut halves = [[[0.0; LANES]; COUNT]; 2];
    let mut k = 0;
    while k < COUNT {
        let (first, second) = rows[k].split();
        (halves[0][k], halves[1][k]) = (first.to_array(), second.to_array());
        k += 1;
    }
    halves
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

    /// The rays whose bits are set and the triangles that they hit, in two groups.
    #[inline(always)]
    fn hit_lanes(&self, is_hit: u32, slot: &[u32; PACKET]) -> [HitLanes; 2] {
        let mut corners = [Lane::splat(self.token, 0.0); VALUES];
        // Triangle by triangle: several rays often hit the same one.
        let mut left = is_hit;
        while left != 0 {
            let slot = slot[left.trailing_zeros() as usize % PACKET];
            let is_same = self.slot.simd_eq(slot);
            left &= !(is_same.to_bitmask() as u32);
            let slot = slot as usize;
            let rows = self.corners.0.packed(slot / BLOCK_SIZE, VALUES);
            let triangle = LaneValues::new(self.token, rows, slot % BLOCK_SIZE);
            let mut k = 0;
            while k < VALUES {
                corners[k] = is_same.select(triangle.value(k), corners[k]);
                k += 1;
            }
        }
        let origin = halves(&self.lanes.origin);
        let (dir, corners) = (halves(&self.lanes.dir), halves(&corners));
        let axes = self.lanes.axes;
        let group = |half: usize| HitLanes {
            origin: origin[half],
            dir: dir[half],
            corners: corners[half],
            axes,
        };
        [group(0), group(1)]
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

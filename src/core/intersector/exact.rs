//! A mesh, packed for the exact kernel: hits are weighed against each other as exact arithmetic orders
//! them.

use super::blocks::{Blocks, candidates, is_asked};
use super::{Cost, Crossing, Intersector, is_behind};
use crate::bvh::{BLOCK_SIZE, Bvh, NO_PRIMITIVE, Stack, Visitor, with_stack};
use crate::kernel::exact::{Candidate, Filtered, HitLanes, INFO, Judge, VALUES, filter};
use crate::kernel::{KernelInfo, ShearedRay, pack_corners};
use crate::lane::{LANES, Lane, LaneMask, Number};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::simd::{SimdLevel, baseline};
use fearless_simd::{Simd, dispatch};
use glam::Vec3;
use std::cmp::Ordering;
use std::ops::ControlFlow;
use std::sync::Arc;

type Vector<S> = <f32 as Number>::Lanes<S>;

/// Triangles for the exact kernel.
pub(crate) struct ExactIntersector {
    blocks: Blocks<f32>,
    level: SimdLevel,
}

/// One ray against blocks.
struct Tester<'a, S: Simd, F> {
    intersector: &'a ExactIntersector,
    token: S,
    sheared: ShearedRay<Vector<S>>,
    judge: Judge<'a, F>,
    /// Depths below this are before the ray's interval: among them those of the triangle that it leaves.
    earliest: f32,
    /// t is a depth times this.
    inverse_dir_z: f32,
}

/// A lane of a block that isn't a certain miss, and not certainly too deep.
#[derive(Clone, Copy)]
struct Sighted {
    primitive: u32,
    /// Where its corners are found.
    slot: u32,
    /// Bounds on its depth.
    near: f32,
    far: f32,
    is_certain: bool,
}

impl Sighted {
    fn candidate(&self) -> Candidate {
        Candidate::new(self.primitive, self.slot as usize, self.near, self.far)
    }
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Tester<'_, S, F> {
    /// Hands each lane of a block that may be hit in the ray's interval, at a depth of at most `deepest`, to `sighted`, until that
    /// breaks.
    #[inline(always)]
    fn test(
        &mut self,
        block: usize,
        deepest: f32,
        mut sighted: impl FnMut(&mut Judge<'_, F>, Sighted) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let blocks = &self.intersector.blocks;
        let values = blocks.values::<f32, S>(self.token, block, VALUES);
        let Some(filtered) = filter(&self.sheared, &values) else {
            return ControlFlow::Continue(());
        };
        let Filtered {
            certain,
            missed,
            near,
            far,
            ..
        } = filtered;
        let splat = |x: f32| Vector::<S>::splat(self.token, x);
        let is_outside = certain & (splat(deepest).lt(near) | far.lt(splat(self.earliest)));
        let certain = certain.bits();
        let mut lanes = !(missed | is_outside).bits() & ((1 << BLOCK_SIZE) - 1);
        let (near, far) = (f32::store(near), f32::store(far));
        let primitives = blocks.bvh.lanes(block);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK_SIZE;
            lanes &= lanes - 1;
            let primitive = primitives[lane];
            if is_asked(primitive, self.judge.ray().exclude) {
                let hit = Sighted {
                    primitive,
                    slot: (block * BLOCK_SIZE + lane) as u32,
                    near: near[lane],
                    far: far[lane],
                    is_certain: certain >> lane & 1 == 1,
                };
                sighted(&mut self.judge, hit)?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.intersector.blocks.announce(self.token, block, VALUES);
    }
}

/// Looks for the nearest hit.
struct Nearest<'a, S: Simd, F> {
    tester: Tester<'a, S, F>,
    /// The nearest so far, or [`NO_PRIMITIVE`] and infinity.
    best: Sighted,
    /// The same, where it had to be looked at more closely.
    weighed: Option<Candidate>,
    t_max: f32,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Nearest<'_, S, F> {
    #[inline(always)]
    fn candidate(&self) -> Option<Candidate> {
        let is_hit = self.best.primitive != NO_PRIMITIVE;
        is_hit.then(|| self.weighed.unwrap_or_else(|| self.best.candidate()))
    }
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Visitor for Nearest<'_, S, F> {
    const IS_ORDERED: bool = true;
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: f32) -> ControlFlow<(), f32> {
        let (best, weighed) = (&mut self.best, &mut self.weighed);
        let deepest = best.far;
        _ = self.tester.test(block, deepest, |judge, hit| {
            let [start, end] = judge.interval();
            let is_inside = start < f64::from(hit.near) && f64::from(hit.far) < end;
            if hit.is_certain && is_inside && hit.far < best.near {
                (*best, *weighed) = (hit, None);
            } else if !(hit.is_certain && best.far < hit.near) {
                let nearest = weigh(judge, &hit, best, *weighed);
                if let Some(nearest) = nearest {
                    [best.near, best.far] = nearest.bounds_f32();
                    (best.primitive, *weighed) = (nearest.primitive, Some(nearest));
                }
            }
            ControlFlow::Continue(())
        });
        // Rounded twice, which what boxes are allowed beyond it pays for.
        let t = self.best.far * self.tester.inverse_dir_z;
        ControlFlow::Continue(t.min(self.t_max))
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// The nearer of a hit and the nearest so far, where f32 doesn't tell.
// Out of line: it is the rare path, and the common one is the better for it.
#[inline(never)]
fn weigh<F: Fn(usize) -> [Vec3; 3]>(
    judge: &mut Judge<'_, F>,
    hit: &Sighted,
    best: &Sighted,
    weighed: Option<Candidate>,
) -> Option<Candidate> {
    let best =
        (best.primitive != NO_PRIMITIVE).then(|| weighed.unwrap_or_else(|| best.candidate()));
    nearer(judge, hit, best)
}

fn nearer<F: Fn(usize) -> [Vec3; 3]>(
    judge: &mut Judge<'_, F>,
    hit: &Sighted,
    best: Option<Candidate>,
) -> Option<Candidate> {
    let Some(mut hit) = judge.within(hit.candidate(), hit.is_certain) else {
        return best;
    };
    match best {
        Some(mut best) => Some(if judge.is_before(&mut hit, &mut best) {
            hit
        } else {
            best
        }),
        None => Some(hit),
    }
}

/// Looks for a hit, whichever.
struct Any<'a, S: Simd, F> {
    tester: Tester<'a, S, F>,
    is_hit: bool,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Visitor for Any<'_, S, F> {
    const IS_ORDERED: bool = false;
    const IS_BEHIND: bool = false;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: f32) -> ControlFlow<(), f32> {
        let is_hit = &mut self.is_hit;
        self.tester.test(block, f32::INFINITY, |judge, hit| {
            *is_hit = judge.within(hit.candidate(), hit.is_certain).is_some();
            if *is_hit {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        ControlFlow::Continue(self.tester.judge.ray().t_max)
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.tester.announce(block);
    }

    #[inline(always)]
    fn count_boxes(&mut self, _: u32) {}
}

/// Which hits are kept.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kept {
    Nearest,
    All,
}

/// Keeps hits, and counts what they cost: for rarer questions, and rays whose interval begins behind
/// their origin.
struct Each<'a, S: Simd, F> {
    tester: Tester<'a, S, F>,
    kept: Kept,
    hits: Vec<Candidate>,
    cost: Cost,
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Each<'_, S, F> {
    /// Hits deeper than this aren't kept.
    fn deepest(&self) -> f32 {
        match self.hits.first() {
            Some(nearest) if self.kept == Kept::Nearest => nearest.bounds_f32()[1],
            _ => f32::INFINITY,
        }
    }
}

impl<S: Simd, F: Fn(usize) -> [Vec3; 3]> Visitor for Each<'_, S, F> {
    const IS_ORDERED: bool = true;
    const IS_BEHIND: bool = true;

    fn visit(&mut self, block: usize, _: f32) -> ControlFlow<(), f32> {
        let primitives = self.tester.intersector.blocks.bvh.block(block);
        self.cost.triangles += primitives.len() as u32;
        let (deepest, kept, hits) = (self.deepest(), self.kept, &mut self.hits);
        _ = self.tester.test(block, deepest, |judge, hit| {
            match kept {
                Kept::Nearest => {
                    let nearest = nearer(judge, &hit, hits.pop());
                    hits.extend(nearest);
                }
                Kept::All => hits.extend(judge.within(hit.candidate(), hit.is_certain)),
            }
            ControlFlow::Continue(())
        });
        let t = self.deepest() * self.tester.inverse_dir_z;
        ControlFlow::Continue(t.min(self.tester.judge.ray().t_max))
    }

    fn announce(&self, _: usize) {}

    fn count_boxes(&mut self, count: u32) {
        self.cost.boxes += count;
    }
}

impl ExactIntersector {
    pub fn new(mesh: &TriangleMesh, bvh: Arc<Bvh>, level: SimdLevel) -> Self {
        Self {
            blocks: Blocks::new(mesh, bvh, VALUES, None, pack_corners),
            level,
        }
    }

    /// The corners in a slot, a lane of a block. From there and not from the mesh: they are in the cache.
    #[inline(always)]
    fn corners(&self, slot: usize) -> [Vec3; 3] {
        let values = self
            .blocks
            .lane(slot / BLOCK_SIZE, slot % BLOCK_SIZE, VALUES);
        [values.vector(0), values.vector(3), values.vector(6)]
    }

    #[inline(always)]
    fn tester<'a, S: Simd>(
        &'a self,
        token: S,
        ray: &'a Ray,
    ) -> Tester<'a, S, impl Fn(usize) -> [Vec3; 3]> {
        let judge = Judge::new(ray, |slot| self.corners(slot));
        Tester {
            intersector: self,
            token,
            sheared: ShearedRay::of(token, ray),
            earliest: judge.earliest(),
            judge,
            inverse_dir_z: 1.0 / ray.dir.abs().max_element(),
        }
    }

    #[inline(always)]
    fn nearest<S: Simd>(&self, token: S, ray: &Ray, stack: &mut Stack) -> Option<Candidate> {
        let mut visitor = Nearest {
            tester: self.tester(token, ray),
            best: Sighted {
                primitive: NO_PRIMITIVE,
                slot: 0,
                near: f32::INFINITY,
                far: f32::INFINITY,
                is_certain: true,
            },
            weighed: None,
            t_max: ray.t_max,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.candidate()
    }

    #[inline(always)]
    fn any<S: Simd>(&self, token: S, ray: &Ray, stack: &mut Stack) -> bool {
        let mut visitor = Any {
            tester: self.tester(token, ray),
            is_hit: false,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.is_hit
    }

    fn each(&self, ray: &Ray, kept: Kept) -> (Vec<Candidate>, Cost) {
        with_stack(|stack| {
            let mut visitor = Each {
                tester: self.tester(baseline(), ray),
                kept,
                hits: Vec::new(),
                cost: Cost::default(),
            };
            self.blocks.bvh.walk(baseline(), ray, stack, &mut visitor);
            let work = visitor.tester.judge.work;
            let cost = Cost {
                in_f64: work.in_f64,
                in_integers: work.in_integers,
                ..visitor.cost
            };
            (visitor.hits, cost)
        })
    }

    #[inline(always)]
    fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let mut tester = self.tester(token, ray);
        let mut count = 0;
        for block in 0..self.blocks.bvh.block_count() {
            _ = tester.test(block, f32::INFINITY, |judge, hit| {
                count += usize::from(judge.within(hit.candidate(), hit.is_certain).is_some());
                ControlFlow::Continue(())
            });
        }
        count
    }

    /// Finds what rays hit first, for those that don't begin behind their origins.
    #[inline(always)]
    fn find<S: Simd>(&self, token: S, rays: &[Ray], batch: &mut Batch, stack: &mut Stack) {
        let mut i = 0;
        while i < rays.len() {
            if !is_behind(&rays[i])
                && let Some(candidate) = self.nearest(token, &rays[i], stack)
            {
                // Now, while the corners are in the cache.
                let corners = self.corners(candidate.slot);
                let count = batch.count;
                batch.lanes[count / LANES].set(count % LANES, &rays[i], corners);
                batch.found[count] = Some((i, candidate));
                batch.count += 1;
            }
            i += 1;
        }
    }

    /// Rounds what was found.
    #[inline(always)]
    fn round<S: Simd>(&self, token: S, rays: &[Ray], batch: &Batch, hits: &mut [Option<Hit>]) {
        let groups = batch.found[..batch.count].chunks(LANES);
        for (found, lanes) in groups.zip(&batch.lanes) {
            let values = lanes.values(token);
            for (lane, (i, candidate)) in found.iter().flatten().enumerate() {
                hits[*i] = Some(match values.of(lane) {
                    Some(values) => candidate.hit(values),
                    None => Judge::new(&rays[*i], |slot| self.corners(slot)).hit(*candidate),
                });
            }
        }
    }
}

/// What some rays hit, before it is rounded.
struct Batch {
    lanes: [HitLanes; ROUNDED_TOGETHER / LANES],
    /// The ray's index, and the hit.
    found: [Option<(usize, Candidate)>; ROUNDED_TOGETHER],
    count: usize,
}

/// Rays whose hits are rounded together, after they have been traced: so many that few lanes stay empty.
const ROUNDED_TOGETHER: usize = 64;

impl Intersector for ExactIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        &INFO
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        with_stack(|stack| {
            let chunks = rays.chunks(ROUNDED_TOGETHER);
            for (rays, hits) in chunks.zip(hits.chunks_mut(ROUNDED_TOGETHER)) {
                let mut batch = Batch {
                    lanes: [HitLanes::EMPTY; ROUNDED_TOGETHER / LANES],
                    found: [None; ROUNDED_TOGETHER],
                    count: 0,
                };
                let level = self.level.level();
                dispatch!(level, token => self.find(token, rays, &mut batch, stack));
                hits.fill(None);
                // Apart from the search, which otherwise loses a tenth (bunny, primary rays, 2026-11).
                dispatch!(level, token => self.round(token, rays, &batch, hits));
            }
        });
        for (ray, hit) in rays.iter().zip(hits).filter(|(ray, _)| is_behind(ray)) {
            *hit = self.closest_hit_with_cost(ray).0;
        }
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let (nearest, cost) = self.each(ray, Kept::Nearest);
        let judge = Judge::new(ray, |slot| self.corners(slot));
        (nearest.first().map(|hit| judge.hit(*hit)), cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        with_stack(|stack| {
            dispatch!(self.level.level(), token => {
                for (ray, is_hit) in rays.iter().zip(&mut *are_hits) {
                    if !is_behind(ray) {
                        *is_hit = self.any(token, ray, stack);
                    }
                }
            });
        });
        for (ray, is_hit) in rays.iter().zip(are_hits).filter(|(ray, _)| is_behind(ray)) {
            *is_hit = !self.each(ray, Kept::Nearest).0.is_empty();
        }
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let (mut hits, _) = self.each(ray, Kept::All);
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        if hits.len() > 1 {
            // Once, before each is compared with several.
            hits.iter_mut().for_each(|hit| _ = judge.narrow(hit));
        }
        hits.sort_by(|a, b| {
            let by_t = judge.compare(&mut { *a }, &mut { *b });
            by_t.then(a.primitive.cmp(&b.primitive))
        });
        let mut crossings: Vec<(Candidate, Vec<u32>)> = Vec::new();
        for mut hit in hits {
            if let Some((first, also)) = crossings.last_mut()
                && judge.compare(first, &mut hit) == Ordering::Equal
            {
                also.push(hit.primitive);
            } else {
                crossings.push((hit, Vec::new()));
            }
        }
        crossings
            .into_iter()
            .map(|(first, also)| Crossing {
                hit: judge.hit(first),
                also,
            })
            .collect()
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        candidates(&self.blocks.bvh, ray)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        dispatch!(self.level.level(), token => self.count(token, ray))
    }

    fn bytes(&self) -> usize {
        self.blocks.bytes()
    }
}

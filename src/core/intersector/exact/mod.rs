//! Intersector of a mesh for the exact kernel, which orders hits as exact arithmetic does.

mod visitors;

use super::blocks::{Blocks, Scratch, candidates};
use super::compact::{EmptyLanes, Packing};
use super::{Cost, Crossing, Intersector, answer_behind, is_behind};
use crate::bvh::{BLOCK_SIZE, Bvh, NO_PRIMITIVE, Stack, with_stack};
use crate::kernel::exact::{Candidate, HitLanes, INFO, Judge, VALUES};
use crate::kernel::{KernelInfo, ShearedRay, pack_corners};
use crate::lane::{LANES, Number};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::simd::{SimdLevel, baseline};
use fearless_simd::{Simd, dispatch};
use glam::Vec3;
use std::cmp::Ordering;
use std::ops::ControlFlow;
use std::sync::Arc;
use visitors::{Any, Each, KeptHits, LaneCandidate, Nearest, Tester};

type Vector<S> = <f32 as Number>::Lanes<S>;

/// Triangles packed for the exact kernel.
pub(crate) struct ExactIntersector {
    blocks: Blocks<f32>,
    level: SimdLevel,
}

impl ExactIntersector {
    pub fn new(mesh: &TriangleMesh, bvh: Arc<Bvh>, level: SimdLevel, packing: Packing) -> Self {
        let empty = EmptyLanes::First;
        Self {
            blocks: Blocks::new(mesh, bvh, packing, VALUES, empty, pack_corners),
            level,
        }
    }

    /// The corners in a slot, which is a lane of a block. They are read from the block, not from the mesh,
    /// because the block is in the cache.
    #[inline(always)]
    fn corners(&self, slot: usize) -> [Vec3; 3] {
        self.blocks.corners(slot / BLOCK_SIZE, slot % BLOCK_SIZE)
    }

    #[inline(always)]
    fn tester<'a, const MAYBE_COMPACT: bool, S: Simd>(
        &'a self,
        token: S,
        ray: &'a Ray,
        scratch: &'a mut Scratch<f32>,
    ) -> Tester<'a, S, impl Fn(usize) -> [Vec3; 3], MAYBE_COMPACT> {
        let judge = Judge::new(ray, |slot| self.corners(slot));
        Tester {
            intersector: self,
            token,
            scratch,
            sheared: ShearedRay::of(token, ray),
            earliest: judge.earliest(),
            judge,
            inverse_dir_z: 1.0 / ray.dir.abs().max_element(),
        }
    }

    #[inline(always)]
    fn nearest<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        scratch: &mut Scratch<f32>,
    ) -> Option<Candidate> {
        let mut visitor = Nearest {
            tester: self.tester::<MAYBE_COMPACT, S>(token, ray, scratch),
            best: LaneCandidate {
                primitive: NO_PRIMITIVE,
                slot: 0,
                near: f32::INFINITY,
                far: f32::INFINITY,
                is_certain: true,
            },
            narrowed: None,
            t_max: ray.t_max,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.candidate()
    }

    #[inline(always)]
    fn any<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
        scratch: &mut Scratch<f32>,
    ) -> bool {
        let mut visitor = Any {
            tester: self.tester::<MAYBE_COMPACT, S>(token, ray, scratch),
            is_hit: false,
        };
        self.blocks.bvh.walk(token, ray, stack, &mut visitor);
        visitor.is_hit
    }

    fn each(&self, ray: &Ray, kept: KeptHits) -> (Vec<Candidate>, Cost) {
        with_stack(|stack| {
            let mut scratch = Scratch::new();
            let mut visitor = Each {
                tester: self.tester::<true, _>(baseline(), ray, &mut scratch),
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
        let mut scratch = Scratch::new();
        let mut tester = self.tester::<true, S>(token, ray, &mut scratch);
        let mut count = 0;
        for block in 0..self.blocks.bvh.block_count() {
            _ = tester.test(block, f32::INFINITY, |judge, hit| {
                count += usize::from(judge.within(hit.candidate(), hit.is_certain).is_some());
                ControlFlow::Continue(())
            });
        }
        count
    }

    /// Finds the nearest hits of the rays whose intervals don't start behind their origins.
    #[inline(always)]
    fn find<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        batch: &mut CandidateBatch,
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        let mut i = 0;
        while i < rays.len() {
            if !is_behind(&rays[i])
                && let Some(candidate) =
                    self.nearest::<MAYBE_COMPACT, S>(token, &rays[i], stack, &mut scratch)
            {
                // Store the corners now, while they are in the cache.
                let corners = self.corners(candidate.slot);
                let count = batch.count;
                batch.lanes[count / LANES].set(count % LANES, &rays[i], corners);
                batch.found[count] = Some((i, candidate));
                batch.count += 1;
            }
            i += 1;
        }
    }

    /// Finds out whether these rays hit anything.
    #[inline(always)]
    fn find_any<const MAYBE_COMPACT: bool, S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    ) {
        let mut scratch = Scratch::new();
        for (ray, is_hit) in rays.iter().zip(are_hits) {
            if !is_behind(ray) {
                *is_hit = self.any::<MAYBE_COMPACT, S>(token, ray, stack, &mut scratch);
            }
        }
    }

    /// Rounds the batch's hits.
    #[inline(always)]
    fn round<S: Simd>(
        &self,
        token: S,
        rays: &[Ray],
        batch: &CandidateBatch,
        hits: &mut [Option<Hit>],
    ) {
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

/// Appends the hits to `crossings`, ordered by t. Hits at equal t form one crossing, ordered by primitive.
///
/// A three-way quicksort: it compares each hit with few others, even if thousands are at equal t, as at the
/// tip of a fan or around an edge, where a comparison needs integers.
fn sort_into_crossings<F: Fn(usize) -> [Vec3; 3]>(
    judge: &mut Judge<'_, F>,
    hits: Vec<Candidate>,
    crossings: &mut Vec<Vec<Candidate>>,
) {
    let Some(mut middle) = hits.get(hits.len() / 2).copied() else {
        return;
    };
    let (mut nearer, mut equal, mut farther) = (Vec::new(), Vec::new(), Vec::new());
    for mut hit in hits {
        match judge.compare(&mut hit, &mut middle) {
            Ordering::Less => nearer.push(hit),
            Ordering::Equal => equal.push(hit),
            Ordering::Greater => farther.push(hit),
        }
    }
    equal.sort_unstable_by_key(|hit| hit.primitive);
    sort_into_crossings(judge, nearer, crossings);
    crossings.push(equal);
    sort_into_crossings(judge, farther, crossings);
}

/// The hits of some rays, before rounding.
struct CandidateBatch {
    lanes: [HitLanes; ROUNDED_TOGETHER / LANES],
    /// Index of the ray, and its hit.
    found: [Option<(usize, Candidate)>; ROUNDED_TOGETHER],
    count: usize,
}

/// Number of rays whose hits are rounded together after tracing; large enough that few lanes stay empty.
const ROUNDED_TOGETHER: usize = 64;

impl Intersector for ExactIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        &INFO
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        with_stack(|stack| {
            let chunks = rays.chunks(ROUNDED_TOGETHER);
            for (rays, hits) in chunks.zip(hits.chunks_mut(ROUNDED_TOGETHER)) {
                let mut batch = CandidateBatch {
                    lanes: [HitLanes::EMPTY; ROUNDED_TOGETHER / LANES],
                    found: [None; ROUNDED_TOGETHER],
                    count: 0,
                };
                let level = self.level.level();
                if self.blocks.are_compact() {
                    self.find::<true, _>(baseline(), rays, &mut batch, stack);
                } else {
                    dispatch!(level, token => self.find::<false, _>(token, rays, &mut batch, stack));
                }
                hits.fill(None);
                // Separate from the search, which otherwise becomes a tenth slower (bunny, primary rays,
                // 2026-11).
                dispatch!(level, token => self.round(token, rays, &batch, hits));
            }
        });
        answer_behind(rays, hits, |ray| self.closest_hit_with_cost(ray).0);
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let (nearest, cost) = self.each(ray, KeptHits::Nearest);
        let judge = Judge::new(ray, |slot| self.corners(slot));
        (nearest.first().map(|hit| judge.hit(*hit)), cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        with_stack(|stack| {
            if self.blocks.are_compact() {
                self.find_any::<true, _>(baseline(), rays, are_hits, stack);
            } else {
                let level = self.level.level();
                dispatch!(level, token => self.find_any::<false, _>(token, rays, are_hits, stack));
            }
        });
        answer_behind(rays, are_hits, |ray| {
            self.closest_hit_with_cost(ray).0.is_some()
        });
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let (mut hits, _) = self.each(ray, KeptHits::All);
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        if hits.len() > 1 {
            // Narrow each hit once, as each is compared with several others.
            hits.iter_mut().for_each(|hit| _ = judge.narrow(hit));
            hits.sort_by(|a, b| a.bounds()[0].total_cmp(&b.bounds()[0]));
        }
        let mut crossings = Vec::new();
        sort_into_crossings(&mut judge, hits, &mut crossings);
        let crossing = |equal: Vec<Candidate>| Crossing {
            hit: judge.hit(equal[0]),
            also: equal[1..].iter().map(|hit| hit.primitive).collect(),
        };
        crossings.into_iter().map(crossing).collect()
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

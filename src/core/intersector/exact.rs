//! A mesh, packed for the exact kernel: hits are weighed against each other as exact arithmetic orders
//! them.

use super::blocks::{Blocks, candidates, is_asked};
use super::{Cost, Crossing, Intersector, is_behind};
use crate::bvh::{BLOCK_SIZE, Bvh, Stack, Visitor, with_stack};
use crate::kernel::exact::{Candidate, Filtered, INFO, Judge, VALUES, filter};
use crate::kernel::{KernelInfo, ShearedRay, pack_corners};
use crate::lane::{Lane, LaneMask, Number};
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

/// One ray against blocks; hands each triangle that it hits at a depth of interest to `found`, which
/// returns the farthest candidate of interest if there is one yet.
struct Weigher<'a, S: Simd, F, G, const IS_RARE: bool> {
    intersector: &'a ExactIntersector,
    token: S,
    sheared: ShearedRay<Vector<S>>,
    judge: Judge<'a, F>,
    t_max: f32,
    farthest: f32,
    found: G,
    cost: Cost,
}

impl<S, F, G, const IS_RARE: bool> Visitor for Weigher<'_, S, F, G, IS_RARE>
where
    S: Simd,
    F: Fn(usize) -> [Vec3; 3],
    G: FnMut(&mut Judge<'_, F>, Candidate) -> ControlFlow<(), Option<Candidate>>,
{
    const IS_ORDERED: bool = true;
    const IS_BEHIND: bool = IS_RARE;

    #[inline(always)]
    fn visit(&mut self, block: usize, _: f32) -> ControlFlow<(), f32> {
        if IS_RARE {
            let primitives = self.intersector.blocks.bvh.block(block);
            self.cost.triangles += primitives.len() as u32;
        }
        let Self {
            intersector,
            sheared,
            judge,
            t_max,
            farthest,
            found,
            ..
        } = self;
        intersector.test(sheared, block, *farthest, judge, |judge, hit| {
            if let Some(nearest) = found(judge, hit)? {
                *t_max = judge.t_beyond(&nearest).min(judge.ray().t_max);
                *farthest = nearest.far_f32();
            }
            ControlFlow::Continue(())
        })?;
        ControlFlow::Continue(self.t_max)
    }

    #[inline(always)]
    fn announce(&self, block: usize) {
        self.intersector.blocks.announce(self.token, block, VALUES);
    }

    #[inline(always)]
    fn count_boxes(&mut self, count: u32) {
        if IS_RARE {
            self.cost.boxes += count;
        }
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
    fn corners(&self, slot: usize) -> [Vec3; 3] {
        let value = |k| self.blocks.value(slot / BLOCK_SIZE, slot % BLOCK_SIZE, k);
        [0, 3, 6].map(|k| Vec3::new(value(k), value(k + 1), value(k + 2)))
    }

    /// Hands each triangle that the ray hits at a depth of interest to `found`.
    #[inline(always)]
    fn each<S: Simd, F: Fn(usize) -> [Vec3; 3], const IS_RARE: bool>(
        &self,
        token: S,
        judge: Judge<'_, F>,
        stack: &mut Stack,
        found: impl FnMut(&mut Judge<'_, F>, Candidate) -> ControlFlow<(), Option<Candidate>>,
    ) -> Cost {
        let ray = judge.ray();
        let mut weigher = Weigher::<_, _, _, IS_RARE> {
            intersector: self,
            token,
            sheared: ShearedRay::of(token, ray),
            judge,
            t_max: ray.t_max,
            farthest: f32::INFINITY,
            found,
            cost: Cost::default(),
        };
        self.blocks.bvh.walk(token, ray, stack, &mut weigher);
        Cost {
            in_f64: weigher.judge.work.in_f64,
            in_integers: weigher.judge.work.in_integers,
            ..weigher.cost
        }
    }

    /// Tests a block: hands each triangle in it that the ray hits, and that doesn't certainly lie farther
    /// than `farthest`, to `found`.
    #[inline(always)]
    fn test<S: Simd, F: Fn(usize) -> [Vec3; 3]>(
        &self,
        sheared: &ShearedRay<Vector<S>>,
        block: usize,
        farthest: f32,
        judge: &mut Judge<'_, F>,
        mut found: impl FnMut(&mut Judge<'_, F>, Candidate) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let token = sheared.dir_z().token();
        let values = self.blocks.values::<f32, S>(token, block, VALUES);
        let Some(filtered) = filter(sheared, &values) else {
            return ControlFlow::Continue(());
        };
        let Filtered {
            certain,
            missed,
            near,
            far,
            ..
        } = filtered;
        let is_farther = certain & Vector::<S>::splat(token, farthest).lt(near);
        let certain = certain.bits();
        let mut lanes = !(missed | is_farther).bits() & ((1 << BLOCK_SIZE) - 1);
        let (near, far) = (f32::store(near), f32::store(far));
        let primitives = self.blocks.bvh.lanes(block);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK_SIZE;
            lanes &= lanes - 1;
            let primitive = primitives[lane];
            if !is_asked(primitive, judge.ray().exclude) {
                continue;
            }
            let (is_certain, slot) = (certain >> lane & 1 == 1, block * BLOCK_SIZE + lane);
            let candidate = judge.candidate(primitive, slot, is_certain, near[lane], far[lane]);
            if let Some(candidate) = candidate {
                found(judge, candidate)?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let sheared = ShearedRay::of(token, ray);
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        let mut count = 0;
        for block in 0..self.blocks.bvh.block_count() {
            let found = |_: &mut Judge<'_, _>, _| {
                count += 1;
                ControlFlow::Continue(())
            };
            _ = self.test(&sheared, block, f32::INFINITY, &mut judge, found);
        }
        count
    }

    #[inline(always)]
    fn nearest<S: Simd, const IS_RARE: bool>(
        &self,
        token: S,
        ray: &Ray,
        stack: &mut Stack,
    ) -> (Option<Hit>, Cost) {
        let mut best: Option<Candidate> = None;
        let judge = Judge::new(ray, |slot| self.corners(slot));
        let cost = self.each::<_, _, IS_RARE>(token, judge, stack, |judge, mut hit| {
            let is_nearest = match &mut best {
                Some(best) => judge.is_before(&mut hit, best),
                None => true,
            };
            if is_nearest {
                best = Some(hit);
            }
            ControlFlow::Continue(best)
        });
        let hit = |candidate| Judge::new(ray, |slot| self.corners(slot)).hit(candidate);
        (best.map(hit), cost)
    }
}

impl Intersector for ExactIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        &INFO
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        with_stack(|stack| {
            dispatch!(self.level.level(), token => {
                for (ray, hit) in rays.iter().zip(&mut *hits) {
                    if !is_behind(ray) {
                        *hit = self.nearest::<_, false>(token, ray, stack).0;
                    }
                }
            });
        });
        for (ray, hit) in rays.iter().zip(hits).filter(|(ray, _)| is_behind(ray)) {
            *hit = self.closest_hit_with_cost(ray).0;
        }
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        with_stack(|stack| self.nearest::<_, true>(baseline(), ray, stack))
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        with_stack(|stack| {
            dispatch!(self.level.level(), token => {
                for (ray, is_hit) in rays.iter().zip(are_hits) {
                    *is_hit = false;
                    let judge = Judge::new(ray, |slot| self.corners(slot));
                    self.each::<_, _, true>(token, judge, stack, |_, _| {
                        *is_hit = true;
                        ControlFlow::Break(())
                    });
                }
            });
        });
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let mut hits: Vec<Candidate> = Vec::new();
        with_stack(|stack| {
            let judge = Judge::new(ray, |slot| self.corners(slot));
            self.each::<_, _, true>(baseline(), judge, stack, |_, hit| {
                hits.push(hit);
                ControlFlow::Continue(None)
            })
        });
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

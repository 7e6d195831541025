//! A mesh, packed for the exact kernel: hits are weighed against each other as exact arithmetic orders
//! them.

use super::blocks::Blocks;
use super::{Cost, Crossing, Intersector, NoTally, Tally};
use crate::bvh::{Bvh, LEAF_SIZE};
use crate::kernel::exact::{Candidate, Filtered, INFO, Judge, VALUES, filter};
use crate::kernel::{KernelInfo, ShearedRay, pack_corners};
use crate::lane::{Lane, LaneMask, Number};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use fearless_simd::{Level, Simd, dispatch};
use glam::Vec3;
use std::cmp::Ordering;
use std::ops::ControlFlow;
use std::sync::Arc;

type Vector<S> = <f32 as Number>::Lanes<S>;

/// Triangles for the exact kernel.
pub(crate) struct ExactIntersector {
    blocks: Blocks<f32>,
    level: Level,
}

impl ExactIntersector {
    pub fn new(mesh: &TriangleMesh, bvh: Arc<Bvh>) -> Self {
        Self {
            blocks: Blocks::new(mesh, bvh, VALUES, None, pack_corners),
            level: Level::new(),
        }
    }

    /// The corners in a slot, a lane of a block. From there and not from the mesh: they are in the cache.
    fn corners(&self, slot: usize) -> [Vec3; 3] {
        let value = |k| self.blocks.value(slot / LEAF_SIZE, slot % LEAF_SIZE, k);
        [0, 3, 6].map(|k| Vec3::new(value(k), value(k + 1), value(k + 2)))
    }

    /// Hands each triangle that the ray hits at a depth of at most `limit` to `found`, where the limit
    /// is the bound of the candidate that `found` returned last, or breaks with.
    #[inline(always)]
    fn each_hit<S: Simd, F: Fn(usize) -> [Vec3; 3]>(
        &self,
        token: S,
        ray: &Ray,
        judge: &mut Judge<'_, F>,
        mut found: impl FnMut(&mut Judge<'_, F>, Candidate) -> ControlFlow<(), Option<Candidate>>,
        tally: &mut impl Tally,
    ) {
        let sheared = ShearedRay::new(token, ray);
        let (mut t_max, mut farthest) = (ray.t_max, f32::INFINITY);
        let (mut triangles, mut boxes) = (0, 0);
        let visit = |index: usize| {
            triangles += self.blocks.leaf(index).count;
            let limit = farthest;
            self.test(&sheared, index, limit, judge, |judge, hit| {
                if let Some(nearest) = found(judge, hit)? {
                    t_max = judge.t_beyond(&nearest).min(ray.t_max);
                    farthest = nearest.far_f32();
                }
                ControlFlow::Continue(())
            })?;
            ControlFlow::Continue(t_max)
        };
        self.blocks.bvh.traverse(ray, visit, || boxes += 1);
        tally.add(Cost {
            boxes,
            triangles,
            in_f64: judge.work.in_f64,
            in_integers: judge.work.in_integers,
        });
    }

    /// Tests a leaf: hands each triangle in it that the ray hits, and that doesn't certainly lie farther
    /// than `farthest`, to `found`.
    #[inline(always)]
    fn test<S: Simd, F: Fn(usize) -> [Vec3; 3]>(
        &self,
        sheared: &ShearedRay<Vector<S>>,
        index: usize,
        farthest: f32,
        judge: &mut Judge<'_, F>,
        mut found: impl FnMut(&mut Judge<'_, F>, Candidate) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let token = sheared.dir_z().token();
        let leaf = self.blocks.leaf(index);
        let values = self.blocks.values::<f32, S>(token, index, VALUES);
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
        let mut lanes = !(missed | is_farther).bits() & ((1 << leaf.count) - 1);
        let (near, far) = (f32::store(near), f32::store(far));
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LEAF_SIZE;
            lanes &= lanes - 1;
            let primitive = leaf.primitives[lane];
            if Some(primitive) == judge.ray().exclude {
                continue;
            }
            let (is_certain, slot) = (certain >> lane & 1 == 1, index * LEAF_SIZE + lane);
            let candidate = judge.candidate(primitive, slot, is_certain, near[lane], far[lane]);
            if let Some(candidate) = candidate {
                found(judge, candidate)?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let sheared = ShearedRay::new(token, ray);
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        let mut count = 0;
        for index in 0..self.blocks.len() {
            let found = |_: &mut Judge<'_, _>, _| {
                count += 1;
                ControlFlow::Continue(())
            };
            _ = self.test(&sheared, index, f32::INFINITY, &mut judge, found);
        }
        count
    }

    #[inline(always)]
    fn closest(&self, ray: &Ray, tally: &mut impl Tally) -> Option<Hit> {
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        let mut best: Option<Candidate> = None;
        dispatch!(self.level, token => self.each_hit(token, ray, &mut judge, |judge, mut hit| {
            let is_nearest = match &mut best {
                Some(best) => judge.is_before(&mut hit, best),
                None => true,
            };
            if is_nearest {
                best = Some(hit);
            }
            ControlFlow::Continue(best)
        }, tally));
        best.map(|candidate| judge.hit(candidate))
    }
}

impl Intersector for ExactIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        &INFO
    }

    fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest(ray, &mut NoTally)
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let mut cost = Cost::default();
        (self.closest(ray, &mut cost), cost)
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        let mut is_hit = false;
        dispatch!(self.level, token => self.each_hit(token, ray, &mut judge, |_, _| {
            is_hit = true;
            ControlFlow::Break(())
        }, &mut NoTally));
        is_hit
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let mut judge = Judge::new(ray, |slot| self.corners(slot));
        let mut hits: Vec<Candidate> = Vec::new();
        dispatch!(self.level, token => self.each_hit(token, ray, &mut judge, |_, hit| {
            hits.push(hit);
            ControlFlow::Continue(None)
        }, &mut NoTally));
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
        self.blocks.candidates(ray)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        dispatch!(self.level, token => self.count(token, ray))
    }

    fn bytes(&self) -> usize {
        self.blocks.bytes()
    }
}

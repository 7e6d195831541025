//! Intersector of combined solids.

use super::crossings::PackedSolid;
use crate::aabb::Planes;
use crate::bvh::{
    BLOCK_SIZE, Bvh, LentStack, NO_PRIMITIVE, OpenedBox, SlabRay, Step, Visitor, WIDTH,
};
use crate::intersector::{
    Cost, Crossing, GroupIntersector, Intersector, RankedHit, candidates, crossings_of,
};
use crate::kernel::KernelInfo;
use crate::ray::{Hit, Ray};
use crate::simd::{Baseline, baseline};
use fearless_simd::{SimdBase as _, f32x8};
use std::ops::ControlFlow;
use std::sync::Arc;

/// See the [module](self).
pub(super) struct CsgIntersector {
    kernel: &'static KernelInfo,
    bvh: Arc<Bvh>,
    solids: Vec<PackedSolid>,
    /// The boxes of each block's solids.
    boxes: Vec<Planes<[f32; BLOCK_SIZE]>>,
}

/// Passes the crossings of each solid that the ray may hit to `found`, which returns the farthest t of interest.
struct CrossingVisitor<'a, F> {
    intersector: &'a CsgIntersector,
    ray: &'a Ray,
    found: F,
    t_max: f32,
    cost: Cost,
    /// The steps of the walk, if they are recorded.
    steps: Option<&'a mut Vec<Step>>,
}

impl<F: FnMut(u32, Vec<RankedHit>) -> f32> Visitor<Baseline> for CrossingVisitor<'_, F> {
    const IS_BEHIND: bool = true;
    const NEEDS_BOX_TEST: bool = true;

    fn visit(&mut self, block: usize, slabs: &SlabRay<Baseline>) -> ControlFlow<(), f32> {
        if let Some(steps) = &mut self.steps {
            steps.push(Step::Block(block));
        }
        let all = f32x8::splat(baseline(), f32::INFINITY);
        let boxes = &self.intersector.boxes[block];
        let (_, met) = slabs.enter::<true>(baseline(), boxes, all);
        for (lane, &index) in self.intersector.bvh.lanes(block).iter().enumerate() {
            if met >> lane & 1 == 0 || index == NO_PRIMITIVE || self.ray.exclude == Some(index) {
                continue;
            }
            let solid = &self.intersector.solids[index as usize];
            self.cost.primitives += solid.operand_count() as u32;
            self.t_max = (self.found)(index, solid.crossings(self.ray));
        }
        ControlFlow::Continue(self.t_max)
    }

    fn announce(&self, _: usize) {}

    fn open(&mut self, node: usize) {
        self.cost.boxes += WIDTH as u32;
        if let Some(steps) = &mut self.steps {
            steps.push(Step::Node(node));
        }
    }
}

impl CsgIntersector {
    pub fn new(kernel: &'static KernelInfo, bvh: Arc<Bvh>, solids: Vec<PackedSolid>) -> Self {
        let boxes = (0..bvh.block_count()).map(|block| {
            let mut planes = [[0.0; BLOCK_SIZE]; 6];
            for (lane, &index) in bvh.block(block).iter().enumerate() {
                let sides = solids[index as usize].planes();
                for (row, side) in planes.iter_mut().zip(sides) {
                    row[lane] = side;
                }
            }
            planes
        });
        Self {
            kernel,
            boxes: boxes.collect(),
            bvh,
            solids,
        }
    }

    /// Passes the crossings of each solid that the ray may hit to `found`, which returns the farthest t of interest.
    /// Appends the steps of the walk to `steps`.
    fn each(
        &self,
        ray: &Ray,
        steps: Option<&mut Vec<Step>>,
        found: impl FnMut(u32, Vec<RankedHit>) -> f32,
    ) -> Cost {
        let mut visitor = CrossingVisitor {
            intersector: self,
            ray,
            found,
            t_max: ray.t_max,
            cost: Cost::default(),
            steps,
        };
        let mut stack = LentStack::new();
        self.bvh.walk(baseline(), ray, stack.get(), &mut visitor);
        visitor.cost
    }

    /// The nearest hit and its cost. Appends the steps of the walk to `steps`.
    fn nearest(&self, ray: &Ray, steps: Option<&mut Vec<Step>>) -> (Option<RankedHit>, Cost) {
        let mut nearest: Option<RankedHit> = None;
        let cost = self.each(ray, steps, |primitive, crossings| {
            if let Some(first) = crossings.into_iter().next() {
                let first = first.with_hit(|hit| Hit { primitive, ..hit });
                if nearest
                    .as_ref()
                    .is_none_or(|nearest| first.is_before(nearest))
                {
                    nearest = Some(first);
                }
            }
            nearest
                .as_ref()
                .map_or(ray.t_max, |nearest| nearest.t_bound(ray))
        });
        (nearest, cost)
    }
}

impl Intersector for CsgIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest_hit_with_cost(ray).0;
        }
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let (nearest, cost) = self.nearest_with_cost(ray);
        (nearest.map(|nearest| nearest.hit), cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        for (ray, is_hit) in rays.iter().zip(are_hits) {
            *is_hit = self.nearest_with_cost(ray).0.is_some();
        }
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        crossings_of(self.every_hit(ray))
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        candidates(&self.bvh, ray)
    }

    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        let mut steps = Vec::new();
        self.nearest(ray, Some(&mut steps));
        self.bvh.opened(&steps)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        let is_hit = |solid: &&PackedSolid| !solid.crossings(ray).is_empty();
        self.solids.iter().filter(is_hit).count()
    }

    fn bytes(&self) -> usize {
        let of_solids = self.solids.iter().map(PackedSolid::bytes).sum::<usize>();
        size_of_val(&self.boxes[..]) + of_solids
    }
}

impl GroupIntersector for CsgIntersector {
    fn nearest_with_cost(&self, ray: &Ray) -> (Option<RankedHit>, Cost) {
        self.nearest(ray, None)
    }

    fn every_hit(&self, ray: &Ray) -> Vec<RankedHit> {
        let mut hits = Vec::new();
        self.each(ray, None, |primitive, crossings| {
            let numbered = |ranked: RankedHit| ranked.with_hit(|hit| Hit { primitive, ..hit });
            hits.extend(crossings.into_iter().map(numbered));
            ray.t_max
        });
        hits
    }
}

//! A mesh, packed for a kernel that decides about each triangle by itself.

use super::blocks::Blocks;
use super::{Cost, Crossing, Intersector, NoTally, Tally};
use crate::bvh::{Bvh, LEAF_SIZE};
use crate::kernel::{Kernel, KernelInfo};
use crate::lane::{Lane, LaneMask, Number, Stored};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use fearless_simd::{Level, Simd, dispatch};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Triangles for the kernel `K`, working in `N`.
pub(crate) struct MeshIntersector<K: Kernel, N: Number> {
    blocks: Blocks<K::Stored<N>>,
    level: Level,
    kernel: &'static KernelInfo,
}

/// A hit as the kernel computed it.
#[derive(Clone, Copy)]
struct Found<N> {
    t: N,
    u: N,
    v: N,
    primitive: u32,
}

impl<N: Number> Found<N> {
    fn hit(self) -> Hit {
        Hit {
            t: self.t.to_f32(),
            u: self.u.to_f32(),
            v: self.v.to_f32(),
            primitive: self.primitive,
        }
    }
}

impl<K: Kernel, N: Number> MeshIntersector<K, N> {
    pub fn new(kernel: &'static KernelInfo, mesh: &TriangleMesh, bvh: Arc<Bvh>) -> Self {
        let empty = Some(<K::Stored<N> as Stored<N>>::NO_TRIANGLE);
        Self {
            blocks: Blocks::new(mesh, bvh, K::VALUES, empty, K::pack::<N>),
            level: Level::new(),
            kernel,
        }
    }

    /// Hands each hit that the kernel finds in `ray.t_min < t ≤ limit` to `found`, where the limit
    /// is what `found` returned last, or breaks with.
    #[inline(always)]
    fn each_hit<S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        mut found: impl FnMut(Found<N>) -> ControlFlow<(), N>,
        tally: &mut impl Tally,
    ) {
        let prepared = K::prepare::<N::Lanes<S>>(token, ray);
        let t_min = Lane::of(token, ray.t_min);
        let mut limit = N::from(ray.t_max);
        let mut cost = Cost::default();
        let mut boxes = 0;
        let visit = |index: usize| {
            let leaf = self.blocks.leaf(index);
            cost.triangles += leaf.count;
            let values = self.blocks.values::<N, S>(token, index, K::VALUES);
            let t_max = Lane::splat(token, limit);
            if let Some(hit) = K::intersect(&prepared, &values, t_min, t_max) {
                let [t, u, v] = [hit.t, hit.u, hit.v].map(N::store::<S>);
                let mut lanes = LaneMask::bits(hit.mask);
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % LEAF_SIZE;
                    lanes &= lanes - 1;
                    let primitive = leaf.primitives[lane];
                    // What is farther than f32's largest number is a miss.
                    if Some(primitive) == ray.exclude || t[lane].to_f32() == f32::INFINITY {
                        continue;
                    }
                    limit = found(Found {
                        t: t[lane],
                        u: u[lane],
                        v: v[lane],
                        primitive,
                    })?;
                }
            }
            ControlFlow::Continue(limit.to_f32())
        };
        self.blocks.bvh.traverse(ray, visit, || boxes += 1);
        tally.add(Cost { boxes, ..cost });
    }

    #[inline(always)]
    fn count<S: Simd>(&self, token: S, ray: &Ray) -> usize {
        let prepared = K::prepare::<N::Lanes<S>>(token, ray);
        let (t_min, t_max) = (Lane::of(token, ray.t_min), Lane::of(token, ray.t_max));
        let mut count = 0;
        // A plain loop: what an iterator calls may lose the CPU's features.
        for index in 0..self.blocks.len() {
            let values = self.blocks.values::<N, S>(token, index, K::VALUES);
            if let Some(hit) = K::intersect(&prepared, &values, t_min, t_max) {
                count += LaneMask::bits(hit.mask).count_ones() as usize;
            }
        }
        count
    }

    #[inline(always)]
    fn closest(&self, ray: &Ray, tally: &mut impl Tally) -> Option<Hit> {
        let end = N::from(ray.t_max);
        let mut best: Option<Found<N>> = None;
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            let (t, primitive) = best.map_or((end, 0), |b| (b.t, b.primitive));
            if hit.t < t || (hit.t == t && hit.primitive < primitive) {
                best = Some(hit);
            }
            ControlFlow::Continue(best.map_or(end, |b| b.t))
        }, tally));
        best.map(Found::hit)
    }
}

impl<K: Kernel, N: Number> Intersector for MeshIntersector<K, N> {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest(ray, &mut NoTally)
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let mut cost = Cost::default();
        (self.closest(ray, &mut cost), cost)
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        let end = N::from(ray.t_max);
        let mut is_hit = false;
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            is_hit |= hit.t < end;
            if is_hit { ControlFlow::Break(()) } else { ControlFlow::Continue(end) }
        }, &mut NoTally));
        is_hit
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let end = N::from(ray.t_max);
        let mut hits: Vec<Found<N>> = Vec::new();
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            if hit.t < end {
                hits.push(hit);
            }
            ControlFlow::Continue(end)
        }, &mut NoTally));
        let key = |hit: &Found<N>| -> f64 { hit.t.into() };
        hits.sort_by(|a, b| {
            let by_t = key(a).total_cmp(&key(b));
            by_t.then(a.primitive.cmp(&b.primitive))
        });
        hits.chunk_by(|a, b| a.t == b.t)
            .map(|equal| Crossing {
                hit: equal[0].hit(),
                also: equal[1..].iter().map(|hit| hit.primitive).collect(),
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

//! Where does a ray meet the scene? The tree and one kernel together.
//!
//! Kernel and CPU level are chosen when the intersector is made; a ray then costs one virtual call.

use crate::bvh::{Bvh, LEAF_SIZE};
use crate::kernel::{Corners, Kernel, KernelInfo};
use crate::lane::{Lane, LaneMask};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};
use std::ops::ControlFlow;
use std::sync::Arc;

/// What a ray cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Boxes tested.
    pub boxes: u32,
    /// Triangles tested.
    pub triangles: u32,
}

/// Answers rays for one scene with one kernel.
///
/// Rays come from [`Ray::new`] or a [`Camera`](crate::Camera), so they hold no NaN. Of hits at equal t
/// the lowest primitive counts.
pub trait Intersector: Send + Sync {
    /// The kernel that it was made with.
    fn kernel(&self) -> &'static KernelInfo;

    /// The nearest hit with `t_min < t < t_max`, or `None`.
    fn closest_hit(&self, ray: &Ray) -> Option<Hit>;

    /// The same, and what it cost.
    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost);

    /// Whether anything lies in `t_min < t < t_max`.
    fn any_hit(&self, ray: &Ray) -> bool;

    /// All hits with `t_min < t < t_max`, by t and then by primitive.
    fn all_hits(&self, ray: &Ray) -> Vec<Hit>;

    /// The triangles in the leaves whose boxes the ray meets, in no particular order: all that it
    /// could hit, whatever the kernel says.
    fn candidates(&self, ray: &Ray) -> Vec<u32>;

    /// Bytes that the packed triangles take, the tree not counted.
    fn bytes(&self) -> usize;
}

/// The triangles of a leaf, coordinate by coordinate, one a lane.
#[derive(Clone, Copy)]
struct Block {
    /// Corner, coordinate, lane. NaN in lanes that hold no triangle: no kernel hits those.
    corners: [[[f32; LEAF_SIZE]; 3]; 3],
    primitives: [u32; LEAF_SIZE],
    count: u32,
}

struct LoadedBlock<'a, S: Simd> {
    token: S,
    block: &'a Block,
}

impl<S: Simd> Corners<f32x4<S>> for LoadedBlock<'_, S> {
    #[inline(always)]
    fn coordinate(&self, corner: usize, axis: usize) -> f32x4<S> {
        f32x4::load_array_ref(self.token, &self.block.corners[corner][axis])
    }
}

/// A mesh, packed for the kernel `K`.
pub(crate) struct MeshIntersector<K> {
    bvh: Arc<Bvh>,
    /// One for each leaf of the tree.
    blocks: Vec<Block>,
    level: Level,
    kernel: std::marker::PhantomData<K>,
}

impl<K: Kernel> MeshIntersector<K> {
    pub(crate) fn new(mesh: &TriangleMesh, bvh: Arc<Bvh>) -> Self {
        let blocks = (0..bvh.leaf_count())
            .map(|leaf| Block::new(mesh, bvh.leaf(leaf)))
            .collect();
        Self {
            bvh,
            blocks,
            level: Level::new(),
            kernel: std::marker::PhantomData,
        }
    }

    /// Hands each hit that the kernel finds in `ray.t_min < t ≤ limit` to `found`, where the limit
    /// is what `found` returned last, or breaks with.
    #[inline(always)]
    fn each_hit<S: Simd>(
        &self,
        token: S,
        ray: &Ray,
        mut found: impl FnMut(Hit) -> ControlFlow<(), f32>,
        cost: &mut impl Tally,
    ) {
        let prepared = K::prepare::<f32x4<S>>(token, ray);
        let t_min = Lane::splat(token, ray.t_min);
        let mut limit = ray.t_max;
        let (mut boxes, mut triangles) = (0, 0);
        let visit = |leaf: usize| {
            let block = &self.blocks[leaf];
            triangles += block.count;
            let corners = LoadedBlock { token, block };
            let t_max = Lane::splat(token, limit);
            if let Some(hit) = K::intersect(&prepared, &corners, t_min, t_max) {
                let (t, u, v) = (hit.t.to_array(), hit.u.to_array(), hit.v.to_array());
                let mut lanes = LaneMask::bits(hit.mask);
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % LEAF_SIZE;
                    lanes &= lanes - 1;
                    let hit = Hit {
                        t: t[lane],
                        u: u[lane],
                        v: v[lane],
                        primitive: block.primitives[lane],
                    };
                    limit = found(hit)?;
                }
            }
            ControlFlow::Continue(limit)
        };
        self.bvh.traverse(ray, visit, || boxes += 1);
        cost.add(boxes, triangles);
    }

    #[inline(always)]
    fn closest(&self, ray: &Ray, cost: &mut impl Tally) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            let (t, primitive) = best.map_or((ray.t_max, 0), |b| (b.t, b.primitive));
            if hit.t < t || (hit.t == t && hit.primitive < primitive) {
                best = Some(hit);
            }
            ControlFlow::Continue(best.map_or(ray.t_max, |b| b.t))
        }, cost));
        best
    }
}

impl<K: Kernel> Intersector for MeshIntersector<K> {
    fn kernel(&self) -> &'static KernelInfo {
        &K::INFO
    }

    fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest(ray, &mut NoTally)
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let mut cost = Cost::default();
        (self.closest(ray, &mut cost), cost)
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        let mut is_hit = false;
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            is_hit |= hit.t < ray.t_max;
            if is_hit { ControlFlow::Break(()) } else { ControlFlow::Continue(ray.t_max) }
        }, &mut NoTally));
        is_hit
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        let mut hits = Vec::new();
        dispatch!(self.level, token => self.each_hit(token, ray, |hit| {
            if hit.t < ray.t_max {
                hits.push(hit);
            }
            ControlFlow::Continue(ray.t_max)
        }, &mut NoTally));
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.primitive.cmp(&b.primitive)));
        hits
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        let mut found = Vec::new();
        let visit = |leaf: usize| {
            found.extend_from_slice(self.bvh.leaf(leaf));
            ControlFlow::Continue(ray.t_max)
        };
        self.bvh.traverse(ray, visit, || ());
        found
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..])
    }
}

impl Block {
    fn new(mesh: &TriangleMesh, primitives: &[u32]) -> Self {
        let mut block = Self {
            corners: [[[f32::NAN; LEAF_SIZE]; 3]; 3],
            primitives: [0; LEAF_SIZE],
            count: primitives.len() as u32,
        };
        for (lane, &primitive) in primitives.iter().enumerate() {
            block.primitives[lane] = primitive;
            for (corner, position) in mesh.corners(primitive).into_iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis][lane] = position[axis];
                }
            }
        }
        block
    }
}

/// Counts, or doesn't: the compiler drops the counting where nobody asks.
trait Tally {
    fn add(&mut self, boxes: u32, triangles: u32);
}

struct NoTally;

impl Tally for NoTally {
    #[inline(always)]
    fn add(&mut self, _: u32, _: u32) {}
}

impl Tally for Cost {
    #[inline(always)]
    fn add(&mut self, boxes: u32, triangles: u32) {
        self.boxes += boxes;
        self.triangles += triangles;
    }
}

//! Intersectors: a tree and a kernel that together find a scene's hits.
//!
//! Kernel and CPU level are chosen when an intersector is made. A batch of rays then costs one virtual call,
//! or two while a better tree is being built. `tree` is the intersector of primitives of one shape. It is
//! written once for all `method`s: `ranked` for kernels that decide about each primitive separately, `exact` for
//! triangles and `algebraic` for other shapes whose hits are compared exactly. `packet` traces coherent rays together, and
//! `interleaved` alternates between rays, so that none waits for memory; `stream` is the table of these searches.
//! `improving` forwards to an intersector that can be replaced when a better tree is ready. `groups` finds the hits of
//! a scene's `numbered` groups, which `ranked_hit` orders. `clipped` cuts rays with a clip.

mod algebraic;
mod blocks;
mod clipped;
mod exact;
mod groups;
pub(crate) mod improving;
mod interleaved;
mod levels;
mod method;
mod numbered;
mod order;
mod packet;
mod ranked;
mod ranked_hit;
mod stream;
mod tree;
mod visitors;

pub use blocks::Packing;
pub(crate) use blocks::candidates;
pub(crate) use clipped::Clipped;
pub use groups::GroupIntersector;
pub(crate) use groups::scene_intersector;
use ranked_hit::ExactT;
pub use ranked_hit::RankedHit;
pub(crate) use ranked_hit::crossings_of;

use crate::algebra::Pieces;
use crate::bvh::{Bvh, OpenedBox};
use crate::kernel::{
    self, Kernel, KernelInfo, KernelList, KernelRow, KernelVisitor, TriangleKernel,
};
use crate::lane::Number;
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::shape::{Primitives, Shape, Triangle};
use crate::simd::SimdLevel;
use algebraic::Algebraic;
use exact::Exact;
use levels::{BaselineLevel, EveryLevel};
use method::Method;
use ranked::Ranked;
use std::ops::AddAssign;
use std::slice::from_ref;
use std::sync::Arc;
use stream::StreamSearches;
use tree::TreeIntersector;

/// The cost of tracing a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Boxes tested.
    pub boxes: u32,
    /// Primitives tested.
    pub primitives: u32,
    /// Triangles whose bounds the exact kernel narrowed in f64; 0 for the other kernels.
    pub in_f64: u32,
    /// Decisions that the exact kernel took in integers.
    pub in_integers: u32,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.boxes += other.boxes;
        self.primitives += other.primitives;
        self.in_f64 += other.in_f64;
        self.in_integers += other.in_integers;
    }
}

/// A point where a ray crosses the surface: a hit, and other hits at the same t.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The hit of the lowest primitive.
    pub hit: Hit,
    /// The other primitives, in ascending order.
    pub also: Vec<u32>,
}

/// Packs primitives for a kernel and returns the intersector.
pub(crate) fn intersector<S: KernelList>(
    kernel: &'static KernelRow<S>,
    primitives: &dyn Primitives<S>,
    bvh: Arc<Bvh>,
    level: SimdLevel,
    packing: Packing,
) -> Box<dyn GroupIntersector> {
    let mut packer = Packer {
        kernel: kernel.info,
        primitives,
        bvh,
        level,
        packing,
        packed: None,
    };
    S::visit_kernels(&mut packer);
    packer.packed.expect("a row's kernel is in its table")
}

/// Packs a mesh for a kernel and returns the intersector.
pub fn mesh_intersector(
    kernel: &'static TriangleKernel,
    mesh: &TriangleMesh,
    bvh: Arc<Bvh>,
    level: SimdLevel,
    packing: Packing,
) -> Box<dyn Intersector> {
    intersector(kernel, mesh, bvh, level, packing)
}

/// Packs primitives for the kernel of the table that has the description `kernel`.
struct Packer<'a, S> {
    kernel: &'static KernelInfo,
    primitives: &'a dyn Primitives<S>,
    bvh: Arc<Bvh>,
    level: SimdLevel,
    packing: Packing,
    packed: Option<Box<dyn GroupIntersector>>,
}

impl<S: Shape> Packer<'_, S> {
    fn pack<M: Method<Shape = S>>(
        &mut self,
        kernel: &KernelInfo,
        streams: Option<StreamSearches<M>>,
    ) {
        if kernel.name == self.kernel.name {
            self.packed = Some(Box::new(TreeIntersector::new(
                self.kernel,
                self.primitives,
                Arc::clone(&self.bvh),
                self.level,
                self.packing,
                streams,
            )));
        }
    }
}

impl<S: Shape> KernelVisitor<S> for Packer<'_, S> {
    fn visit<K: Kernel<Shape = S>, N: Number>(&mut self) {
        self.pack::<Ranked<K, N, BaselineLevel>>(K::info::<N>(), None);
    }

    fn visit_with_levels<K: Kernel<Shape = S>, N: Number>(&mut self) {
        self.pack::<Ranked<K, N, EveryLevel>>(K::info::<N>(), None);
    }

    fn visit_with_packets<K: Kernel<Shape = S>>(&mut self) {
        self.pack::<Ranked<K, f32, EveryLevel>>(K::info::<f32>(), Some(StreamSearches::NEW));
    }

    fn visit_exact_triangle(&mut self)
    where
        S: From<Triangle> + Into<Triangle>,
    {
        self.pack::<Exact<S>>(&kernel::exact::INFO, Some(StreamSearches::NEW));
    }

    fn visit_algebraic(&mut self)
    where
        S: Pieces,
    {
        self.pack::<Algebraic<S, BaselineLevel>>(&kernel::algebraic::INFO, None);
    }

    fn visit_algebraic_with_levels(&mut self)
    where
        S: Pieces,
    {
        self.pack::<Algebraic<S, EveryLevel>>(&kernel::algebraic::INFO, None);
    }
}

/// Finds the hits of rays in one scene with one kernel.
///
/// Rays come from [`Ray::new`] or a [`Camera`](crate::Camera), so they hold no NaN. A ray's interval and hits
/// are compared in the kernel's precision. Of hits whose computed t are equal, the lowest primitive counts. Only
/// the exact kernel promises the lowest primitive of several at exactly equal t: other kernels round each t on
/// its own. A hit whose t exceeds the largest finite f32 is a miss.
///
/// A hit counts only if the ray meets the box around the primitive, and it ranks no nearer than that box. So
/// answers don't depend on the tree. The first of [`all_hits`](Self::all_hits), which are ordered by t alone,
/// may differ from the closest hit if t errs by more than the size of the box.
pub trait Intersector: Send + Sync {
    /// The intersector's kernel.
    fn kernel(&self) -> &'static KernelInfo;

    /// Finds the nearest hit with `t_min < t < t_max` of each ray, or `None`.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]);

    /// As [`closest_hits`](Self::closest_hits), but faster for coherent rays: sixteen consecutive rays with
    /// similar directions.
    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.closest_hits(rays, hits);
    }

    /// The number of rays that [`coherent_hits`](Self::coherent_hits) and
    /// [`coherent_any_hits`](Self::coherent_any_hits) trace together.
    fn rays_together(&self) -> usize {
        1
    }

    /// The nearest hit of one ray.
    fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        let mut hit = [None];
        self.closest_hits(from_ref(ray), &mut hit);
        hit[0]
    }

    /// The nearest hit of one ray, and its cost.
    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost);

    /// Finds out for each ray whether it has any hit with `t_min < t < t_max`.
    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]);

    /// As [`any_hits`](Self::any_hits), but faster for coherent rays, such as those from neighbouring points to
    /// one lamp.
    fn coherent_any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        self.any_hits(rays, are_hits);
    }

    /// Whether one ray has any hit.
    fn any_hit(&self, ray: &Ray) -> bool {
        let mut is_hit = [false];
        self.any_hits(from_ref(ray), &mut is_hit);
        is_hit[0]
    }

    /// All hits with `t_min < t < t_max`, ordered by t; hits at equal t form one crossing.
    fn all_hits(&self, ray: &Ray) -> Vec<Crossing>;

    /// The primitives in the leaves whose boxes the ray meets, in no particular order: all that it could hit,
    /// with any kernel.
    fn candidates(&self, ray: &Ray) -> Vec<u32>;

    /// The boxes that the search for the nearest hit opens, in order; it opens them again for this record.
    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox>;

    /// Counts the hits among all primitives, without tree and boxes, for measurements. The ray's `exclude` is
    /// ignored, and hits at an end of its interval may count.
    fn count_hits(&self, ray: &Ray) -> usize;

    /// Size of the packed primitives in bytes, without the tree.
    fn bytes(&self) -> usize;
}

/// Traces the rays whose intervals start behind their origins, one by one. These rays need boxes padded on
/// both sides, a cost that the other rays avoid.
fn answer_behind<T>(rays: &[Ray], answers: &mut [T], answer: &dyn Fn(&Ray) -> T) {
    let pairs = rays.iter().zip(answers);
    for (ray, place) in pairs.filter(|(ray, _)| is_behind(ray)) {
        *place = answer(ray);
    }
}

/// Whether a ray's interval starts behind its origin.
fn is_behind(ray: &Ray) -> bool {
    ray.t_min < 0.0
}

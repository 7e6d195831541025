//! Where does a ray meet the scene? The tree and one kernel together.
//!
//! Kernel and CPU level are chosen when the intersector is made; a batch of rays then costs one virtual call,
//! or two while a better tree is to come.
//! `mesh` is for kernels that decide about each triangle by itself, `packet` for several rays of theirs at a
//! time; `exact` for the one that weighs hits against each other; `improving` asks another one, under which the
//! tree may be replaced.

mod blocks;
mod compact;
pub(crate) mod exact;
pub(crate) mod improving;
pub(crate) mod mesh;
mod packet;

pub use compact::Packing;

use crate::kernel::KernelInfo;
use crate::ray::{Hit, Ray};
use std::slice::from_ref;

/// What a ray cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Boxes tested.
    pub boxes: u32,
    /// Triangles tested.
    pub triangles: u32,
    /// Triangles whose bounds the exact kernel had to narrow in f64; 0 for the others.
    pub in_f64: u32,
    /// Decisions that it took in integers.
    pub in_integers: u32,
}

/// A place where a ray meets the surface: a hit, and those at the same t.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// That of the lowest primitive.
    pub hit: Hit,
    /// The other primitives, in order.
    pub also: Vec<u32>,
}

/// Answers rays for one scene with one kernel.
///
/// Rays come from [`Ray::new`] or a [`Camera`](crate::Camera), so they hold no NaN. A ray's interval and
/// hits are compared in the kernel's own precision; of hits at equal t the lowest primitive counts. A hit
/// whose t is beyond f32's largest number is a miss.
///
/// A hit counts only where the ray meets the box around the triangle, and comes no nearer than that box: the
/// first of [`all_hits`](Self::all_hits), by t alone, may be another one where t errs by more than the box is
/// large. So the tree changes no answer.
pub trait Intersector: Send + Sync {
    /// The kernel that it was made with.
    fn kernel(&self) -> &'static KernelInfo;

    /// The nearest hit with `t_min < t < t_max` of each ray, or `None`.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]);

    /// The same, quicker for rays that go together: sixteen in a row that look much the same way.
    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.closest_hits(rays, hits);
    }

    /// How many rays [`coherent_hits`](Self::coherent_hits) traces together.
    fn rays_together(&self) -> usize {
        1
    }

    /// That of one ray.
    fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        let mut hit = [None];
        self.closest_hits(from_ref(ray), &mut hit);
        hit[0]
    }

    /// The same, and what it cost.
    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost);

    /// Whether anything lies in `t_min < t < t_max`, ray by ray.
    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]);

    /// The same for one ray.
    fn any_hit(&self, ray: &Ray) -> bool {
        let mut is_hit = [false];
        self.any_hits(from_ref(ray), &mut is_hit);
        is_hit[0]
    }

    /// All hits with `t_min < t < t_max`, by t; those at equal t are one crossing.
    fn all_hits(&self, ray: &Ray) -> Vec<Crossing>;

    /// The triangles in the leaves whose boxes the ray meets, in no particular order: all that it
    /// could hit, whatever the kernel says.
    fn candidates(&self, ray: &Ray) -> Vec<u32>;

    /// Tests the ray against every triangle, tree and boxes aside, and counts the hits: for measurements.
    /// What the ray excludes is not excluded, and an end of its interval may count.
    fn count_hits(&self, ray: &Ray) -> usize;

    /// Bytes that the packed triangles take, the tree not counted.
    fn bytes(&self) -> usize;
}

/// Answers those rays whose intervals begin behind their origins, one by one: boxes then need padding on both
/// sides, which the others aren't to pay for.
fn answer_behind<T>(rays: &[Ray], answers: &mut [T], answer: impl Fn(&Ray) -> T) {
    let pairs = rays.iter().zip(answers);
    for (ray, place) in pairs.filter(|(ray, _)| is_behind(ray)) {
        *place = answer(ray);
    }
}

/// Whether a ray's interval begins behind its origin.
fn is_behind(ray: &Ray) -> bool {
    ray.t_min < 0.0
}

//! Where does a ray meet the scene? The tree and one kernel together.
//!
//! Kernel and CPU level are chosen when the intersector is made; a ray then costs one virtual call.
//! `mesh` is for kernels that decide about each triangle by itself, `exact` for the one that weighs
//! hits against each other.

mod blocks;
pub(crate) mod exact;
pub(crate) mod mesh;

use crate::kernel::KernelInfo;
use crate::ray::{Hit, Ray};

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
pub trait Intersector: Send + Sync {
    /// The kernel that it was made with.
    fn kernel(&self) -> &'static KernelInfo;

    /// The nearest hit with `t_min < t < t_max`, or `None`.
    fn closest_hit(&self, ray: &Ray) -> Option<Hit>;

    /// The same, and what it cost.
    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost);

    /// Whether anything lies in `t_min < t < t_max`.
    fn any_hit(&self, ray: &Ray) -> bool;

    /// All hits with `t_min < t < t_max`, by t; those at equal t are one crossing.
    fn all_hits(&self, ray: &Ray) -> Vec<Crossing>;

    /// The triangles in the leaves whose boxes the ray meets, in no particular order: all that it
    /// could hit, whatever the kernel says.
    fn candidates(&self, ray: &Ray) -> Vec<u32>;

    /// Tests the ray against every triangle, the tree aside, and counts the hits: for measurements. What
    /// the ray excludes is not excluded, and an end of its interval may count.
    fn count_hits(&self, ray: &Ray) -> usize;

    /// Bytes that the packed triangles take, the tree not counted.
    fn bytes(&self) -> usize;
}

/// The SIMD instructions that intersectors use on this machine, as tables call them.
pub fn simd_level_name() -> String {
    format!("{:?}", fearless_simd::Level::new())
        .split('(')
        .next()
        .unwrap_or_default()
        .to_owned()
}

/// Counts, or doesn't: the compiler drops the counting where nobody asks.
trait Tally {
    fn add(&mut self, cost: Cost);
}

struct NoTally;

impl Tally for NoTally {
    #[inline(always)]
    fn add(&mut self, _: Cost) {}
}

impl Tally for Cost {
    #[inline(always)]
    fn add(&mut self, cost: Cost) {
        self.boxes += cost.boxes;
        self.triangles += cost.triangles;
        self.in_f64 += cost.in_f64;
        self.in_integers += cost.in_integers;
    }
}

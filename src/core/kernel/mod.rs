//! Where does a ray meet a primitive? One algorithm, one file, written once over a lane type.
//!
//! A new triangle kernel is its file in `triangle/` and its two lines in `triangle/mod.rs`: the module,
//! and the row of [`TRIANGLE_KERNELS`].

mod triangle;

pub use triangle::{TRIANGLE_KERNELS, TriangleKernel, default_triangle_kernel, triangle_kernel};

use crate::lane::Lane;
use crate::ray::Ray;
use glam::Vec3;

/// The tier that a user chooses by, from fast to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// The quickest; promises nothing beyond what is measured.
    Fast,
    /// No gap between triangles that share an edge or a vertex.
    Watertight,
}

impl Tier {
    /// As `--kernel` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Watertight => "watertight",
        }
    }
}

/// What a kernel says of itself. What it promises, the conformance suite tests.
#[derive(Clone, Copy, Debug)]
pub struct KernelInfo {
    /// As `--kernel` takes it.
    pub name: &'static str,
    /// For menus.
    pub title: &'static str,
    /// The tier it serves, if any.
    pub tier: Option<Tier>,
    /// Author, title, year.
    pub source: &'static str,
    /// What it is good and bad at, in a sentence.
    pub summary: &'static str,
    /// Whether a ray can't slip between triangles of a closed mesh.
    pub is_watertight: bool,
}

/// What a test found: which lanes hit, and there t, u and v. Other lanes hold rubbish.
#[derive(Clone, Copy)]
pub(crate) struct LaneHit<L: Lane> {
    /// The lanes that hit.
    pub mask: L::Mask,
    /// Distance in lengths of the direction.
    pub t: L,
    /// Weight of the second vertex.
    pub u: L,
    /// Weight of the third vertex.
    pub v: L,
}

/// Triangles side by side, one a lane.
///
/// A kernel asks for the coordinates that it wants: to permute the axes then costs it an address, no
/// shuffle of loaded vectors.
pub(crate) trait Corners<L: Lane> {
    /// A coordinate (x, y, z: 0, 1, 2) of a corner (A, B, C: 0, 1, 2).
    fn coordinate(&self, corner: usize, axis: usize) -> L;
}

impl<L: Lane<Token = ()> + From<f32>> Corners<L> for [Vec3; 3] {
    #[inline(always)]
    fn coordinate(&self, corner: usize, axis: usize) -> L {
        self[corner][axis].into()
    }
}

/// One algorithm.
pub(crate) trait Kernel: Send + Sync + 'static {
    /// What it says of itself.
    const INFO: KernelInfo;
    /// A ray made ready for many tests.
    type Prepared<L: Lane>: Copy;

    /// Makes a ray ready; done once a ray.
    fn prepare<L: Lane>(token: L::Token, ray: &Ray) -> Self::Prepared<L>;

    /// Tests a ray against the triangles that the lanes of `corners` hold.
    ///
    /// A hit has `t_min < t ≤ t_max`; a triangle with a NaN is a miss, and so is one of zero area
    /// where the kernel recognises it. `None`: no lane hit.
    fn intersect<L: Lane>(
        ray: &Self::Prepared<L>,
        corners: &impl Corners<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>>;
}

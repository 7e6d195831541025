//! Ray–primitive tests: one algorithm per file, written once and generic over the lane type.
//!
//! To add a triangle kernel, add its file in `triangle/`, and to `triangle/mod.rs` the module and a row of
//! [`TRIANGLE_KERNELS`] for each precision.

mod ray_lanes;
mod triangle;

pub(crate) use ray_lanes::{RayLanes, axes_of};
pub use triangle::exact::exact_answer;
pub(crate) use triangle::{ShearedRay, exact};
pub use triangle::{
    TRIANGLE_KERNELS, TriangleKernel, bounds_in, default_triangle_kernel, exact_triangle_kernel,
    triangle_bounds, triangle_kernel,
};

use crate::aabb::Planes;
use crate::lane::{Lane, LaneMask, Number, Stored};
use crate::ray::Ray;
use glam::Vec3;

/// A kernel's tier, from fast to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// The fastest; promises nothing beyond the measured figures.
    Fast,
    /// Hits and misses match exact arithmetic, so there are no gaps between triangles that share an edge or a
    /// vertex.
    Watertight,
    /// As [`Watertight`](Self::Watertight), with t correct to the last place of f32.
    Precise,
    /// Hits, misses and the order of hits match exact arithmetic.
    Exact,
}

impl Tier {
    /// The name that `--kernel` takes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Watertight => "watertight",
            Self::Precise => "precise",
            Self::Exact => "exact",
        }
    }
}

/// The arithmetic of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 24 significant bits.
    F32,
    /// 53 significant bits, on the f32 mesh.
    F64,
    /// As many bits as the decision needs.
    Adaptive,
}

impl Precision {
    /// The name shown in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Adaptive => "adaptive",
        }
    }
}

/// The guarantees of a kernel beyond the measured figures; the conformance suite tests them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Promises {
    /// No ray passes between adjacent triangles of a closed mesh.
    pub is_watertight: bool,
    /// Hits and misses match exact arithmetic, and t is within 0.51 ulp of f32.
    pub is_accurate: bool,
    /// Hits, misses and the order of two hits match exact arithmetic.
    pub is_exact: bool,
    /// Translating ray and triangle by the same vector changes no bit, provided that no coordinate is
    /// rounded.
    pub is_translation_invariant: bool,
}

impl Promises {
    /// The promises of a kernel that starts from differences of coordinates.
    pub(crate) const PLAIN: Self = Self {
        is_watertight: false,
        is_accurate: false,
        is_exact: false,
        is_translation_invariant: true,
    };
}

/// A kernel's description.
#[derive(Clone, Copy, Debug)]
pub struct KernelInfo {
    /// The name that `--kernel` takes.
    pub name: &'static str,
    /// The title shown in menus.
    pub title: &'static str,
    /// The tier it serves, if any.
    pub tier: Option<Tier>,
    /// Its arithmetic.
    pub precision: Precision,
    /// Author, title, year.
    pub source: &'static str,
    /// Its strengths and weaknesses in a sentence.
    pub summary: &'static str,
    /// The guarantees that the conformance suite tests.
    pub promises: Promises,
}

impl KernelInfo {
    /// The name of its tier if it serves one, else its own name.
    pub fn short_name(&self) -> &'static str {
        self.tier.map_or(self.name, Tier::name)
    }
}

/// The result of a test: the lanes that hit, with t, u and v. Other lanes are undefined.
#[derive(Clone, Copy)]
pub(crate) struct LaneHit<L: Lane> {
    /// The lanes that hit.
    pub mask: L::Mask,
    /// The lanes that [`Kernel::decide`] must decide.
    pub doubtful: L::Mask,
    /// Distance in units of the direction's length.
    pub t: L,
    /// Weight of the second vertex.
    pub u: L,
    /// Weight of the third vertex.
    pub v: L,
}

impl<L: Lane> LaneHit<L> {
    /// A result without doubtful lanes; `None` if no lane hit.
    #[inline(always)]
    pub fn certain(mask: L::Mask, t: L, u: L, v: L) -> Option<Self> {
        mask.any().then_some(Self {
            mask,
            doubtful: mask & !mask,
            t,
            u,
            v,
        })
    }
}

/// The packed values of several triangles, one triangle per lane.
///
/// A kernel loads only the values that it needs, so permuting the axes changes an address and needs no
/// shuffle of loaded vectors.
pub(crate) trait Values<L: Lane> {
    /// The value at an index of the kernel's packed layout.
    fn value(&self, index: usize) -> L;

    /// Three consecutive values.
    #[inline(always)]
    fn three(&self, first: usize) -> [L; 3] {
        [
            self.value(first),
            self.value(first + 1),
            self.value(first + 2),
        ]
    }
}

/// The values of one triangle.
pub(crate) struct OneTriangle<'a, T>(pub &'a [T]);

impl<N: Number, T: Stored<N>> Values<N> for OneTriangle<'_, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> N {
        self.0[index].number()
    }
}

/// A ray–triangle algorithm in f32 and f64.
pub(crate) trait Kernel: Send + Sync + 'static {
    /// Its description in f32.
    const IN_F32: KernelInfo;
    /// Its description in f64.
    const IN_F64: KernelInfo;
    /// The number of values stored per triangle.
    const VALUES: usize;
    /// The type of the stored values when computing in `N`.
    type Stored<N: Number>: Stored<N> + Stored<f32>;
    /// Rays prepared for many tests.
    type Prepared<L: Lane>: Copy;

    /// Whether lanes can be doubtful. If so, lanes without a triangle hold another triangle's corners: NaN
    /// corners would always be doubtful.
    const IS_ADAPTIVE: bool = false;

    /// Packs a triangle into [`VALUES`](Self::VALUES) numbers, once.
    fn pack<N: Number>(corners: [Vec3; 3], values: &mut [Self::Stored<N>]);

    /// The exact box around each triangle as packed by `pack::<N>`; it lies within [`triangle_bounds`].
    fn bounds<N: Number, L: Lane>(triangles: &impl Values<L>) -> Planes<L>;

    /// Prepares rays, once per ray.
    fn prepare<L: Lane>(rays: &RayLanes<L>) -> Self::Prepared<L>;

    /// Tests a ray against a triangle in each lane: one ray against many triangles, or many rays against one.
    ///
    /// A hit has `t_min < t ≤ t_max`. A triangle with a NaN is a miss, and so is one of zero area if the
    /// kernel detects it. Returns `None` if no lane hit.
    fn intersect<L: Lane>(
        ray: &Self::Prepared<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>>;

    /// t, u and v of the hit in the ray's interval, for a lane that `intersect` left doubtful.
    #[cold]
    fn decide<N: Number>(_: &Ray, _: [Vec3; 3]) -> Option<[N; 3]> {
        None
    }
}

/// The largest number of values that any kernel stores per triangle.
pub(crate) const MAX_VALUES: usize = 18;

/// Packs the corners unchanged: x, y and z of A, then of B, then of C.
pub(crate) fn pack_corners(corners: [Vec3; 3], values: &mut [f32]) {
    for (corner, kept) in corners.iter().zip(values.chunks_exact_mut(3)) {
        kept.copy_from_slice(&corner.to_array());
    }
}

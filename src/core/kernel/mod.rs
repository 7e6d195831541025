//! Tests of a ray against a primitive: one algorithm a file, written once over a lane type.
//!
//! A new triangle kernel is its file in `triangle/` and its lines in `triangle/mod.rs`: the module, and a
//! row of [`TRIANGLE_KERNELS`] for each precision.

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

/// The tier that a user chooses by, from fast to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// The quickest; promises nothing beyond what is measured.
    Fast,
    /// Hit or miss as exact arithmetic says, so no gap between triangles that share an edge or a vertex.
    Watertight,
    /// The same, and t to f32's last place.
    Precise,
    /// Hit or miss, and which of two hits is nearer, always as exact arithmetic says.
    Exact,
}

impl Tier {
    /// As `--kernel` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Watertight => "watertight",
            Self::Precise => "precise",
            Self::Exact => "exact",
        }
    }
}

/// What a kernel computes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 24 binary digits.
    F32,
    /// 53 binary digits, of the f32 mesh.
    F64,
    /// As many as it takes.
    Adaptive,
}

impl Precision {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Adaptive => "adaptive",
        }
    }
}

/// What a kernel promises beyond the figures that are measured; the conformance suite tests it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Promises {
    /// No ray slips between triangles of a closed mesh.
    pub is_watertight: bool,
    /// Hit or miss as exact arithmetic says, and t within 0.7 ulp of f32.
    pub is_accurate: bool,
    /// Hit or miss, and the order of two hits, are as exact arithmetic says.
    pub is_exact: bool,
    /// Where moving ray and triangle by the same vector rounds no coordinate, it changes no bit.
    pub is_translation_invariant: bool,
}

impl Promises {
    /// What a kernel keeps that starts from differences of coordinates.
    pub(crate) const PLAIN: Self = Self {
        is_watertight: false,
        is_accurate: false,
        is_exact: false,
        is_translation_invariant: true,
    };
}

/// What a kernel says of itself.
#[derive(Clone, Copy, Debug)]
pub struct KernelInfo {
    /// As `--kernel` takes it.
    pub name: &'static str,
    /// For menus.
    pub title: &'static str,
    /// The tier it serves, if any.
    pub tier: Option<Tier>,
    /// What it computes in.
    pub precision: Precision,
    /// Author, title, year.
    pub source: &'static str,
    /// What it is good and bad at, in a sentence.
    pub summary: &'static str,
    /// What the conformance suite holds it to.
    pub promises: Promises,
}

impl KernelInfo {
    /// As a user asks for it: by its tier if it serves one, else by its own name.
    pub fn short_name(&self) -> &'static str {
        self.tier.map_or(self.name, Tier::name)
    }
}

/// What a test found: which lanes hit, and t, u and v there. Other lanes are undefined.
#[derive(Clone, Copy)]
pub(crate) struct LaneHit<L: Lane> {
    /// The lanes that hit.
    pub mask: L::Mask,
    /// The lanes that [`Kernel::decide`] decides about.
    pub doubtful: L::Mask,
    /// Distance in lengths of the direction.
    pub t: L,
    /// Weight of the second vertex.
    pub u: L,
    /// Weight of the third vertex.
    pub v: L,
}

impl<L: Lane> LaneHit<L> {
    /// No lane is in doubt; `None` if no lane hit.
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

/// What a kernel keeps of triangles side by side, one a lane.
///
/// A kernel asks for the values that it wants: to permute the axes then costs it an address, no
/// shuffle of loaded vectors.
pub(crate) trait Values<L: Lane> {
    /// A value, by the index at which the kernel packed it.
    fn value(&self, index: usize) -> L;

    /// Three values in a row.
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

/// One algorithm, in f32 and in f64.
pub(crate) trait Kernel: Send + Sync + 'static {
    /// What it says of itself in f32.
    const IN_F32: KernelInfo;
    /// What it says of itself in f64.
    const IN_F64: KernelInfo;
    /// How many numbers it keeps of a triangle.
    const VALUES: usize;
    /// What it keeps them as where it works in `N`.
    type Stored<N: Number>: Stored<N> + Stored<f32>;
    /// Rays made ready for many tests.
    type Prepared<L: Lane>: Copy;

    /// Whether lanes may be doubtful. A lane without a triangle would then always be: it holds another
    /// triangle's corners, as no corner is NaN.
    const IS_ADAPTIVE: bool = false;

    /// Makes a triangle ready; done once, into [`VALUES`](Self::VALUES) numbers.
    fn pack<N: Number>(corners: [Vec3; 3], values: &mut [Self::Stored<N>]);

    /// The box around each triangle as `pack::<N>` packed it, exactly; within
    /// [`triangle_bounds`].
    fn bounds<N: Number, L: Lane>(triangles: &impl Values<L>) -> Planes<L>;

    /// Makes rays ready; done once a ray.
    fn prepare<L: Lane>(rays: &RayLanes<L>) -> Self::Prepared<L>;

    /// Tests lane by lane a ray against a triangle: one ray against many triangles, or many against one.
    ///
    /// A hit has `t_min < t ≤ t_max`; a triangle with a NaN is a miss, and so is one of zero area
    /// where the kernel recognises it. `None`: no lane hit.
    fn intersect<L: Lane>(
        ray: &Self::Prepared<L>,
        triangles: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>>;

    /// t, u and v where a ray hits a triangle in the ray's interval, for a lane that `intersect` left in
    /// doubt.
    #[cold]
    fn decide<N: Number>(_: &Ray, _: [Vec3; 3]) -> Option<[N; 3]> {
        None
    }
}

/// As many values as any kernel keeps of a triangle.
pub(crate) const MOST_VALUES: usize = 18;

/// Packs the corners as they are: the x, y and z of A, of B, of C.
pub(crate) fn pack_corners(corners: [Vec3; 3], values: &mut [f32]) {
    for (corner, kept) in corners.iter().zip(values.chunks_exact_mut(3)) {
        kept.copy_from_slice(&corner.to_array());
    }
}

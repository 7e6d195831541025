//! The interface of an intersection algorithm.

use super::{KernelInfo, RayLanes};
use crate::aabb::Planes;
use crate::lane::{Lane, LaneMask, Number, Stored, Values};
use crate::ray::Ray;
use crate::shape::{Shape, numbers_of};

/// The result of a test: the lanes that hit, with t, u and v. Other lanes are undefined.
#[derive(Clone, Copy)]
pub struct LaneHit<L: Lane> {
    /// The lanes that hit.
    pub mask: L::Mask,
    /// The lanes that [`Kernel::decide`] must decide.
    pub doubtful: L::Mask,
    /// Distance in units of the direction's length.
    pub t: L,
    /// The first surface coordinate; for a triangle, the weight of its second corner.
    pub u: L,
    /// The second surface coordinate; for a triangle, the weight of its third corner.
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

/// An intersection algorithm for one shape, in f32 and f64.
pub trait Kernel: Send + Sync + 'static {
    /// The shape that it tests.
    type Shape: Shape;
    /// Its description in f32.
    const IN_F32: KernelInfo;
    /// Its description in f64.
    const IN_F64: KernelInfo;
    /// The number of values stored per primitive; by default, its parameters.
    const VALUES: usize = Self::Shape::NUMBERS;
    /// The type of the stored values when computing in `N`.
    type Stored<N: Number>: Stored<N> + Stored<f32> + From<f32>;
    /// Rays prepared for many tests, once per ray.
    type Prepared<L: Lane>: Copy + From<RayLanes<L>>;

    /// Whether lanes can be doubtful. If so, lanes without a primitive hold a copy of another one: NaN values
    /// would always be doubtful.
    const IS_ADAPTIVE: bool = false;

    /// Whether blocks that [`Shape::may_meet`] rejects in f32 aren't tested in f64. Only for kernels that store the
    /// primitive's parameters and that would miss them all in f64.
    const IS_FILTERED: bool = false;

    /// Its description in `N`.
    fn info<N: Number>() -> &'static KernelInfo {
        if N::HOLDS_PRODUCTS {
            &Self::IN_F64
        } else {
            &Self::IN_F32
        }
    }

    /// Packs a primitive into [`VALUES`](Self::VALUES) numbers, once; by default, its parameters.
    fn pack<N: Number>(shape: &Self::Shape, values: &mut [Self::Stored<N>]) {
        let values = &mut values[..Self::Shape::NUMBERS];
        for (value, number) in values.iter_mut().zip(numbers_of(shape)) {
            *value = number.into();
        }
    }

    /// The exact box around each primitive as packed by `pack::<N>`; it lies within [`Shape::bounds`]. By default, of
    /// values that are parameters.
    #[inline(always)]
    fn bounds<N: Number, L: Lane>(primitives: &impl Values<L>) -> Planes<L> {
        Self::Shape::planes(primitives)
    }

    /// Tests a ray against a primitive in each lane: one ray against many primitives, or many rays against one.
    ///
    /// A hit has `t_min < t ≤ t_max`. A primitive with a NaN is a miss, and so is a triangle of zero area if
    /// the kernel detects it. Returns `None` if no lane hit.
    fn intersect<L: Lane>(
        ray: &Self::Prepared<L>,
        primitives: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>>;

    /// t, u and v of the hit in the ray's interval, for a lane that `intersect` left doubtful. `primitive` holds
    /// the lane's values.
    #[cold]
    fn decide<N: Number>(_: &Ray, _: &impl Values<f32>) -> Option<[N; 3]> {
        None
    }
}

/// The largest number of values that any kernel stores per primitive.
pub const MAX_VALUES: usize = 18;

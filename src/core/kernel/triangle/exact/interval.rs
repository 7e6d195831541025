//! The depths at which rays' intervals start and end, bounded in the precision of the lanes.

use crate::kernel::RayLanes;
use crate::kernel::triangle::shear::ShearedRay;
use crate::lane::{Lane, Number};

/// Bounds of the depths at which rays' intervals start and end.
#[derive(Clone, Copy)]
pub(crate) struct DepthInterval<L> {
    /// |d_z|: a depth is t times this.
    pub per_t: L,
    /// Hits below this depth certainly lie before the interval.
    pub earliest: L,
    /// Hits above this depth certainly lie after the start of the interval.
    pub start: L,
    /// Hits below this depth certainly lie before the end of the interval.
    pub end: L,
}

impl<L: Lane> DepthInterval<L> {
    #[inline(always)]
    pub fn new(rays: &RayLanes<L>, sheared: &ShearedRay<L>) -> Self {
        let per_t = sheared.dir_z().abs();
        let most = L::of(per_t.token(), f32::MAX);
        let start = rays.interval[0].greater(-most) * per_t;
        let end = rays.interval[1].lesser(most) * per_t;
        Self {
            per_t,
            earliest: surely_below(start),
            start: -surely_below(-start),
            end: surely_below(end),
        }
    }

    /// A depth behind which hits certainly lie behind `t`.
    #[inline(always)]
    pub fn deepest(&self, t: L) -> L {
        -surely_below(-(t * self.per_t))
    }

    /// The lanes whose depths, which lie between `near` and `far`, certainly lie in the interval.
    #[inline(always)]
    pub fn contains(&self, near: L, far: L) -> L::Mask {
        self.start.lt(near) & far.lt(self.end)
    }
}

/// A lower bound of a product of two f32 that was rounded to `x`. Infinite if `x` is.
#[inline(always)]
fn surely_below<L: Lane>(x: L) -> L {
    let token = x.token();
    let number = |x: L::Number| L::splat(token, x);
    let (one, ulps) = (L::of(token, 1.0), L::of(token, 8.0) * number(L::Number::U));
    let nearer = (x * (one - ulps)).lesser(x * (one + ulps));
    nearer - number(L::Number::LEAST_NORMAL)
}

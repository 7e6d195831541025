//! The part of a ray between pairs of parallel planes.
//!
//! Source: Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986.

use super::LaneHit;
use super::crossings::Nearest;
use crate::lane::{Lane, LaneMask as _};

/// The part of a ray between all pairs of planes so far, with the face at either end. Face 2k is the first plane of
/// pair k, face 2k + 1 the second.
#[derive(Clone, Copy)]
pub(super) struct SlabInterval<L: Lane> {
    enter: L,
    leave: L,
    entry: L,
    exit: L,
}

impl<L: Lane> SlabInterval<L> {
    /// The whole ray.
    #[inline(always)]
    pub fn whole(of: L) -> Self {
        let (zero, infinity) = (L::of(of.token(), 0.0), L::of(of.token(), f32::INFINITY));
        Self {
            enter: -infinity,
            leave: infinity,
            entry: zero,
            exit: zero,
        }
    }

    /// The part that is also between the planes of a pair, which the ray crosses at `low` and `high`. `slope` has the
    /// sign of the direction across the planes, also of a zero.
    ///
    /// A parallel ray between the planes gives −∞ and ∞; one outside gives two equal infinities; one in a plane gives
    /// NaN there, which no comparison lets through.
    #[inline(always)]
    pub fn clip(&mut self, pair: u8, low: L, high: L, slope: L) {
        let (zero, one) = (L::of(low.token(), 0.0), L::of(low.token(), 1.0));
        let is_forward = zero.lt(one.flip(slope));
        let first = L::select(is_forward, low, high);
        let last = L::select(is_forward, high, low);
        let faces = [2 * pair, 2 * pair + 1].map(|face| L::of(low.token(), face.into()));
        let near_face = L::select(is_forward, faces[0], faces[1]);
        let far_face = L::select(is_forward, faces[1], faces[0]);
        let (is_later, is_sooner) = (self.enter.lt(first), last.lt(self.leave));
        self.enter = L::select(is_later, first, self.enter);
        self.entry = L::select(is_later, near_face, self.entry);
        self.leave = L::select(is_sooner, last, self.leave);
        self.exit = L::select(is_sooner, far_face, self.exit);
    }

    /// The first end in the interval, if the slabs overlap; the exit is moved back by `slack`, relatively.
    #[inline(always)]
    pub fn hit(self, t_min: L, t_max: L, slack: L::Number) -> Option<LaneHit<L>> {
        let grown = self.leave + self.leave.abs() * L::splat(t_min.token(), slack);
        let meets = self.enter.le(grown);
        if !meets.any() {
            return None;
        }
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer_face(meets, self.enter, self.entry);
        nearest.offer_face(meets, self.leave, self.exit);
        nearest.hit()
    }
}

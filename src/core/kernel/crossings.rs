//! Points at which rays meet surfaces of degree 2, and the nearest of several.

use super::LaneHit;
use crate::lane::{Lane, LaneMask, dot, plus, times};

/// The two points at which a line meets a surface of degree 2.
#[derive(Clone, Copy)]
pub(super) struct Roots<L: Lane> {
    /// The lanes in which they exist. In other lanes they are undefined.
    pub exist: L::Mask,
    pub near: L,
    pub far: L,
}

impl<L: Lane> Roots<L> {
    /// The roots of a·t² + 2b·t + c as textbooks have them.
    #[inline(always)]
    pub fn naive(a: L, b: L, c: L) -> Self {
        let discriminant = b * b - a * c;
        let root = discriminant.sqrt();
        Self::ordered(discriminant, (-b - root) / a, (-b + root) / a)
    }

    /// The roots of a·t² + 2b·t + c for a discriminant b² − ac that was computed otherwise.
    ///
    /// Source: Press et al., Numerical Recipes, 1986: −b and the root have equal signs in q.
    #[inline(always)]
    pub fn press(a: L, b: L, c: L, discriminant: L) -> Self {
        let q = -(b + discriminant.sqrt().flip(b));
        Self::ordered(discriminant, c / q, q / a)
    }

    /// t of the points f + t·d at the distance r from 0, given a = d·d and r².
    ///
    /// Source: Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems,
    /// 2019: the discriminant r² − l·l, where l is the point nearest to 0, is a difference of numbers of the size of r.
    #[inline(always)]
    pub fn at_distance(f: &[L; 3], d: &[L; 3], a: L, r_squared: L) -> Self {
        let b = dot(f, d);
        let l = plus(f, &times(-b / a, d));
        let discriminant = a * (r_squared - dot(&l, &l));
        Self::press(a, b, dot(f, f) - r_squared, discriminant)
    }

    #[inline(always)]
    fn ordered(discriminant: L, first: L, second: L) -> Self {
        Self {
            exist: L::of(first.token(), 0.0).le(discriminant),
            near: first.lesser(second),
            far: first.greater(second),
        }
    }

    /// The nearer one in the interval, as a hit of part 0.
    #[inline(always)]
    pub fn nearest(self, t_min: L, t_max: L) -> Option<LaneHit<L>> {
        let t = L::select(t_min.lt(self.near), self.near, self.far);
        let zero = L::of(t.token(), 0.0);
        LaneHit::certain(self.exist & t_min.lt(t) & t.le(t_max), t, zero, zero)
    }
}

/// The nearest of the crossings offered so far; of several at equal t, the first.
pub(super) struct Nearest<L: Lane> {
    t_min: L,
    t: L,
    part: L,
    is_hit: L::Mask,
}

impl<L: Lane> Nearest<L> {
    /// No crossing, in an interval.
    #[inline(always)]
    pub fn new(t_min: L, t_max: L) -> Self {
        Self {
            t_min,
            t: t_max,
            part: L::of(t_min.token(), 0.0),
            is_hit: t_max.lt(t_max),
        }
    }

    /// Offers a crossing in some lanes.
    #[inline(always)]
    pub fn offer(&mut self, exists: L::Mask, t: L, part: u8) {
        self.offer_face(exists, t, L::of(t.token(), part.into()));
    }

    /// Offers a crossing in some lanes, each with its own part.
    #[inline(always)]
    pub fn offer_face(&mut self, exists: L::Mask, t: L, part: L) {
        let is_nearer = t.lt(self.t) | (t.le(self.t) & !self.is_hit);
        let is_nearest = exists & self.t_min.lt(t) & is_nearer;
        self.t = L::select(is_nearest, t, self.t);
        self.part = L::select(is_nearest, part, self.part);
        self.is_hit = self.is_hit | is_nearest;
    }

    /// The hit: u is the part.
    #[inline(always)]
    pub fn hit(self) -> Option<LaneHit<L>> {
        let nowhere = self.is_hit & !self.is_hit;
        self.hit_or_doubt(nowhere)
    }

    /// The hit, except in doubtful lanes.
    #[inline(always)]
    pub fn hit_or_doubt(self, doubtful: L::Mask) -> Option<LaneHit<L>> {
        let zero = L::of(self.t.token(), 0.0);
        (self.is_hit | doubtful).any().then(|| LaneHit {
            mask: self.is_hit & !doubtful,
            doubtful,
            t: self.t,
            u: self.part,
            v: zero,
        })
    }
}

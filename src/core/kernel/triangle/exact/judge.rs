//! Decides about hits and their order: from f32 depth bounds if those don't overlap, else in f64, else in
//! integers.

use super::super::shear::ShearedRay;
use super::rounding::rounded_t;
use super::{Filtered, VALUES, filter, integer};
use crate::lane::Number;
use crate::ray::{Hit, Ray};
use crate::shape::{Shape as _, Triangle};
use glam::Vec3;
use std::cmp::Ordering;

/// Counts of decisions that f32 left open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct JudgeCounters {
    /// Triangles whose f32 bounds were too wide for a decision.
    pub in_f64: u32,
    /// Decisions about hit, interval or order that f64 left open.
    pub in_integers: u32,
}

/// A triangle that the ray's line meets, with bounds of its depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub primitive: u32,
    /// The slot whose corners it has.
    pub slot: usize,
    /// Lower bound of |t·d_z| with t's sign.
    near: f64,
    /// Upper bound of |t·d_z| with t's sign.
    far: f64,
    /// Whether the bounds have been narrowed in f64.
    is_narrow: bool,
}

impl Candidate {
    /// A candidate with the f32 filter's bounds.
    #[inline(always)]
    pub fn new(primitive: u32, slot: usize, near: f32, far: f32) -> Self {
        Self {
            primitive,
            slot,
            near: near.into(),
            far: far.into(),
            is_narrow: false,
        }
    }

    /// The bounds of |t·d_z|, with t's sign.
    #[inline(always)]
    pub fn bounds(&self) -> [f64; 2] {
        [self.near, self.far]
    }

    /// The candidate's hit, with t, u and v rounded to f32.
    pub fn hit(&self, [t, u, v]: [f64; 3]) -> Hit {
        Hit {
            t: rounded_t(t),
            u: u as f32,
            v: v as f32,
            primitive: self.primitive,
        }
    }

    /// The bounds in f32, no narrower than in f64.
    pub fn bounds_f32(&self) -> [f32; 2] {
        let (near, far) = (self.near as f32, self.far as f32);
        [
            if f64::from(near) > self.near {
                near.next_down()
            } else {
                near
            },
            if f64::from(far) < self.far {
                far.next_up()
            } else {
                far
            },
        ]
    }
}

/// The corners of triangles.
pub(crate) trait Corners {
    /// The corners in a slot.
    fn corners(&self, slot: usize) -> [Vec3; 3];
}

/// One triangle, in every slot.
impl Corners for [Vec3; 3] {
    fn corners(&self, _: usize) -> [Vec3; 3] {
        *self
    }
}

/// Decides about the hits of one ray.
pub(crate) struct Judge<'a, C> {
    ray: &'a Ray,
    corners: C,
    dir_z: f64,
    /// The ends of [`Ray::finite_interval`] as depths; products of 24 by 24 bits are exact.
    interval: [f64; 2],
    pub work: JudgeCounters,
}

impl<'a, C: Corners> Judge<'a, C> {
    pub fn new(ray: &'a Ray, corners: C) -> Self {
        let dir_z = f64::from(ray.dir.abs().max_element());
        Self {
            ray,
            corners,
            dir_z,
            interval: ray.finite_interval().map(|t| f64::from(t) * dir_z),
            work: JudgeCounters::default(),
        }
    }

    pub fn ray(&self) -> &'a Ray {
        self.ray
    }

    /// The depths at which the ray's interval starts and ends.
    #[inline(always)]
    pub fn interval(&self) -> [f64; 2] {
        self.interval
    }

    /// A depth below which hits lie before the ray's interval, among them the hit of the triangle that the
    /// ray leaves.
    #[inline(always)]
    pub fn earliest(&self) -> f32 {
        let start = self.interval[0] as f32;
        // Rounding errs by half an ulp, or by half of the smallest positive number.
        start - start.abs() * f32::EPSILON - f32::from_bits(1)
    }

    /// Returns `candidate` if its hit lies in the ray's interval. It must not be a certain miss. Its bounds
    /// and `is_certain` come from the f32 filter.
    #[inline(always)]
    pub fn within(&mut self, candidate: Candidate, is_certain: bool) -> Option<Candidate> {
        let ([start, end], [near, far]) = (self.interval, candidate.bounds());
        if is_certain && start < near && far < end {
            Some(candidate)
        } else {
            self.doubtful(candidate, is_certain)
        }
    }

    // Not inlined: this path is rare, and the common path is faster without it.
    #[inline(never)]
    fn doubtful(&mut self, mut candidate: Candidate, is_certain: bool) -> Option<Candidate> {
        if !is_certain && !self.narrow(&mut candidate) {
            return None;
        }
        let [start, end] = self.ray.finite_interval();
        let is_after = self.compare_with(&mut candidate, start) == Ordering::Greater;
        (is_after && self.compare_with(&mut candidate, end) == Ordering::Less).then_some(candidate)
    }

    /// Compares two hits by t, exactly.
    #[inline(never)]
    pub fn compare(&mut self, first: &mut Candidate, second: &mut Candidate) -> Ordering {
        let by_bounds = |first: &Candidate, second: &Candidate| {
            if first.far < second.near {
                Some(Ordering::Less)
            } else if second.far < first.near {
                Some(Ordering::Greater)
            } else {
                None
            }
        };
        if let Some(order) = by_bounds(first, second) {
            return order;
        }
        let (a, b) = (
            self.corners.corners(first.slot),
            self.corners.corners(second.slot),
        );
        if a == b {
            return Ordering::Equal;
        }
        self.narrow(first);
        self.narrow(second);
        by_bounds(first, second).unwrap_or_else(|| {
            self.work.in_integers += 1;
            // Hits through a shared corner: many triangles may share it, and this test is much cheaper than a
            // comparison.
            let mut shared = a.iter().filter(|p| b.contains(p));
            if shared.any(|p| integer::meets(self.ray, *p)) {
                return Ordering::Equal;
            }
            integer::compare(self.ray, a, b)
        })
    }

    /// Compares a hit's t with a number, exactly.
    fn compare_with(&mut self, candidate: &mut Candidate, t: f32) -> Ordering {
        // Exact: a product of 24 by 24 bits.
        let depth = f64::from(t) * self.dir_z;
        let by_bounds = |candidate: &Candidate| {
            if candidate.far < depth {
                Some(Ordering::Less)
            } else if candidate.near > depth {
                Some(Ordering::Greater)
            } else {
                None
            }
        };
        if let Some(order) = by_bounds(candidate) {
            return order;
        }
        self.narrow(candidate);
        by_bounds(candidate).unwrap_or_else(|| {
            self.work.in_integers += 1;
            integer::compare_with(self.ray, self.corners.corners(candidate.slot), t)
        })
    }

    /// Narrows the bounds in f64, or in integers where f64 fails. Returns `false` if the triangle is missed.
    pub fn narrow(&mut self, candidate: &mut Candidate) -> bool {
        if candidate.is_narrow {
            return true;
        }
        candidate.is_narrow = true;
        self.work.in_f64 += 1;
        let corners = self.corners.corners(candidate.slot);
        let Some(filtered) = in_f64(self.ray, corners) else {
            return false;
        };
        if !filtered.certain {
            self.work.in_integers += 1;
            if !integer::is_inside(self.ray, corners) {
                return false;
            }
        }
        let (near, far) = (filtered.near(), filtered.far());
        // The bounds fail both tests if the sum of the edge functions came out 0.
        if near <= far && far - near < f64::INFINITY {
            (candidate.near, candidate.far) = (near, far);
        } else {
            let [t, ..] = integer::rounded(self.ray, corners);
            let depth = t * self.dir_z;
            // Three roundings, and the truncated digits.
            let slack = 4.0 * f64::EPSILON * depth.abs();
            (candidate.near, candidate.far) = (depth - slack, depth + slack);
        }
        true
    }

    /// The hit, rounded to f32.
    pub fn hit(&self, candidate: Candidate) -> Hit {
        candidate.hit(self.values(candidate))
    }

    /// t, u and v of a hit. t errs by at most 2⁻³² relatively, the weights by at most 2⁻³¹.
    pub fn values(&self, candidate: Candidate) -> [f64; 3] {
        self.values_for::<f64>(candidate)
    }

    /// t, u and v of a hit. t errs by at most [`Number::T_SLACK`] relatively, the weights by at most
    /// [`Number::WEIGHT_SLACK`].
    pub fn values_for<N: Number>(&self, candidate: Candidate) -> [f64; 3] {
        let corners = self.corners.corners(candidate.slot);
        let (t_slack, weight_slack) = (N::T_SLACK.into(), N::WEIGHT_SLACK.into());
        match in_f64(self.ray, corners) {
            Some(filtered) if filtered.is_within(t_slack, weight_slack) => {
                // A hit has no negative weight.
                let [u, v] = filtered.weights.map(|weight| weight.max(0.0));
                [filtered.depth / self.dir_z, u, v]
            }
            _ => integer::rounded(self.ray, corners),
        }
    }
}

/// The f64 filter's result for a triangle; `None` if it is missed.
// Not inlined: this path is rare, and the common path is faster without it.
#[inline(never)]
fn in_f64(ray: &Ray, corners: [Vec3; 3]) -> Option<Filtered<f64>> {
    let mut values = [0.0; VALUES];
    Triangle(corners).write(&mut values);
    filter(&ShearedRay::<f64>::of((), ray), &&values[..])
}

//! Decides about hits one by one: from their f32 depths if those don't overlap, else in f64, else in
//! integers.

use super::super::shear::ShearedRay;
use super::{Filtered, VALUES, filter, integer};
use crate::kernel::{OneTriangle, pack_corners};
use crate::lane::Number;
use crate::ray::{Hit, Ray};
use glam::Vec3;
use std::cmp::Ordering;

/// How often f32 could not decide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct JudgeCounters {
    /// Triangles whose bounds f32 left too wide for a decision.
    pub in_f64: u32,
    /// Decisions about hit, interval or order that f64 left open.
    pub in_integers: u32,
}

/// A triangle that the ray's line meets, and bounds on where.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub primitive: u32,
    /// Where its corners are found.
    pub slot: usize,
    /// |t·d_z| with t's sign is at least this,
    near: f64,
    /// and at most that.
    far: f64,
    /// Whether the bounds are as narrow as f64 makes them.
    is_narrow: bool,
}

impl Candidate {
    /// With the f32 filter's bounds.
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

    /// On |t·d_z|, with t's sign.
    #[inline(always)]
    pub fn bounds(&self) -> [f64; 2] {
        [self.near, self.far]
    }

    /// The hit there, t, u and v rounded.
    pub fn hit(&self, [t, u, v]: [f64; 3]) -> Hit {
        Hit {
            // Not quite f32's largest number may round to infinity.
            t: (t as f32).min(f32::MAX),
            u: u as f32,
            v: v as f32,
            primitive: self.primitive,
        }
    }

    /// The bounds in f32, no narrower than those in f64.
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

/// The questions about one ray. `corners` finds those of a slot.
pub(crate) struct Judge<'a, F> {
    ray: &'a Ray,
    corners: F,
    dir_z: f64,
    /// The ends of [`Ray::finite_interval`] as depths, exactly: 24 digits by 24.
    interval: [f64; 2],
    pub work: JudgeCounters,
}

impl<'a, F: Fn(usize) -> [Vec3; 3]> Judge<'a, F> {
    pub fn new(ray: &'a Ray, corners: F) -> Self {
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

    /// The depths at which the ray's interval begins and ends.
    #[inline(always)]
    pub fn interval(&self) -> [f64; 2] {
        self.interval
    }

    /// Depths below this are before the ray's interval: among them those of the triangle that it leaves.
    #[inline(always)]
    pub fn earliest(&self) -> f32 {
        let start = self.interval[0] as f32;
        // Rounding is off by half an ulp, or half of the least number.
        start - start.abs() * f32::EPSILON - f32::from_bits(1)
    }

    /// `candidate`, which isn't a certain miss, if its hit lies in the ray's interval. Its bounds are the
    /// f32 filter's, and so is `is_certain`.
    #[inline(always)]
    pub fn within(&mut self, candidate: Candidate, is_certain: bool) -> Option<Candidate> {
        let ([start, end], [near, far]) = (self.interval, candidate.bounds());
        if is_certain && start < near && far < end {
            Some(candidate)
        } else {
            self.doubtful(candidate, is_certain)
        }
    }

    // Out of line: it is the rare path, and the common one is the better for it.
    #[inline(never)]
    fn doubtful(&mut self, mut candidate: Candidate, is_certain: bool) -> Option<Candidate> {
        if !is_certain && !self.narrow(&mut candidate) {
            return None;
        }
        let [start, end] = self.ray.finite_interval();
        let is_after = self.compare_with(&mut candidate, start) == Ordering::Greater;
        (is_after && self.compare_with(&mut candidate, end) == Ordering::Less).then_some(candidate)
    }

    /// Whether the first is nearer, or as near and of a lower index.
    #[inline(always)]
    pub fn is_before(&mut self, first: &mut Candidate, second: &mut Candidate) -> bool {
        if first.far < second.near {
            return true;
        }
        match self.compare(first, second) {
            Ordering::Less => true,
            Ordering::Equal => first.primitive < second.primitive,
            Ordering::Greater => false,
        }
    }

    /// Which is nearer, exactly.
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
        let (a, b) = ((self.corners)(first.slot), (self.corners)(second.slot));
        if a == b {
            return Ordering::Equal;
        }
        self.narrow(first);
        self.narrow(second);
        by_bounds(first, second).unwrap_or_else(|| {
            self.work.in_integers += 1;
            // Through a shared corner: many triangles may share it, and this takes a fraction of the time.
            let mut shared = a.iter().filter(|p| b.contains(p));
            if shared.any(|p| integer::meets(self.ray, *p)) {
                return Ordering::Equal;
            }
            integer::compare(self.ray, a, b)
        })
    }

    /// How a hit's t compares with a number, exactly.
    fn compare_with(&mut self, candidate: &mut Candidate, t: f32) -> Ordering {
        // Exact: 24 digits by 24.
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
            integer::compare_with(self.ray, (self.corners)(candidate.slot), t)
        })
    }

    /// Narrows the bounds as far as f64 can. `false`: the triangle is missed.
    pub fn narrow(&mut self, candidate: &mut Candidate) -> bool {
        if candidate.is_narrow {
            return true;
        }
        candidate.is_narrow = true;
        self.work.in_f64 += 1;
        let corners = (self.corners)(candidate.slot);
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
        // Neither where the sum of the edge functions came out 0.
        if near <= far && far - near < f64::INFINITY {
            (candidate.near, candidate.far) = (near, far);
        } else {
            let [t, ..] = integer::rounded(self.ray, corners);
            let depth = t * self.dir_z;
            // Three roundings, and the digits that were cut off.
            let slack = 4.0 * f64::EPSILON * depth.abs();
            (candidate.near, candidate.far) = (depth - slack, depth + slack);
        }
        true
    }

    /// The hit, rounded.
    pub fn hit(&self, candidate: Candidate) -> Hit {
        candidate.hit(self.values(candidate))
    }

    /// t, u and v of a hit: t off by at most 2⁻³² of it, weights by 2⁻³¹.
    pub fn values(&self, candidate: Candidate) -> [f64; 3] {
        self.values_for::<f64>(candidate)
    }

    /// t, u and v of a hit, t off by at most [`Number::T_SLACK`] of it, weights by [`Number::WEIGHT_SLACK`].
    pub fn values_for<N: Number>(&self, candidate: Candidate) -> [f64; 3] {
        let corners = (self.corners)(candidate.slot);
        let (t_slack, weight_slack) = (N::T_SLACK.into(), N::WEIGHT_SLACK.into());
        match in_f64(self.ray, corners) {
            Some(filtered) if filtered.is_within(t_slack, weight_slack) => {
                // What is hit has no weight below 0.
                let [u, v] = filtered.weights.map(|weight| weight.max(0.0));
                [filtered.depth / self.dir_z, u, v]
            }
            _ => integer::rounded(self.ray, corners),
        }
    }
}

/// What f64 knows of a triangle; `None`: it is missed.
// Out of line: it is the rare path, and the common one is the better for it.
#[inline(never)]
fn in_f64(ray: &Ray, corners: [Vec3; 3]) -> Option<Filtered<f64>> {
    let mut values = [0.0; VALUES];
    pack_corners(corners, &mut values);
    filter(&ShearedRay::<f64>::of((), ray), &OneTriangle(&values))
}

//! Hits with a t that is exact if the kernel is, and their order.

use super::Crossing;
use super::order::{Comparison, precedes};
use crate::algebra::{Algebraic, is_between};
use crate::ray::{Hit, Ray};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// A hit and its t, for comparison with hits of other groups.
pub struct RankedHit {
    /// The hit, rounded.
    pub hit: Hit,
    /// Bounds of t; equal if the kernel isn't exact.
    pub(super) t: [f64; 2],
    /// t, if the kernel is exact.
    pub(super) exact: Option<ExactT>,
    /// Whether the ray certainly touches the surface without passing through it.
    pub(crate) is_tangent: bool,
}

/// An exact t, computed on first use.
pub(super) struct ExactT {
    compute: Box<dyn Fn() -> Algebraic>,
    known: OnceCell<Algebraic>,
}

impl ExactT {
    pub fn new(compute: impl Fn() -> Algebraic + 'static) -> Self {
        Self {
            compute: Box::new(compute),
            known: OnceCell::new(),
        }
    }

    fn get(&self) -> &Algebraic {
        self.known.get_or_init(|| (self.compute)())
    }
}

impl RankedHit {
    /// The same with another hit at the same t.
    pub(crate) fn with_hit(self, change: impl FnOnce(Hit) -> Hit) -> Self {
        Self {
            hit: change(self.hit),
            ..self
        }
    }

    /// t, rounded to f64; correctly if the kernel is exact.
    pub(crate) fn t_in_f64(&self) -> f64 {
        match &self.exact {
            Some(exact) if self.t[0] != self.t[1] => exact.get().clone().nearest_f64(),
            _ => self.t[0],
        }
    }

    /// Whether t lies in the ray's open interval.
    pub(crate) fn is_in_interval(&self, ray: &Ray) -> bool {
        let [start, end] = ray.finite_interval().map(f64::from);
        let [low, high] = self.t;
        match &self.exact {
            _ if start < low && high < end => true,
            _ if high <= start || end <= low => false,
            Some(exact) => is_between(exact.get(), [start, end]),
            None => false,
        }
    }

    /// An upper bound of t for hits that could precede this one.
    pub(crate) fn t_bound(&self, ray: &Ray) -> f32 {
        self.hit.t.next_up().min(ray.t_max)
    }

    /// Compares by t.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        match (&self.exact, &other.exact) {
            _ if self.t[1] < other.t[0] => Ordering::Less,
            _ if self.t[0] > other.t[1] => Ordering::Greater,
            (Some(exact), Some(other)) => exact.get().compare(other.get()),
            _ => self.t[0].total_cmp(&other.t[0]),
        }
    }

    /// Whether it precedes another hit: by t, then by primitive.
    pub(crate) fn is_before(&self, other: &Self) -> bool {
        let order: Comparison<bool> = self.compare(other).into();
        precedes(order, order, self.hit.primitive < other.hit.primitive)
    }
}

/// The hits as crossings, ordered by t. Hits at equal t form one crossing, ordered by primitive.
pub(crate) fn crossings_of(mut hits: Vec<RankedHit>) -> Vec<Crossing> {
    hits.sort_by(|a, b| {
        let by_t = a.compare(b);
        by_t.then(a.hit.primitive.cmp(&b.hit.primitive))
    });
    hits.chunk_by(|a, b| a.compare(b).is_eq())
        .map(|equal| Crossing {
            hit: equal[0].hit,
            also: equal[1..].iter().map(|other| other.hit.primitive).collect(),
        })
        .collect()
}

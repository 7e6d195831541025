//! A contestant's totals over all cases of a shape.

use crate::measure::shapes::ShapeCell;
use crate::measure::statistics::{Quantiles, per_million, short};
use crate::measure::triangles::TriangleCell;
use serde::Serialize;

/// The figures of one contestant in one case.
#[derive(Clone, Copy)]
pub(super) struct Figures {
    n: u64,
    hits: u64,
    missed: u64,
    false_hits: u64,
    t_ulps: Option<Quantiles>,
    /// Of triangles alone.
    barycentric_error: Option<Quantiles>,
    /// Hits with numbers that aren't finite; counted for triangles alone.
    non_finite: Option<u64>,
}

impl From<&TriangleCell> for Figures {
    fn from(cell: &TriangleCell) -> Self {
        Self {
            n: cell.n,
            hits: cell.hits,
            missed: cell.missed,
            false_hits: cell.false_hits,
            t_ulps: cell.t_ulps,
            barycentric_error: cell.barycentric_error,
            non_finite: Some(cell.non_finite),
        }
    }
}

impl From<&ShapeCell> for Figures {
    fn from(cell: &ShapeCell) -> Self {
        Self {
            n: cell.n,
            hits: cell.hits,
            missed: cell.missed,
            false_hits: cell.false_hits,
            t_ulps: cell.t_ulps,
            barycentric_error: None,
            non_finite: None,
        }
    }
}

impl Figures {
    /// A cell such as `250 · 14`: wrong decisions per million, and the 99th percentile of the error of t in ulps.
    pub(super) fn text(&self) -> String {
        let wrong = short(per_million(self.missed + self.false_hits, self.n));
        match self.t_ulps {
            Some(t) => format!("{wrong} · {}", short(t.p99)),
            None => format!("{wrong} · –"),
        }
    }
}

/// A contestant's totals over all cases of single primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Accuracy {
    n: u64,
    hits: u64,
    missed: u64,
    false_hits: u64,
    wrong_per_million: f64,
    /// The 99th percentile and the maximum of the worst case.
    t_ulps_p99: Option<f64>,
    t_ulps_max: Option<f64>,
    barycentric_max: Option<f64>,
    non_finite: Option<u64>,
}

impl Accuracy {
    /// `None` if there is no case.
    pub(super) fn of(cases: impl Iterator<Item = Figures>) -> Option<Self> {
        let mut sum = Self::default();
        let larger = |sum: &mut Option<f64>, x: f64| *sum = Some(sum.unwrap_or(0.0).max(x));
        for case in cases {
            sum.n += case.n;
            sum.hits += case.hits;
            sum.missed += case.missed;
            sum.false_hits += case.false_hits;
            if let Some(count) = case.non_finite {
                sum.non_finite = Some(sum.non_finite.unwrap_or(0) + count);
            }
            if let Some(t) = case.t_ulps {
                larger(&mut sum.t_ulps_p99, t.p99);
                larger(&mut sum.t_ulps_max, t.max);
            }
            if let Some(weights) = case.barycentric_error {
                larger(&mut sum.barycentric_max, weights.max);
            }
        }
        sum.wrong_per_million = per_million(sum.missed + sum.false_hits, sum.n);
        (sum.n > 0).then_some(sum)
    }
}

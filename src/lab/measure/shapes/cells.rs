//! Errors of a shape's kernels in one case.

use super::samples::Sampled;
use crate::measure::contestants::contestants;
use crate::measure::statistics::{Quantiles, bound_per_million, per_million};
use crate::oracle::ExactT;
use hitscope_core::random::Random;
use hitscope_core::ray::ulp_at;
use hitscope_core::{Hit, Ray};
use serde::Serialize;

/// The result of one kernel in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeCell {
    /// The case.
    pub case: String,
    /// The shape.
    pub shape: &'static str,
    /// The kernel, or the lecture's program.
    pub kernel: &'static str,
    /// Number of rays.
    pub n: u64,
    /// Rays that hit, according to the oracle.
    pub hits: u64,
    /// Hits that the kernel missed.
    pub missed: u64,
    /// The same per million.
    pub missed_per_million: f64,
    /// False hits.
    pub false_hits: u64,
    /// The same per million.
    pub false_per_million: f64,
    /// The upper bound of either, with 95 % confidence, if there are none.
    pub bound_per_million: f64,
    /// Errors of t where both hit, in f32 ulps.
    pub t_ulps: Option<Quantiles>,
    /// Errors of the hit's distance along the ray where both hit, relative to the size of the primitive.
    pub error_in_sizes: Option<Quantiles>,
}

impl ShapeCell {
    /// Number of wrong decisions.
    pub fn wrong(&self) -> u64 {
        self.missed + self.false_hits
    }
}

#[derive(Default)]
struct Counts {
    missed: u64,
    false_hits: u64,
    t_ulps: Vec<f64>,
    errors: Vec<f64>,
}

/// The answers to one ray.
pub(super) struct Answers {
    /// The exact t of the first crossing.
    pub t: Option<f64>,
    /// The length of the ray's direction in sizes of the primitive.
    pub length: f64,
    /// The hit of each contestant.
    pub hits: Vec<Option<Hit>>,
}

/// Measures all contestants with the same `n` rays at primitives of a shape.
pub(super) fn measure_shape<S: Sampled>(
    case: &str,
    sample: &dyn Fn(&mut Random) -> (Ray, S),
    n: u64,
    seed: u64,
) -> Vec<ShapeCell> {
    let contestants = contestants::<S>();
    let names: Vec<&'static str> = contestants.iter().map(|each| each.name()).collect();
    let answers = |random: &mut Random| {
        let (ray, shape) = sample(random);
        let contestants = contestants.iter();
        Answers {
            t: shape.crossings(&ray).first_mut().map(ExactT::to_f64),
            length: f64::from(ray.dir.length()) / shape.size(),
            hits: contestants
                .map(|contestant| contestant.intersect(&ray, shape.clone()))
                .collect(),
        }
    };
    measure(case, (S::INFO.name, &names), answers, n, seed)
}

/// Measures contestants with these names, whose answers to a random ray `answers` returns in the same order.
pub(super) fn measure(
    case: &str,
    (shape, names): (&'static str, &[&'static str]),
    mut answers: impl FnMut(&mut Random) -> Answers,
    n: u64,
    seed: u64,
) -> Vec<ShapeCell> {
    let mut random = Random::new(seed);
    let mut counts: Vec<Counts> = names.iter().map(|_| Counts::default()).collect();
    let mut hits = 0;
    for _ in 0..n {
        let answers = answers(&mut random);
        hits += u64::from(answers.t.is_some());
        for (hit, counts) in answers.hits.into_iter().zip(&mut counts) {
            counts.add(hit, answers.t, answers.length);
        }
    }
    let cells = names.iter().zip(counts);
    cells
        .map(|(kernel, counts)| ShapeCell {
            case: case.to_owned(),
            shape,
            kernel,
            n,
            hits,
            missed: counts.missed,
            missed_per_million: per_million(counts.missed, n),
            false_hits: counts.false_hits,
            false_per_million: per_million(counts.false_hits, n),
            bound_per_million: bound_per_million(n),
            t_ulps: Quantiles::of(counts.t_ulps),
            error_in_sizes: Quantiles::of(counts.errors),
        })
        .collect()
}

impl Counts {
    /// Compares a hit with the exact t. `length` is that of the direction in sizes of the primitive.
    fn add(&mut self, found: Option<Hit>, t: Option<f64>, length: f64) {
        match (found, t) {
            (None, None) => {}
            (None, Some(_)) => self.missed += 1,
            (Some(_), None) => self.false_hits += 1,
            (Some(hit), Some(t)) => {
                let error = (f64::from(hit.t) - t).abs();
                self.t_ulps.push(error / ulp_at(t));
                self.errors.push(error * length);
            }
        }
    }
}

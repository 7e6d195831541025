//! How often, and by how much, is a kernel wrong about one triangle?

use super::cases::Case;
use super::contestants::Contestant;
use super::statistics::Quantiles;
use crate::oracle::{self, ExactHit};
use hitscope_core::Hit;
use hitscope_core::random::Random;
use hitscope_core::ray::ulp_at;
use serde::Serialize;

/// One contestant in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriangleCell {
    /// The case.
    pub case: String,
    /// The contestant.
    pub kernel: &'static str,
    /// Rays.
    pub n: u64,
    /// Of these, those that hit, exactly.
    pub hits: u64,
    /// Of these, those that the kernel missed.
    pub missed: u64,
    /// Hits that the kernel reported and that aren't.
    pub false_hits: u64,
    /// Answers with a NaN or an infinity.
    pub non_finite: u64,
    /// Errors of t where both hit, in ulps of f32.
    pub t_ulps: Option<Quantiles>,
    /// The largest error of a weight of each, likewise.
    pub barycentric_error: Option<Quantiles>,
}

impl TriangleCell {
    /// Wrong decisions.
    pub fn wrong(&self) -> u64 {
        self.missed + self.false_hits
    }
}

/// What has been counted of a contestant so far.
#[derive(Default)]
struct Tally {
    missed: u64,
    false_hits: u64,
    non_finite: u64,
    t_ulps: Vec<f64>,
    barycentric_errors: Vec<f64>,
}

/// The answer that a hit is held against, rounded once.
struct Answer {
    t: f64,
    /// What an ulp of f32 is at t.
    ulp: f64,
    barycentric: [f64; 3],
}

/// Asks every contestant about the same `n` rays.
pub fn measure(case: &Case, contestants: &[Contestant], n: u64, seed: u64) -> Vec<TriangleCell> {
    let mut random = Random::new(seed);
    let mut tallies: Vec<Tally> = contestants.iter().map(|_| Tally::default()).collect();
    let mut hits = 0;
    for _ in 0..n {
        let (ray, corners) = case.sample(&mut random);
        let answer = oracle::intersect(&ray, corners).map(|exact| Answer::of(&exact));
        hits += u64::from(answer.is_some());
        for (contestant, tally) in contestants.iter().zip(&mut tallies) {
            tally.add(contestant.intersect(&ray, corners), answer.as_ref());
        }
    }
    let cells = contestants.iter().zip(tallies);
    cells
        .map(|(contestant, tally)| TriangleCell {
            case: case.name.clone(),
            kernel: contestant.name(),
            n,
            hits,
            missed: tally.missed,
            false_hits: tally.false_hits,
            non_finite: tally.non_finite,
            t_ulps: Quantiles::of(tally.t_ulps),
            barycentric_error: Quantiles::of(tally.barycentric_errors),
        })
        .collect()
}

impl Answer {
    fn of(exact: &ExactHit) -> Self {
        Self {
            t: exact.t.to_f64(),
            ulp: ulp_at(exact.t.to_f64()),
            barycentric: exact.barycentric.each_ref().map(oracle::Fraction::to_f64),
        }
    }
}

impl Tally {
    fn add(&mut self, found: Option<Hit>, answer: Option<&Answer>) {
        let is_finite = |hit: &Hit| hit.t.is_finite() && hit.u.is_finite() && hit.v.is_finite();
        match (found, answer) {
            (None, None) => {}
            (None, Some(_)) => self.missed += 1,
            (Some(hit), answer) if !is_finite(&hit) => {
                self.non_finite += 1;
                self.false_hits += u64::from(answer.is_none());
            }
            (Some(_), None) => self.false_hits += 1,
            (Some(hit), Some(answer)) => {
                self.t_ulps
                    .push((f64::from(hit.t) - answer.t).abs() / answer.ulp);
                let error = hit.weight_error(answer.barycentric);
                self.barycentric_errors.push(error);
            }
        }
    }
}

//! Errors of kernels for single triangles.

use super::cases::Case;
use super::contestants::Contestant;
use super::statistics::Quantiles;
use crate::oracle::{self, ExactHit};
use glam::Vec3;
use hitscope_core::random::Random;
use hitscope_core::ray::ulp_at;
use hitscope_core::{Hit, Ray};
use serde::Serialize;

/// The result of one contestant in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriangleCell {
    /// The case.
    pub case: String,
    /// The contestant.
    pub kernel: &'static str,
    /// Number of rays.
    pub n: u64,
    /// Rays that hit, according to the oracle.
    pub hits: u64,
    /// Hits that the kernel missed.
    pub missed: u64,
    /// False hits.
    pub false_hits: u64,
    /// Hits with a NaN or an infinity.
    pub non_finite: u64,
    /// Errors of t where both hit, in f32 ulps.
    pub t_ulps: Option<Quantiles>,
    /// Each ray's largest error of a barycentric coordinate, where both hit.
    pub barycentric_error: Option<Quantiles>,
    /// Distance between o + t·d and the point by the kernel's barycentric coordinates, where both hit,
    /// relative to the largest coordinate of the ray's origin and the corners.
    pub gap: Option<Quantiles>,
}

impl TriangleCell {
    /// Number of wrong decisions.
    pub fn wrong(&self) -> u64 {
        self.missed + self.false_hits
    }
}

/// Counts of one contestant.
#[derive(Default)]
struct ContestantCounts {
    missed: u64,
    false_hits: u64,
    non_finite: u64,
    t_ulps: Vec<f64>,
    barycentric_errors: Vec<f64>,
    gaps: Vec<f64>,
}

/// The exact hit, rounded once, with which a kernel's hit is compared.
struct Answer {
    t: f64,
    /// The f32 ulp at t.
    ulp: f64,
    barycentric: [f64; 3],
}

/// Measures all contestants with the same `n` rays.
pub fn measure(case: &Case, contestants: &[Contestant], n: u64, seed: u64) -> Vec<TriangleCell> {
    let mut random = Random::new(seed);
    let mut tallies: Vec<ContestantCounts> = contestants
        .iter()
        .map(|_| ContestantCounts::default())
        .collect();
    let mut hits = 0;
    for _ in 0..n {
        let (ray, corners) = case.sample(&mut random);
        let answer = oracle::intersect(&ray, corners).map(|exact| Answer::of(&exact));
        hits += u64::from(answer.is_some());
        for (contestant, tally) in contestants.iter().zip(&mut tallies) {
            let found = contestant.intersect(&ray, corners);
            if let (Some(hit), Some(_)) = (found, &answer) {
                // Non-finite results are counted separately.
                let gap = Some(gap(&ray, corners, &hit));
                tally.gaps.extend(gap.filter(|gap| gap.is_finite()));
            }
            tally.add(found, answer.as_ref());
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
            gap: Quantiles::of(tally.gaps),
        })
        .collect()
}

/// See [`TriangleCell::gap`].
fn gap(ray: &Ray, corners: [Vec3; 3], hit: &Hit) -> f64 {
    let origin = ray.origin.as_dvec3();
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (t, u, v) = (f64::from(hit.t), f64::from(hit.u), f64::from(hit.v));
    let by_weights = a + u * (b - a) + v * (c - a);
    let along_ray = origin + t * ray.dir.as_dvec3();
    let farthest = [a, b, c].map(|p| p.abs().max_element());
    let unit = farthest
        .into_iter()
        .fold(origin.abs().max_element(), f64::max);
    (by_weights - along_ray).length() / unit
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

impl ContestantCounts {
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

//! Random choice by inverting a cumulative distribution. Unlike an alias table, it keeps well-spread numbers well spread.
//!
//! Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, 2.3.

/// Chooses an index with a probability about proportional to its weight.
///
/// Probabilities are multiples of about 2⁻³². [`probability`](Self::probability) returns exactly those with which
/// [`sample`](Self::sample) chooses, and those of positive weights are positive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cumulative {
    /// Where the interval of each index ends; it begins where the one before ends.
    ends: Vec<u32>,
}

impl Cumulative {
    /// A distribution of finite weights that aren't negative; at most 2³¹ of them.
    pub fn new(weights: &[f64]) -> Self {
        let sum: f64 = weights.iter().sum();
        let positive_count = weights.iter().filter(|&&w| w > 0.0).count();
        // Each positive weight gets one unit, and its share of the others.
        let shared = f64::from(u32::MAX) - positive_count as f64;
        let (mut partial_sum, mut units) = (0.0, 0);
        let end = |&weight: &f64| {
            if weight > 0.0 {
                partial_sum += weight;
                units += 1;
            }
            let share = if units > 0 { partial_sum / sum } else { 0.0 };
            (share * shared) as u32 + units
        };
        Self {
            ends: weights.iter().map(end).collect(),
        }
    }

    /// An index for a uniform number in [0, 1), and where the number lies in the index's interval, from 0 to 1. `None` if
    /// all weights are 0.
    pub fn sample(&self, at: f64) -> Option<(usize, f64)> {
        let total = self.total();
        if total == 0 {
            return None;
        }
        let at = (at * f64::from(total)).min(f64::from(total - 1) + 0.999);
        let unit = at as u32;
        let index = self.ends.partition_point(|&end| end <= unit);
        let (start, end) = self.interval(index);
        let within = (at - f64::from(start)) / f64::from(end - start);
        Some((index, within.clamp(0.0, 1.0)))
    }

    /// The probability of an index; 0 if all weights are 0.
    pub fn probability(&self, index: usize) -> f64 {
        let (start, end) = self.interval(index);
        f64::from(end - start) / f64::from(self.total().max(1))
    }

    fn total(&self) -> u32 {
        self.ends.last().copied().unwrap_or(0)
    }

    fn interval(&self, index: usize) -> (u32, u32) {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        (start, self.ends[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_index_is_chosen_as_often_as_its_weight_says() {
        let weights = [3.0, 0.0, 1.0, 4.0, 0.0];
        let chosen = Cumulative::new(&weights);
        const N: u32 = 1 << 16;
        let mut counts = [0.0; 5];
        for k in 0..N {
            let at = (f64::from(k) + 0.5) / f64::from(N);
            let (index, within) = chosen.sample(at).expect("weights");
            assert!((0.0..=1.0).contains(&within));
            counts[index] += 1.0;
        }
        for (index, weight) in weights.into_iter().enumerate() {
            // The ends of an interval are rounded to one of N numbers.
            let expected = weight / 8.0;
            assert!((counts[index] / f64::from(N) - expected).abs() <= 2.0 / f64::from(N));
            assert!((chosen.probability(index) - expected).abs() < 1e-8);
        }
    }

    #[test]
    fn a_positive_weight_has_a_positive_probability_and_a_zero_weight_has_none() {
        let chosen = Cumulative::new(&[0.0, 1e30, 0.0, 1e-30, 0.0]);
        let probabilities = [0, 1, 2, 3, 4].map(|k| chosen.probability(k));
        assert_eq!(
            probabilities.map(|p| p > 0.0),
            [false, true, false, true, false]
        );
        // Each of two quotients is rounded.
        assert!((probabilities.iter().sum::<f64>() - 1.0).abs() <= f64::EPSILON);
        let last = chosen.sample(1.0).expect("weights");
        assert_eq!(last.0, 3);
    }

    #[test]
    fn without_a_positive_weight_nothing_is_chosen() {
        for weights in [vec![], vec![0.0, 0.0]] {
            assert_eq!(Cumulative::new(&weights).sample(0.5), None);
        }
        assert_eq!(Cumulative::new(&[0.0]).probability(0), 0.0);
    }
}

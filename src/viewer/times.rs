//! The most recent times of a repeated operation, and their quantiles.

use std::collections::VecDeque;
use std::time::Duration;

/// The most recent times of a repeated operation.
#[derive(Debug, Default)]
pub struct Times(VecDeque<Duration>);

impl Times {
    /// Number of times kept; several of them are above the 99th percentile.
    const KEPT: usize = 500;

    /// Adds a time and drops the oldest if there are too many.
    pub fn push(&mut self, time: Duration) {
        if self.0.len() == Self::KEPT {
            self.0.pop_front();
        }
        self.0.push_back(time);
    }

    /// Drops all times.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Quantiles at the given fractions from 0 to 1; `None` if there are no times.
    fn quantiles<const N: usize>(&self, parts: [f64; N]) -> Option<[Duration; N]> {
        let mut sorted: Vec<Duration> = self.0.iter().copied().collect();
        sorted.sort_unstable();
        let at = |part: f64| (part * sorted.len() as f64).ceil() as usize;
        (!sorted.is_empty()).then(|| parts.map(|part| sorted[at(part).saturating_sub(1)]))
    }

    /// Median and 99th percentile.
    pub fn median_and_99th(&self) -> Option<[Duration; 2]> {
        self.quantiles([0.5, 0.99])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_added_times() {
        let mut times = Times::default();
        assert_eq!(times.quantiles([0.5]), None);
        for ms in (1..=100).rev() {
            times.push(Duration::from_millis(ms));
        }
        let ms = |part: f64| times.quantiles([part]).map(|[time]| time.as_millis());
        assert_eq!(
            (ms(0.0), ms(0.5), ms(0.99), ms(1.0)),
            (Some(1), Some(50), Some(99), Some(100))
        );
    }

    #[test]
    fn the_oldest_times_are_dropped() {
        let mut times = Times::default();
        times.push(Duration::from_secs(9));
        (0..Times::KEPT).for_each(|_| times.push(Duration::from_secs(1)));
        assert_eq!(times.quantiles([1.0]), Some([Duration::from_secs(1)]));
    }
}

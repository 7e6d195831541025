//! A stopwatch for the wall-clock time of refinement.

use std::time::{Duration, Instant};

/// The wall-clock time during which it ran.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stopwatch {
    before: Duration,
    since: Option<Instant>,
}

impl Stopwatch {
    /// Starts or stops the stopwatch.
    pub fn run(&mut self, is_running: bool) {
        if !is_running {
            (self.before, self.since) = (self.elapsed(), None);
        } else if self.since.is_none() {
            self.since = Some(Instant::now());
        }
    }

    /// The time so far.
    pub fn elapsed(&self) -> Duration {
        self.before + self.since.map_or(Duration::ZERO, |since| since.elapsed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_counts_the_time_during_which_it_runs() {
        const STEP: Duration = Duration::from_millis(20);
        let mut watch = Stopwatch::default();
        assert_eq!(watch.elapsed(), Duration::ZERO);
        watch.run(true);
        std::thread::sleep(STEP);
        watch.run(true);
        watch.run(false);
        let stopped = watch.elapsed();
        assert!(stopped >= STEP);
        std::thread::sleep(STEP);
        assert_eq!(watch.elapsed(), stopped);
        watch.run(true);
        std::thread::sleep(STEP);
        assert!(watch.elapsed() >= stopped + STEP);
    }
}

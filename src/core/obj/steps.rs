//! The time that each step of a load takes.

use std::time::{Duration, Instant};

/// Wall-clock times of the steps of a load, in the order in which the steps first began.
#[derive(Clone, Debug, Default)]
pub struct LoadSteps(Vec<(&'static str, Duration)>);

impl LoadSteps {
    /// The names of the steps and their times.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Duration)> {
        self.0.iter().copied()
    }

    /// Runs a part of a step and adds its time to the step's.
    pub(super) fn time<T>(&mut self, step: &'static str, part: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = part();
        let duration = start.elapsed();
        match self.0.iter_mut().find(|(name, _)| *name == step) {
            Some((_, sum)) => *sum += duration,
            None => self.0.push((step, duration)),
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_step_are_added() {
        let mut steps = LoadSteps::default();
        assert_eq!(steps.time("a", || 1), 1);
        steps.time("b", || ());
        steps.time("a", || std::thread::sleep(Duration::from_millis(2)));
        let names: Vec<_> = steps.iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["a", "b"]);
        assert!(steps.iter().next().expect("two").1 >= Duration::from_millis(2));
    }
}

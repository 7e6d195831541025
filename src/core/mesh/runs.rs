//! Run-length encoded numbers per triangle.

/// One number per triangle, stored as runs of equal numbers; 0 before the first run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs {
    /// The first triangle of each run, in ascending order, and the run's number.
    runs: Vec<(u32, u32)>,
}

impl Runs {
    /// Starts a run at `triangle`. Runs must start in ascending order; a later run at the same triangle replaces the
    /// earlier one.
    pub fn begin(&mut self, triangle: u32, number: u32) {
        let is_later = |&(first, _): &(u32, u32)| first <= triangle;
        assert!(self.runs.last().is_none_or(is_later), "begun before");
        // Remove a run without triangles.
        if self
            .runs
            .last()
            .is_some_and(|(first, _)| *first == triangle)
        {
            self.runs.pop();
        }
        let last = self.runs.last().map_or(0, |(_, number)| *number);
        if number != last {
            self.runs.push((triangle, number));
        }
    }

    /// The number of a triangle.
    pub fn of(&self, triangle: u32) -> u32 {
        let run = self.runs.partition_point(|(first, _)| *first <= triangle);
        run.checked_sub(1).map_or(0, |run| self.runs[run].1)
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.runs[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_triangle_has_its_runs_number() {
        let mut runs = Runs::default();
        for (triangle, number) in [(0, 0), (2, 5), (3, 5), (4, 1), (4, 7), (6, 3), (6, 7)] {
            runs.begin(triangle, number);
        }
        let numbers: Vec<u32> = (0..8).map(|triangle| runs.of(triangle)).collect();
        assert_eq!(numbers, [0, 0, 5, 5, 7, 7, 7, 7]);
        assert_eq!(runs.bytes(), 2 * 8);
    }
}

//! A list that is read in parts, one per chunk, which are joined in parallel in the end.

use rayon::prelude::*;

/// The parts of a list, in file order.
pub(super) struct ListParts<T> {
    parts: Vec<Vec<T>>,
    /// The number of entries up to the end of each part.
    ends: Vec<usize>,
}

impl<T> Default for ListParts<T> {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            ends: Vec::new(),
        }
    }
}

impl<T: Copy + Send + Sync> ListParts<T> {
    /// Adds the next part.
    pub(super) fn push(&mut self, mut part: Vec<T>) {
        if !part.is_empty() {
            part.shrink_to_fit();
            self.ends.push(self.count() + part.len());
            self.parts.push(part);
        }
    }

    /// Number of entries.
    pub(super) fn count(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Takes all entries, in file order.
    pub(super) fn join(&mut self) -> Vec<T> {
        let Self { parts, ends } = std::mem::take(self);
        let start_of = |part: usize| part.checked_sub(1).map_or(0, |before| ends[before]);
        let count = ends.last().copied().unwrap_or(0);
        // Each thread copies runs of entries, so it remembers the part that it is in.
        let entry = |part: &mut usize, at: usize| {
            if at < start_of(*part) || at >= ends[*part] {
                *part = ends.partition_point(|&end| end <= at);
            }
            parts[*part][at - start_of(*part)]
        };
        let entries = (0..count).into_par_iter().with_min_len(1 << 12);
        entries.map_init(|| 0, entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_any_length_are_joined_in_their_order() {
        for lengths in [&[][..], &[5], &[0, 3, 0, 1, 9000, 2, 20_000, 0]] {
            let mut list = ListParts::default();
            let mut expected = Vec::new();
            for &length in lengths {
                let first = expected.len();
                list.push((first..first + length).collect());
                expected.extend(first..first + length);
            }
            assert_eq!(list.count(), expected.len());
            assert_eq!(list.join(), expected);
            assert_eq!(list.count(), 0);
        }
    }
}

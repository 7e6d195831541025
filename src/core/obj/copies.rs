//! The vertices that tobj copies.

use crate::mesh::NO_INDEX;

/// tobj copies for each list of faces what it refers to, once a list.
#[derive(Debug)]
pub(super) struct Copies {
    /// At most, in the lists that were ended.
    entries: [usize; 3],
    /// How many corners and elements these have.
    pub corners: [usize; 3],
    pub elements: usize,
    /// The lowest and the highest index since then, of the corners that were looked at.
    ranges: [(u32, u32); 3],
    seen: [usize; 3],
}

impl Default for Copies {
    fn default() -> Self {
        Self {
            entries: [0; 3],
            corners: [0; 3],
            elements: 0,
            ranges: [(u32::MAX, 0); 3],
            seen: [0; 3],
        }
    }
}

impl Copies {
    /// No more than there are corners since the last list, and no more than there are indices in their range.
    fn since(&self, corners: &[Vec<u32>; 3]) -> [usize; 3] {
        std::array::from_fn(|list| {
            let (low, high) = self.ranges[list];
            let range = if low > high {
                0
            } else {
                (high - low) as usize + 1
            };
            range.min(corners[list].len().saturating_sub(self.corners[list]))
        })
    }

    /// Looks at the corners that were added to the lists.
    pub(super) fn look_at(&mut self, corners: &[Vec<u32>; 3]) {
        for ((range, list), seen) in self.ranges.iter_mut().zip(corners).zip(&mut self.seen) {
            let new = list.get(*seen..).unwrap_or_default().iter().copied();
            *seen = list.len();
            for index in new.filter(|&index| index != NO_INDEX) {
                *range = (range.0.min(index), range.1.max(index));
            }
        }
    }

    /// A list is ended that has these corners and, with those before, so many elements.
    pub(super) fn cut(&mut self, corners: &[Vec<u32>; 3], elements: usize) {
        self.look_at(corners);
        let since = self.since(corners);
        *self = Self {
            entries: std::array::from_fn(|list| self.entries[list] + since[list]),
            corners: corners.each_ref().map(Vec::len),
            elements,
            seen: self.seen,
            ..Self::default()
        };
    }

    /// How many entries of each list there are copies of, at most, if all corners were looked at.
    pub(super) fn counts(&self, corners: &[Vec<u32>; 3]) -> [usize; 3] {
        let since = self.since(corners);
        std::array::from_fn(|list| self.entries[list] + since[list])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_no_more_than_corners_and_no_more_than_vertices() {
        let (mut copies, mut lists) = (Copies::default(), [vec![], vec![], vec![]]);
        let mut add = |corners: [u32; 3]| {
            lists[0].extend(corners);
            copies.look_at(&lists);
            copies.counts(&lists)[0]
        };
        assert_eq!(add([0, 1, 2]), 3);
        assert_eq!(add([0, 2, 3]), 4);
        assert_eq!(add([0, 2, 900]), 9);
        copies.cut(&lists, 3);
        assert_eq!(copies.counts(&lists)[0], 9);
        lists[0].extend([5, 6, 7]);
        copies.look_at(&lists);
        assert_eq!(copies.counts(&lists)[0], 12);
    }
}

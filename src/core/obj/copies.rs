//! Counts the vertices that tobj copies.

use crate::mesh::NO_INDEX;

/// Upper bound on tobj's copies: it copies each entry that a list of faces uses once per list.
#[derive(Debug)]
pub(super) struct Copies {
    /// Upper bound on the copies in finished lists.
    entries: [usize; 3],
    /// Number of corners and elements in finished lists.
    pub corners: [usize; 3],
    pub elements: usize,
    /// The lowest and highest index among the corners of the current list examined so far.
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
    /// Copies in the current list: at most its number of corners, and at most the size of its index range.
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

    /// Examines the corners added to the lists.
    pub(super) fn look_at(&mut self, corners: &[Vec<u32>; 3]) {
        for ((range, list), seen) in self.ranges.iter_mut().zip(corners).zip(&mut self.seen) {
            let new = list.get(*seen..).unwrap_or_default().iter().copied();
            *seen = list.len();
            for index in new.filter(|&index| index != NO_INDEX) {
                *range = (range.0.min(index), range.1.max(index));
            }
        }
    }

    /// Ends a list. `corners` are the corners so far, `elements` the number of elements so far.
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

    /// Upper bound on the copies of each list's entries, if all corners were examined.
    pub(super) fn counts(&self, corners: &[Vec<u32>; 3]) -> [usize; 3] {
        let since = self.since(corners);
        std::array::from_fn(|list| self.entries[list] + since[list])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_bounded_by_corners_and_by_vertices() {
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

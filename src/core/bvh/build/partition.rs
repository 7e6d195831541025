//! Partition of primitives at a cut, in place.

use super::split::{CHUNK, Grid, PARALLEL_FROM, WHOLE, union};
use super::{Bounds, Item};
use glam::Vec3A;
use rayon::prelude::*;

/// A test of the side of a cut on which a centre lies.
#[derive(Clone, Copy)]
pub(super) struct Side {
    grid: Grid,
    axis: usize,
    /// [`Grid::shifted_bin`] of the first bin above the cut.
    first_above: f32,
}

impl Side {
    /// The cut below a bin along an axis.
    pub fn new(grid: Grid, axis: usize, first_above: usize) -> Self {
        Self {
            grid,
            axis,
            first_above: WHOLE + first_above as f32,
        }
    }

    /// Moves the items below the cut to the front; returns their number and the boxes around both sides' centres.
    /// Chunks of a large range are partitioned in parallel, then items in the wrong part swap places in parallel.
    /// This depends on the count alone, so the order doesn't depend on the threads.
    pub fn partition(&self, items: &mut [Item]) -> (usize, [Bounds; 2]) {
        if items.len() < PARALLEL_FROM {
            return self.partition_sequentially(items);
        }
        let chunks = items.par_chunks_mut(CHUNK);
        let parts = chunks.map(|chunk| self.partition_sequentially(chunk));
        let parts: Vec<(usize, [Bounds; 2])> = parts.collect();
        let (mut middle, mut centres) = (0, [Bounds::EMPTY; 2]);
        for &(below, [low, high]) in &parts {
            middle += below;
            centres = [union(centres[0], low), union(centres[1], high)];
        }
        let below = parts.into_iter().map(|(below, _)| below);
        exchange(items, middle, below);
        (middle, centres)
    }

    fn partition_sequentially(&self, items: &mut [Item]) -> (usize, [Bounds; 2]) {
        match self.axis {
            0 => self.partition_along::<0>(items),
            1 => self.partition_along::<1>(items),
            _ => self.partition_along::<2>(items),
        }
    }

    /// Without branches that depend on the items: half of them would be mispredicted.
    fn partition_along<const AXIS: usize>(&self, items: &mut [Item]) -> (usize, [Bounds; 2]) {
        let first_above = Vec3A::splat(self.first_above);
        let [mut low, mut high] = [Bounds::EMPTY; 2];
        let mut middle = 0;
        for at in 0..items.len() {
            let centre = self.grid.scale.centre(items[at].bounds());
            let bin = self.grid.shifted_bin(centre)[AXIS];
            let is_below = Vec3A::splat(bin).cmplt(first_above);
            low.lower = Vec3A::select(is_below, low.lower.min(centre), low.lower);
            low.upper = Vec3A::select(is_below, low.upper.max(centre), low.upper);
            high.lower = Vec3A::select(is_below, high.lower, high.lower.min(centre));
            high.upper = Vec3A::select(is_below, high.upper, high.upper.max(centre));
            items.swap(at, middle);
            middle += (is_below.bitmask() & 1) as usize;
        }
        (middle, [low, high])
    }
}

/// Completes a partition: `below` is the number of items at the front of each chunk that belong before `middle`.
fn exchange(items: &mut [Item], middle: usize, below: impl Iterator<Item = usize>) {
    let [mut high, mut low] = [Vec::new(), Vec::new()];
    let mut start = 0;
    for (chunk, below) in items.chunks_mut(CHUNK).zip(below) {
        let count = chunk.len();
        let (front, back) = chunk.split_at_mut(below);
        let misplaced = middle.saturating_sub(start + below).min(back.len());
        high.push(&mut back[..misplaced]);
        let first = middle.saturating_sub(start).min(front.len());
        low.push(&mut front[first..]);
        start += count;
    }
    let pairs = pairs_of(high, low);
    pairs
        .into_par_iter()
        .for_each(|(a, b)| a.swap_with_slice(b));
}

/// Cuts two lists of slices, whose total lengths are equal, into pairs of equal lengths.
fn pairs_of<'a>(
    a: Vec<&'a mut [Item]>,
    b: Vec<&'a mut [Item]>,
) -> Vec<(&'a mut [Item], &'a mut [Item])> {
    let mut pairs = Vec::new();
    let (mut a, mut b) = (a.into_iter(), b.into_iter());
    let [mut left, mut right]: [&mut [Item]; 2] = [&mut [], &mut []];
    loop {
        if left.is_empty() {
            let Some(next) = a.next() else { break };
            left = next;
        } else if right.is_empty() {
            let Some(next) = b.next() else { break };
            right = next;
        } else {
            let count = left.len().min(right.len());
            let (x, more_left) = left.split_at_mut(count);
            let (y, more_right) = right.split_at_mut(count);
            pairs.push((x, y));
            (left, right) = (more_left, more_right);
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::super::split::{Scale, around};
    use super::*;
    use crate::aabb::Aabb;
    use crate::random::Random;
    use glam::Vec3;

    fn scattered(count: usize) -> Vec<Item> {
        let mut random = Random::new(1);
        let mut number = || random.index(1 << 20) as f32;
        let mut item = |index| {
            let p = Vec3::new(number(), number(), number());
            Item::new(Aabb::around([p, p + Vec3::ONE]), index)
        };
        (0..count as u32).map(&mut item).collect()
    }

    #[test]
    fn a_partition_moves_each_item_to_its_side_and_returns_the_boxes_of_both_sides() {
        for count in [1, 2, 100, PARALLEL_FROM, 3 * PARALLEL_FROM + 7] {
            let mut items = scattered(count);
            let scale = Scale::of(around(&items));
            let grid = Grid::new(scale, scale.centres(&items), count);
            for (axis, bin) in [(0, 1), (1, 2), (2, 3), (0, 0), (1, 40)] {
                let (middle, centres) = Side::new(grid, axis, bin).partition(&mut items);
                let is_below = |item: &Item| grid.bins_of(item.bounds())[axis] < bin;
                assert!(items[..middle].iter().all(is_below));
                assert!(!items[middle..].iter().any(is_below));
                let (low, high) = items.split_at(middle);
                let expected = [low, high].map(|side| Aabb::from(scale.centres(side)));
                assert_eq!(centres.map(Aabb::from), expected);
                let mut indices: Vec<u32> = items.iter().map(Item::index).collect();
                indices.sort_unstable();
                assert!(indices.into_iter().eq(0..count as u32));
            }
        }
    }
}

//! Splits a range of primitives in two, by bins along each axis and the surface-area heuristic.

use super::super::{BLOCK_SIZE, LEAF_BLOCKS};
use super::{Bounds, Item, Range};
use glam::Vec3A;
use rayon::prelude::*;

/// Largest number of bins per axis; a power of two.
const BINS: usize = 32;
/// Larger ranges are binned and partitioned by several threads together.
const PARALLEL_FROM: usize = 1 << 15;
/// Primitives per chunk that one thread bins.
const CHUNK: usize = 1 << 13;

/// Power-of-two factor of lengths that keeps areas from over- and underflowing.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    lengths: f32,
    /// Half of `lengths`: a centre is half the sum of two corners.
    centres: f32,
}

impl Scale {
    /// The scale that makes the extent of the box about 1.
    pub fn of(bounds: Bounds) -> Self {
        let (lower, upper) = (bounds.lower.as_dvec3(), bounds.upper.as_dvec3());
        let extent = (upper - lower)
            .max_element()
            .max(f64::from(f32::MIN_POSITIVE));
        // The exponent is taken from the bits: a logarithm may differ between machines.
        let exponent = ((extent.to_bits() >> 52) as i32 - 1023).clamp(-120, 126);
        let lengths = f32::from_bits(((127 - exponent) as u32) << 23);
        Self {
            lengths,
            centres: 0.5 * lengths,
        }
    }

    /// Half a box's surface: its weight in the surface-area heuristic.
    #[inline(always)]
    pub fn half_area(self, bounds: Bounds) -> f32 {
        let e = bounds.upper * self.lengths - bounds.lower * self.lengths;
        e.x * (e.y + e.z) + e.y * e.z
    }

    #[inline(always)]
    fn centre(self, bounds: Bounds) -> Vec3A {
        bounds.lower * self.centres + bounds.upper * self.centres
    }

    /// The box around the centres.
    pub fn centres(self, items: &[Item]) -> Bounds {
        let of = |items: &[Item]| {
            let mut centres = Bounds::EMPTY;
            for item in items {
                centres.grow_to(self.centre(item.bounds()));
            }
            centres
        };
        items
            .par_chunks(CHUNK)
            .map(of)
            .reduce(|| Bounds::EMPTY, union)
    }
}

/// The box around all items.
pub(super) fn around(items: &[Item]) -> Bounds {
    let of = |items: &[Item]| {
        let mut bounds = Bounds::EMPTY;
        for item in items {
            bounds.grow(item.bounds());
        }
        bounds
    };
    items
        .par_chunks(CHUNK)
        .map(of)
        .reduce(|| Bounds::EMPTY, union)
}

fn union(mut a: Bounds, b: Bounds) -> Bounds {
    a.grow(b);
    a
}

impl Bounds {
    #[inline(always)]
    fn grow_to(&mut self, point: Vec3A) {
        self.lower = self.lower.min(point);
        self.upper = self.upper.max(point);
    }
}

/// Floats from here on are integers: a sum with this number rounds to one, and its low bits are the bin.
const WHOLE: f32 = (1 << 23) as f32;

/// Maps centres to bins.
#[derive(Clone, Copy)]
struct Grid {
    scale: Scale,
    bins: usize,
    start: Vec3A,
    /// 0 along an axis in which all centres coincide.
    per_length: Vec3A,
}

impl Grid {
    fn new(scale: Scale, centres: Bounds, count: usize) -> Self {
        let bins = BINS.min(4 + count / 20);
        let extent = centres.upper - centres.lower;
        let per_length = Vec3A::splat(0.99 * bins as f32) / extent;
        Self {
            scale,
            bins,
            start: centres.lower,
            per_length: Vec3A::select(extent.cmpgt(Vec3A::splat(1e-34)), per_length, Vec3A::ZERO),
        }
    }

    /// The bin of a centre along each axis, plus [`WHOLE`].
    #[inline(always)]
    fn shifted_bin(&self, centre: Vec3A) -> Vec3A {
        let place = (centre - self.start) * self.per_length;
        (place - Vec3A::splat(0.5)).max(Vec3A::ZERO) + Vec3A::splat(WHOLE)
    }

    /// The bin of a box along each axis.
    #[inline(always)]
    fn bins_of(&self, bounds: Bounds) -> [usize; 3] {
        let low = |x: f32| x.to_bits() as usize % BINS;
        self.shifted_bin(self.scale.centre(bounds))
            .to_array()
            .map(low)
    }
}

/// The box and the number of the primitives in each bin of each axis.
struct FilledBins {
    bounds: [[Bounds; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl FilledBins {
    const EMPTY: Self = Self {
        bounds: [[Bounds::EMPTY; BINS]; 3],
        counts: [[0; BINS]; 3],
    };

    fn clear(&mut self, bins: usize) {
        for axis in 0..3 {
            self.bounds[axis][..bins].fill(Bounds::EMPTY);
            self.counts[axis][..bins].fill(0);
        }
    }

    fn fill(&mut self, grid: &Grid, items: &[Item]) {
        for item in items {
            let bounds = item.bounds();
            let [x, y, z] = grid.bins_of(bounds);
            self.bounds[0][x].grow(bounds);
            self.bounds[1][y].grow(bounds);
            self.bounds[2][z].grow(bounds);
            self.counts[0][x] += 1;
            self.counts[1][y] += 1;
            self.counts[2][z] += 1;
        }
    }

    fn add(&mut self, other: &Self, bins: usize) {
        for axis in 0..3 {
            for bin in 0..bins {
                self.bounds[axis][bin].grow(other.bounds[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
    }
}

impl FilledBins {
    /// The boxes of the primitives below and above a cut.
    fn sides(&self, cut: &Cut, bins: usize) -> [Bounds; 2] {
        let (below, above) = self.bounds[cut.axis][..bins].split_at(cut.bin);
        [below, above].map(|bins| bins.iter().copied().fold(Bounds::EMPTY, union))
    }
}

/// A plane between two bins.
struct Cut {
    cost: f32,
    axis: usize,
    /// The first bin above the plane.
    bin: usize,
}

/// Splits ranges in two, with bins that are reused from range to range.
pub(super) struct Splitter {
    pub scale: Scale,
    filled: Box<FilledBins>,
}

impl Splitter {
    pub fn new(scale: Scale) -> Self {
        Self {
            scale,
            filled: Box::new(FilledBins::EMPTY),
        }
    }

    /// Splits a range at the cheapest plane, or returns it if a leaf costs no more.
    pub fn split<'a>(&mut self, range: Range<'a>) -> Result<[Range<'a>; 2], Range<'a>> {
        let count = range.items.len();
        let grid = Grid::new(self.scale, range.centres, count);
        self.fill(&grid, range.items);
        let Some(cut) = self.best_cut(&grid) else {
            return Ok(self.halve(range));
        };
        if count <= LEAF_BLOCKS * BLOCK_SIZE {
            let area = self.scale.half_area(range.bounds);
            if area * blocks(count as u32) <= area + cut.cost {
                return Err(range);
            }
        }
        let (middle, centres) = Side::of(&cut, grid).partition(range.items);
        let bounds = self.filled.sides(&cut, grid.bins);
        Ok(halves(range.items, middle, bounds, centres))
    }

    /// Splits a range in its present order into halves of equal count.
    pub fn halve<'a>(&self, range: Range<'a>) -> [Range<'a>; 2] {
        let middle = range.items.len() / 2;
        let (low, high) = range.items.split_at(middle);
        let bounds = [around(low), around(high)];
        let centres = [low, high].map(|items| self.scale.centres(items));
        halves(range.items, middle, bounds, centres)
    }

    fn fill(&mut self, grid: &Grid, items: &[Item]) {
        self.filled.clear(grid.bins);
        if items.len() < PARALLEL_FROM {
            self.filled.fill(grid, items);
            return;
        }
        let fill = |items: &[Item]| {
            let mut filled = Box::new(FilledBins::EMPTY);
            filled.fill(grid, items);
            filled
        };
        let add = |mut a: Box<FilledBins>, b: Box<FilledBins>| {
            a.add(&b, grid.bins);
            a
        };
        let filled = items.par_chunks(CHUNK).map(fill).reduce_with(add);
        if let Some(filled) = filled {
            self.filled = filled;
        }
    }

    /// The cheapest plane between bins along any axis, with costs in blocks times area; `None` if no plane
    /// separates the centres.
    fn best_cut(&self, grid: &Grid) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        let cost = |bounds: Bounds, count: u32| self.scale.half_area(bounds) * blocks(count);
        for axis in 0..3 {
            if grid.per_length[axis] == 0.0 {
                continue;
            }
            let (bounds, counts) = (&self.filled.bounds[axis], &self.filled.counts[axis]);
            let mut above = [f32::INFINITY; BINS];
            let (mut around, mut count) = (Bounds::EMPTY, 0);
            for bin in (1..grid.bins).rev() {
                around.grow(bounds[bin]);
                count += counts[bin];
                if count > 0 {
                    above[bin] = cost(around, count);
                }
            }
            let (mut around, mut count) = (Bounds::EMPTY, 0);
            for bin in 1..grid.bins {
                around.grow(bounds[bin - 1]);
                count += counts[bin - 1];
                if count > 0 && above[bin] < f32::INFINITY {
                    let cost = cost(around, count) + above[bin];
                    if best.as_ref().is_none_or(|best| cost < best.cost) {
                        best = Some(Cut { cost, axis, bin });
                    }
                }
            }
        }
        best
    }
}

fn blocks(count: u32) -> f32 {
    count.div_ceil(BLOCK_SIZE as u32) as f32
}

fn halves<'a>(
    items: &'a mut [Item],
    middle: usize,
    bounds: [Bounds; 2],
    centres: [Bounds; 2],
) -> [Range<'a>; 2] {
    let (first, second) = items.split_at_mut(middle);
    let range = |items, side: usize| Range {
        items,
        bounds: bounds[side],
        centres: centres[side],
    };
    [range(first, 0), range(second, 1)]
}

/// A test of the side of a cut on which a centre lies.
#[derive(Clone, Copy)]
struct Side {
    grid: Grid,
    axis: usize,
    /// [`Grid::shifted_bins_of`] of the first bin above the cut.
    first_above: f32,
}

impl Side {
    fn of(cut: &Cut, grid: Grid) -> Self {
        Self {
            grid,
            axis: cut.axis,
            first_above: WHOLE + cut.bin as f32,
        }
    }

    /// Moves the items below the cut to the front; returns their number and the boxes around both sides' centres.
    /// Chunks of a large range are partitioned in parallel, then items in the wrong part swap places in parallel.
    /// This depends on the count alone, so the order doesn't depend on the threads.
    fn partition(&self, items: &mut [Item]) -> (usize, [Bounds; 2]) {
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

//! Splits a range of primitives in two, by bins along each axis and the surface-area heuristic.

use super::super::BLOCK_SIZE;
use super::partition::Side;
use super::{Bounds, Item, Range};
use glam::Vec3A;
use rayon::prelude::*;

/// Largest number of bins per axis; a power of two.
const BINS: usize = 32;
/// Larger ranges are binned and partitioned by several threads together.
pub(super) const PARALLEL_FROM: usize = 1 << 15;
/// Primitives per chunk that one thread bins or partitions.
pub(super) const CHUNK: usize = 1 << 13;

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
    pub fn centre(self, bounds: Bounds) -> Vec3A {
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

pub(super) fn union(mut a: Bounds, b: Bounds) -> Bounds {
    a.grow(b);
    a
}

impl Bounds {
    #[inline(always)]
    pub fn grow_to(&mut self, point: Vec3A) {
        self.lower = self.lower.min(point);
        self.upper = self.upper.max(point);
    }
}

/// Floats from here on are integers: a sum with this number rounds to one, and its low bits are the bin.
pub(super) const WHOLE: f32 = (1 << 23) as f32;

/// Maps centres to bins.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub scale: Scale,
    bins: usize,
    start: Vec3A,
    /// 0 along an axis in which all centres coincide.
    per_length: Vec3A,
}

impl Grid {
    pub fn new(scale: Scale, centres: Bounds, count: usize) -> Self {
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
    pub fn shifted_bin(&self, centre: Vec3A) -> Vec3A {
        let place = (centre - self.start) * self.per_length;
        (place - Vec3A::splat(0.5)).max(Vec3A::ZERO) + Vec3A::splat(WHOLE)
    }

    /// The bin of a box along each axis.
    #[inline(always)]
    pub fn bins_of(&self, bounds: Bounds) -> [usize; 3] {
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

    /// Splits a range at the cheapest plane.
    pub fn split<'a>(&mut self, range: Range<'a>) -> [Range<'a>; 2] {
        let grid = Grid::new(self.scale, range.centres, range.items.len());
        self.fill(&grid, range.items);
        let Some(cut) = self.best_cut(&grid) else {
            return self.halve(range);
        };
        let (middle, centres) = Side::new(grid, cut.axis, cut.bin).partition(range.items);
        let bounds = self.filled.sides(&cut, grid.bins);
        halves(range.items, middle, bounds, centres)
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

/// The number of blocks that hold this many primitives.
pub(super) fn blocks(count: u32) -> f32 {
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

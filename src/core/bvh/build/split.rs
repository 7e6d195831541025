//! Splits a range of primitives in two, by bins along each axis and the surface-area heuristic.

use super::super::{BLOCK_SIZE, LEAF_BLOCKS};
use super::{Bounds, Item, Range};
use glam::Vec3A;
use rayon::prelude::*;

/// Largest number of bins per axis; a power of two.
const BINS: usize = 32;
/// Larger ranges are binned and partitioned by several threads together.
const PARALLEL_FROM: usize = 1 << 16;
/// Primitives per chunk that one thread bins.
const CHUNK: usize = 1 << 14;

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

    /// The bin of a box along each axis.
    #[inline(always)]
    fn bins_of(&self, bounds: Bounds) -> [usize; 3] {
        // Floats from 2²³ on are integers: the sum rounds to one, and its low bits are the bin.
        const WHOLE: Vec3A = Vec3A::splat((1 << 23) as f32);
        let place = (self.scale.centre(bounds) - self.start) * self.per_length;
        let whole = (place - Vec3A::splat(0.5)).max(Vec3A::ZERO) + WHOLE;
        let [x, y, z] = whole.to_array();
        let low = |x: f32| x.to_bits() as usize % BINS;
        [low(x), low(y), low(z)]
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
        let is_below = |bounds: Bounds| grid.bins_of(bounds)[cut.axis] < cut.bin;
        let (middle, sides) = partition(range.items, self.scale, &is_below);
        Ok(halves(range.items, middle, sides))
    }

    /// Splits a range in its present order into halves of equal count.
    pub fn halve<'a>(&self, range: Range<'a>) -> [Range<'a>; 2] {
        let middle = range.items.len() / 2;
        let (low, high) = range.items.split_at(middle);
        let side = |items: &[Item]| SideBoxes {
            bounds: around(items),
            centres: self.scale.centres(items),
        };
        let sides = [side(low), side(high)];
        halves(range.items, middle, sides)
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

/// The boxes of one side of a cut.
#[derive(Clone, Copy)]
struct SideBoxes {
    bounds: Bounds,
    centres: Bounds,
}

impl SideBoxes {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        centres: Bounds::EMPTY,
    };

    #[inline(always)]
    fn grow(&mut self, bounds: Bounds, scale: Scale) {
        self.bounds.grow(bounds);
        self.centres.grow_to(scale.centre(bounds));
    }

    fn union(mut self, other: Self) -> Self {
        self.bounds.grow(other.bounds);
        self.centres.grow(other.centres);
        self
    }
}

fn halves(items: &mut [Item], middle: usize, [low, high]: [SideBoxes; 2]) -> [Range<'_>; 2] {
    let (first, second) = items.split_at_mut(middle);
    let range = |items, side: SideBoxes| Range {
        items,
        bounds: side.bounds,
        centres: side.centres,
    };
    [range(first, low), range(second, high)]
}

/// Moves the items for which `is_below` holds to the front, in place; returns their number and the boxes of
/// both sides. The halves of a large range are partitioned in parallel, then their middle parts swap places.
/// This depends on the count alone, so the order doesn't depend on the threads.
fn partition(
    items: &mut [Item],
    scale: Scale,
    is_below: &(impl Fn(Bounds) -> bool + Sync),
) -> (usize, [SideBoxes; 2]) {
    if items.len() < PARALLEL_FROM {
        return partition_sequentially(items, scale, is_below);
    }
    let half = items.len() / 2;
    let (first, second) = items.split_at_mut(half);
    let ((low, [a, b]), (low_too, [c, d])) = rayon::join(
        || partition(first, scale, is_below),
        || partition(second, scale, is_below),
    );
    // Low, high, low, high: swap the second run with the third, as far as both go.
    let moved = (half - low).min(low_too);
    let (front, back) = items.split_at_mut(half);
    front[low..low + moved].swap_with_slice(&mut back[low_too - moved..low_too]);
    (low + low_too, [a.union(c), b.union(d)])
}

fn partition_sequentially(
    items: &mut [Item],
    scale: Scale,
    is_below: &impl Fn(Bounds) -> bool,
) -> (usize, [SideBoxes; 2]) {
    let [mut low, mut high] = [SideBoxes::EMPTY; 2];
    let (mut start, mut end) = (0, items.len());
    loop {
        while start < end {
            let bounds = items[start].bounds();
            if !is_below(bounds) {
                break;
            }
            low.grow(bounds, scale);
            start += 1;
        }
        while start < end {
            let bounds = items[end - 1].bounds();
            if is_below(bounds) {
                break;
            }
            high.grow(bounds, scale);
            end -= 1;
        }
        if start == end {
            return (start, [low, high]);
        }
        items.swap(start, end - 1);
    }
}

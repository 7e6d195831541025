//! The order in which pixels and samples are traced.
//!
//! The first pass traces one pixel per block, the following ones use smaller blocks until every pixel has its
//! centre sample; later passes double the number of samples, or add [`MAX_SAMPLES_PER_PASS`]. No sample is traced twice.
//!
//! ```text
//! step 4          step 2          step 1
//! · · · ·         · · · ·         x x x x
//! · · · ·         · x · x         x · x ·      · sampled in this pass: x
//! · · x ·         · · · ·         x x · x
//! · · · ·         · x · x         x · x ·
//! ```

use crate::sampler::sample_position;
use glam::{UVec2, Vec2};
use std::ops::Range;

/// Width and height of a tile in pixels; a multiple of every block size.
pub const TILE_PX: u32 = 48;
/// Block sizes, in pixels.
pub const STEPS: [u32; 8] = [1, 2, 3, 4, 6, 8, 12, 16];
/// Width and height, in blocks, of the groups of blocks that are traced one after another.
const GROUP: u32 = 4;
/// Maximum number of samples per pixel.
pub const MAX_SAMPLES: u32 = 65536;
/// Maximum number of samples that a pass adds to a pixel, so that tiles of late passes don't take long.
pub const MAX_SAMPLES_PER_PASS: u32 = 64;

/// A rectangle of pixels; `max` is exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// Left and top edge.
    pub min: UVec2,
    /// Right and bottom edge, exclusive.
    pub max: UVec2,
}

impl PixelRect {
    /// All pixels of a picture of this size.
    pub const fn whole(size: UVec2) -> Self {
        Self {
            min: UVec2::ZERO,
            max: size,
        }
    }

    /// The top left pixels of its blocks of `step` × `step` pixels, in groups of [`GROUP`] × [`GROUP`] blocks.
    pub(crate) fn blocks(self, step: u32) -> impl Iterator<Item = UVec2> {
        let starts = move |from: u32, to: u32| (from..to).step_by((GROUP * step) as usize);
        let groups = starts(self.min.y, self.max.y)
            .flat_map(move |y| starts(self.min.x, self.max.x).map(move |x| UVec2::new(x, y)));
        groups
            .flat_map(move |group| {
                (0..GROUP * GROUP).map(move |k| group + UVec2::new(k % GROUP, k / GROUP) * step)
            })
            .filter(move |corner| corner.cmplt(self.max).all())
    }

    /// The number of its blocks of `step` × `step` pixels across and down.
    pub fn block_count(self, step: u32) -> UVec2 {
        (self.max - self.min + (step - 1)) / step
    }

    /// The index of a pixel's block in the order of [`blocks`](Self::blocks).
    fn block_index(self, step: u32, pixel: UVec2) -> usize {
        let count = self.block_count(step);
        let block = (pixel - self.min) / step;
        let group = block / GROUP * GROUP;
        let size = (count - group).min(UVec2::splat(GROUP));
        let in_group = block - group;
        let before = group.y * count.x + group.x * size.y;
        (before + in_group.y * size.x + in_group.x) as usize
    }

    /// The smallest rectangle around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// One pass over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// One pixel of each block of `step` × `step` pixels, unless an earlier pass traced it.
    Lattice {
        /// Block size in pixels.
        step: u32,
    },
    /// The samples `first..first + count` of every pixel.
    Samples {
        /// Index of the first sample.
        first: u32,
        /// Number of samples.
        count: u32,
    },
}

impl Pass {
    /// Size in pixels of the blocks of which the pass traces at most one pixel.
    pub(crate) fn step(self) -> u32 {
        match self {
            Self::Lattice { step } => step,
            Self::Samples { .. } => 1,
        }
    }

    /// Number of samples that the pass adds to each of its pixels.
    pub fn samples_per_pixel(self) -> u32 {
        match self {
            Self::Lattice { .. } => 1,
            Self::Samples { count, .. } => count,
        }
    }

    /// Indices of the samples that the pass adds to each of its pixels.
    pub fn samples(self) -> Range<u32> {
        match self {
            Self::Lattice { .. } => 0..1,
            Self::Samples { first, count } => first..first + count,
        }
    }
}

/// A unit of work: one tile of one pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkUnit {
    /// Index of the pass.
    pub pass: usize,
    /// Index of the tile, in rows from the top left.
    pub tile: usize,
}

/// All passes over a picture, or over some of its rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    size: UVec2,
    /// The row of the whole picture at which the plan begins.
    first_row: u32,
    passes: Vec<Pass>,
}

impl Plan {
    /// A plan for a picture of `size` pixels. The first pass uses blocks of `first_step` pixels, rounded up to one
    /// of [`STEPS`]. The last one ends with `samples` per pixel, rounded up to a power of two and limited to
    /// [`MAX_SAMPLES`].
    pub fn new(size: UVec2, first_step: u32, samples: u32) -> Self {
        let last = STEPS[STEPS.len() - 1];
        let mut step = STEPS.into_iter().find(|&s| s >= first_step).unwrap_or(last);
        let mut passes = vec![Pass::Lattice { step }];
        while step > 1 {
            step /= if step % 2 == 0 { 2 } else { 3 };
            passes.push(Pass::Lattice { step });
        }
        let samples = samples.clamp(1, MAX_SAMPLES).next_power_of_two();
        let mut first = 1;
        while first < samples {
            let count = first.min(MAX_SAMPLES_PER_PASS);
            passes.push(Pass::Samples { first, count });
            first += count;
        }
        Self {
            size,
            first_row: 0,
            passes,
        }
    }

    /// The plan of some rows as a picture of their own, with the same samples as in the whole picture.
    #[must_use]
    pub fn of_rows(&self, rows: Range<u32>) -> Self {
        Self {
            size: UVec2::new(self.size.x, rows.end - rows.start),
            first_row: self.first_row + rows.start,
            passes: self.passes.clone(),
        }
    }

    /// The coordinates of a pixel in the whole picture, which determine its samples.
    pub(crate) fn in_whole(&self, pixel: UVec2) -> UVec2 {
        UVec2::new(pixel.x, pixel.y + self.first_row)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Number of passes.
    pub fn pass_count(&self) -> usize {
        self.passes.len()
    }

    /// The pass of this index.
    pub fn pass(&self, index: usize) -> Pass {
        self.passes[index]
    }

    /// Number of tiles per pass.
    pub fn tile_count(&self) -> usize {
        self.tiles().element_product() as usize
    }

    /// The block size of the first pass, in pixels.
    pub fn first_step(&self) -> u32 {
        self.pass(0).step()
    }

    /// Number of work units in all passes.
    pub fn unit_count(&self) -> usize {
        self.tile_count() * self.pass_count()
    }

    /// The work unit of this index; units are traced in this order.
    pub fn unit(&self, index: usize) -> WorkUnit {
        WorkUnit {
            pass: index / self.tile_count(),
            tile: index % self.tile_count(),
        }
    }

    /// Samples per pixel after `passes_done` passes.
    pub fn samples_after(&self, passes_done: usize) -> u32 {
        match passes_done.checked_sub(1).map(|last| self.passes[last]) {
            Some(Pass::Samples { first, count }) => first + count,
            Some(Pass::Lattice { step: 1 }) => 1,
            Some(Pass::Lattice { .. }) | None => 0,
        }
    }

    /// The rectangle of a tile.
    pub fn tile_rect(&self, tile: usize) -> PixelRect {
        let across = self.tiles().x;
        let min = UVec2::new(tile as u32 % across, tile as u32 / across) * TILE_PX;
        PixelRect {
            min,
            max: (min + TILE_PX).min(self.size),
        }
    }

    /// The tile that contains a pixel.
    pub(crate) fn tile_of(&self, pixel: UVec2) -> usize {
        Self::tile_in(self.size, pixel)
    }

    /// The tile that contains a pixel in a picture of this size.
    pub(crate) fn tile_in(size: UVec2, pixel: UVec2) -> usize {
        let tile = pixel / TILE_PX;
        (tile.y * size.x.div_ceil(TILE_PX) + tile.x) as usize
    }

    /// The pixels that a work unit traces, in groups of 4 × 4 blocks, so that neighbouring rays are traced together.
    pub fn pixels(&self, unit: WorkUnit) -> impl Iterator<Item = UVec2> + '_ {
        let rect = self.tile_rect(unit.tile);
        let pass = self.passes[unit.pass];
        let coarser = match pass {
            Pass::Lattice { .. } => &self.passes[..unit.pass],
            Pass::Samples { .. } => &[],
        };
        rect.blocks(pass.step())
            .map(move |corner| Self::representative(self.size, corner, pass.step()))
            .filter(move |&pixel| !coarser.iter().any(|&pass| self.lattice_holds(pass, pixel)))
    }

    /// The index of a pixel's block among those of its tile, in the order in which the first pass traces them.
    pub(crate) fn index_in_first_pass(&self, pixel: UVec2) -> usize {
        let tile = self.tile_rect(self.tile_of(pixel));
        tile.block_index(self.first_step(), pixel)
    }

    /// Position of a sample in its pixel.
    pub fn position(pixel: UVec2, sample: u32) -> Vec2 {
        sample_position(pixel, sample)
    }

    /// The pixel that represents the block around `pixel` in a picture of this size: its centre, clamped to the picture.
    pub(crate) fn representative(size: UVec2, pixel: UVec2, step: u32) -> UVec2 {
        (pixel / step * step + step / 2).min(size - 1)
    }

    fn lattice_holds(&self, pass: Pass, pixel: UVec2) -> bool {
        match pass {
            Pass::Lattice { step } => Self::representative(self.size, pixel, step) == pixel,
            Pass::Samples { .. } => false,
        }
    }

    fn tiles(&self) -> UVec2 {
        (self.size + (TILE_PX - 1)) / TILE_PX
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_of_every_pixel_is_taken_exactly_once() {
        for size in [UVec2::new(1, 1), UVec2::new(100, 61), UVec2::new(49, 2)] {
            for step in STEPS {
                let plan = Plan::new(size, step, 4);
                let mut seen = vec![[0; 4]; size.element_product() as usize];
                for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
                    for p in plan.pixels(unit) {
                        for sample in plan.pass(unit.pass).samples() {
                            seen[(p.y * size.x + p.x) as usize][sample as usize] += 1;
                        }
                    }
                }
                assert!(seen.iter().all(|s| *s == [1; 4]), "{size} {step}");
            }
        }
    }

    #[test]
    fn each_pixel_knows_the_index_of_its_block_in_the_first_pass() {
        for size in [UVec2::new(1, 1), UVec2::new(100, 61), UVec2::new(49, 2)] {
            for step in STEPS {
                let plan = Plan::new(size, step, 1);
                for tile in 0..plan.tile_count() {
                    let traced: Vec<UVec2> = plan.pixels(WorkUnit { pass: 0, tile }).collect();
                    let rect = plan.tile_rect(tile);
                    for y in rect.min.y..rect.max.y {
                        for pixel in (rect.min.x..rect.max.x).map(|x| UVec2::new(x, y)) {
                            let index = plan.index_in_first_pass(pixel);
                            let expected = Plan::representative(size, pixel, step);
                            assert_eq!(traced[index], expected, "{pixel} of {size} by {step}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn block_sizes_divide_the_tile_and_each_other() {
        for step in STEPS {
            assert_eq!(TILE_PX % step, 0);
            let plan = Plan::new(UVec2::splat(100), step, 1);
            let mut last = plan.pass(0);
            assert_eq!(last, Pass::Lattice { step });
            for pass in (1..plan.pass_count()).map(|k| plan.pass(k)) {
                let (Pass::Lattice { step: coarse }, Pass::Lattice { step: fine }) = (last, pass)
                else {
                    panic!("{pass:?} in a plan of one sample");
                };
                assert_eq!(coarse % fine, 0);
                last = pass;
            }
            assert_eq!(last, Pass::Lattice { step: 1 });
        }
    }

    #[test]
    fn samples_double_and_then_grow_evenly_up_to_the_requested_number() {
        let samples_of = |samples: u32| -> Vec<u32> {
            let plan = Plan::new(UVec2::splat(10), 1, samples);
            (0..=plan.pass_count())
                .map(|k| plan.samples_after(k))
                .collect()
        };
        assert_eq!(samples_of(16), [0, 1, 2, 4, 8, 16]);
        assert_eq!(samples_of(256), [0, 1, 2, 4, 8, 16, 32, 64, 128, 192, 256]);
        assert_eq!(Plan::new(UVec2::ONE, 1, 0).pass_count(), 1);
        let most = Plan::new(UVec2::ONE, 1, u32::MAX);
        assert_eq!(most.samples_after(most.pass_count()), MAX_SAMPLES);
    }
}

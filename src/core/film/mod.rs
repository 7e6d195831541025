//! Film: accumulates samples and encodes them for a display.
//!
//! Sums are integers, so the picture doesn't depend on the order in which tiles arrive, and bright samples
//! aren't clamped. Pixels without a sample show the colour of their block from a coarser pass; those of a tile that the
//! plan hasn't reached keep the colours of the plan before it.

mod noise;
mod shown;
mod sum;

pub use noise::{Noise, NoiseSum};
pub use shown::{ShownPixel, ShownPixels};
pub use sum::{SampleSum, Seen};

use crate::Camera;
use crate::plan::{Pass, PixelRect, Plan, WorkUnit};
use crate::tone::Display;
use glam::{UVec2, Vec3};
use std::collections::TryReserveError;
use std::ops::Range;

/// The samples of one tile in one pass, pixel by pixel in the pass's order.
#[derive(Clone, Debug)]
pub struct TileSamples {
    /// Which pass and tile.
    pub unit: WorkUnit,
    /// Sums over the pass's samples.
    pub sums: Vec<SampleSum>,
}

/// The state of a tile's pixels.
#[derive(Clone, Debug, Default)]
struct TileState {
    /// Whether the tile has samples of the plan. If not, its counts and block sizes are those of an earlier plan, and its
    /// sums are meaningless.
    has_samples: bool,
    /// The camera of the picture that the pixels show, if they show one and it is known.
    camera: Option<Camera>,
}

/// A picture that is being rendered.
#[derive(Clone, Debug)]
pub struct Film {
    plan: Plan,
    display: Display,
    /// The linear colour of pixels that show nothing.
    background: Vec3,
    /// The camera of the plan's picture, if it is known.
    camera: Option<Camera>,
    tiles: Vec<TileState>,
    /// Undefined for pixels without samples.
    sums: Vec<SampleSum>,
    counts: Vec<u32>,
    /// Size in pixels of the block whose colour a pixel shows; 0 once the pixel has a sample of its own.
    shown_step: Vec<u8>,
    /// sRGB with alpha 255, row by row from the top.
    pixels: Vec<[u8; 4]>,
    /// Finished tiles per pass.
    tiles_done: Vec<usize>,
}

/// Memory of a film.
pub const BYTES_PER_PIXEL: usize =
    size_of::<SampleSum>() + size_of::<u32>() + size_of::<u8>() + size_of::<[u8; 4]>();

impl Film {
    /// An empty film; every pixel shows the background, a linear colour.
    ///
    /// # Panics
    /// If there isn't enough memory.
    pub fn new(plan: Plan, background: Vec3) -> Self {
        Self::try_new(plan, background).expect("enough memory for a film")
    }

    /// The same as [`new`](Self::new).
    ///
    /// # Errors
    /// There isn't enough memory; see [`BYTES_PER_PIXEL`].
    pub fn try_new(plan: Plan, background: Vec3) -> Result<Self, TryReserveError> {
        let count = plan.size().element_product() as usize;
        let display = Display::default();
        Ok(Self {
            display,
            background,
            camera: None,
            tiles: vec![TileState::default(); plan.tile_count()],
            sums: filled(SampleSum::default(), count)?,
            counts: filled(0, count)?,
            shown_step: filled(u8::MAX, count)?,
            pixels: filled(display.encode(background), count)?,
            tiles_done: vec![0; plan.pass_count()],
            plan,
        })
    }

    /// Discards all samples and starts another plan. If the size stays the same, pixels keep their colour until
    /// they receive a sample. This is fast: the old samples of a tile are discarded when it receives its first new ones.
    pub fn restart(&mut self, plan: Plan, background: Vec3) {
        if plan.size() != self.plan.size() {
            let display = self.display;
            *self = Self::new(plan, background);
            self.set_display(display);
            return;
        }
        self.background = background;
        self.tiles
            .iter_mut()
            .for_each(|tile| tile.has_samples = false);
        self.tiles_done = vec![0; plan.pass_count()];
        self.plan = plan;
    }

    /// Sets the camera of the plan's picture, which [`ShownPixels`] reports.
    pub fn set_camera(&mut self, camera: Camera) {
        self.camera = Some(camera);
    }

    /// Adds a tile and returns the pixels that changed.
    pub fn add(&mut self, tile: &TileSamples) -> PixelRect {
        let pass = self.plan.pass(tile.unit.pass);
        let rect = self.plan.tile_rect(tile.unit.tile);
        // A later pass has no samples where an earlier one has.
        let is_alone = self.begin_tile(tile.unit.tile) && tile.unit.pass == 0;
        let samples = pass.samples_per_pixel();
        let pixels: Vec<UVec2> = self.plan.pixels(tile.unit).collect();
        for (pixel, sum) in pixels.into_iter().zip(&tile.sums) {
            let i = self.index(pixel);
            if self.counts[i] == 0 {
                self.sums[i] = *sum;
            } else {
                self.sums[i].merge(sum);
            }
            self.counts[i] += samples;
            self.shown_step[i] = 0;
            self.pixels[i] = self.encoded(i, &self.display);
            if let Pass::Lattice { step } = pass
                && !is_alone
            {
                self.fill_block(pixel, step);
            }
        }
        if let Pass::Lattice { step } = pass
            && is_alone
        {
            self.fill_blocks(rect, step);
        }
        self.tiles_done[tile.unit.pass] += 1;
        rect
    }

    /// Discards a tile's samples of an earlier plan. Returns whether it had none of this plan.
    fn begin_tile(&mut self, tile: usize) -> bool {
        let state = &mut self.tiles[tile];
        if state.has_samples {
            return false;
        }
        (state.has_samples, state.camera) = (true, self.camera);
        let rect = self.plan.tile_rect(tile);
        for y in rect.min.y..rect.max.y {
            let row = self.row(rect, y);
            self.counts[row.clone()].fill(0);
            self.shown_step[row].fill(u8::MAX);
        }
        true
    }

    /// The indices of a rectangle's pixels in a row.
    fn row(&self, rect: PixelRect, y: u32) -> Range<usize> {
        self.index(UVec2::new(rect.min.x, y))..self.index(UVec2::new(rect.max.x, y))
    }

    /// Counts a tile that couldn't be traced as finished; its pixels keep their colour.
    pub fn skip(&mut self, unit: WorkUnit) {
        self.tiles_done[unit.pass] += 1;
    }

    /// Copies a pixel's colour to those pixels of its block that show a coarser block.
    fn fill_block(&mut self, pixel: UVec2, step: u32) {
        let colour = self.pixels[self.index(pixel)];
        let min = pixel / step * step;
        let max = (min + step).min(self.plan.size());
        for y in min.y..max.y {
            for x in min.x..max.x {
                let i = self.index(UVec2::new(x, y));
                if u32::from(self.shown_step[i]) > step {
                    self.shown_step[i] = step as u8;
                    self.pixels[i] = colour;
                }
            }
        }
    }

    /// Does for all blocks of a tile that has only the samples of the first pass what [`fill_block`](Self::fill_block)
    /// does for one block, but faster: each row is a copy of the row that has the samples.
    fn fill_blocks(&mut self, tile: PixelRect, step: u32) {
        let size = self.plan.size();
        let starts = |from: u32, to: u32| (from..to).step_by(step as usize);
        for top in starts(tile.min.y, tile.max.y) {
            let sampled = |left| Plan::representative(size, UVec2::new(left, top), step);
            let in_block = |left| (sampled(left).x - left) as usize;
            let source = self.row(tile, sampled(tile.min.x).y);
            let blocks = self.pixels[source.clone()].chunks_mut(step as usize);
            for (block, left) in blocks.zip(starts(tile.min.x, tile.max.x)) {
                block.fill(block[in_block(left)]);
            }
            for y in top..(top + step).min(tile.max.y) {
                let row = self.row(tile, y);
                self.shown_step[row.clone()].fill(step as u8);
                self.pixels.copy_within(source.clone(), row.start);
            }
            let blocks = self.shown_step[source].chunks_mut(step as usize);
            for (block, left) in blocks.zip(starts(tile.min.x, tile.max.x)) {
                block[in_block(left)] = 0;
            }
        }
    }

    /// Changes exposure and tone curve, and returns whether they differ from before.
    ///
    /// All pixels are encoded again from the same samples. Pixels that don't show any yet show the background, which
    /// exposure and tone curve don't change.
    pub fn set_display(&mut self, display: Display) -> bool {
        if display == self.display {
            return false;
        }
        self.display = display;
        let background = Display::default().encode(self.background);
        for tile in 0..self.tiles.len() {
            let rect = self.plan.tile_rect(tile);
            let state = &mut self.tiles[tile];
            let has_samples = state.has_samples;
            if !has_samples {
                state.camera = None;
            }
            for y in rect.min.y..rect.max.y {
                for i in self.row(rect, y) {
                    self.pixels[i] = self
                        .shown_at(i, has_samples, &display)
                        .unwrap_or(background);
                }
            }
        }
        true
    }

    /// The colour of a pixel with the exposure and tone curve of `display` instead of the film's. `None` if the pixel
    /// doesn't show samples of the plan.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn shown(&self, pixel: UVec2, display: &Display) -> Option<[u8; 4]> {
        let has_samples = self.tiles[self.plan.tile_of(pixel)].has_samples;
        self.shown_at(self.index(pixel), has_samples, display)
    }

    /// `has_samples` tells whether the pixel's tile has samples of the plan.
    fn shown_at(&self, i: usize, has_samples: bool, display: &Display) -> Option<[u8; 4]> {
        let step = Some(self.shown_step[i]).filter(|&step| has_samples && step != u8::MAX)?;
        // A pixel that represents a block has a sample.
        Some(self.encoded(self.shown_index(i, step.into()), display))
    }

    /// The displayed colour of the mean of a pixel's samples.
    fn encoded(&self, i: usize, display: &Display) -> [u8; 4] {
        let (sum, count) = (&self.sums[i], self.counts[i].max(1));
        let part = sum.background_part(count);
        if part == 0.0 || *display == Display::default() {
            return display.encode(sum.mean(count));
        }
        let light = sum.mean(count) - part * self.background;
        display.encode_over(light, part, self.background)
    }

    /// The index of the pixel whose samples a pixel shows.
    fn shown_index(&self, i: usize, step: u32) -> usize {
        if step == 0 {
            return i;
        }
        let width = self.plan.size().x;
        let pixel = UVec2::new(i as u32 % width, i as u32 / width);
        self.index(Plan::representative(self.plan.size(), pixel, step))
    }

    /// Exposure and tone curve.
    pub fn display(&self) -> Display {
        self.display
    }

    /// Number of finished passes.
    pub fn passes_done(&self) -> usize {
        let is_done = |&&done: &&usize| done == self.plan.tile_count();
        self.tiles_done.iter().take_while(is_done).count()
    }

    /// Whether every pass is finished.
    pub fn is_complete(&self) -> bool {
        self.passes_done() == self.plan.pass_count()
    }

    /// Samples per pixel; 0 while some pixels show coarse blocks.
    pub fn samples(&self) -> u32 {
        self.plan.samples_after(self.passes_done())
    }

    /// The mean of a pixel's samples in linear RGB; `None` while it has none.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn radiance(&self, pixel: UVec2) -> Option<Vec3> {
        let (sum, count) = self.samples_of(pixel);
        (count > 0).then(|| sum.mean(count))
    }

    /// The standard error of the luminance of a pixel; `None` for fewer than two samples.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn standard_error(&self, pixel: UVec2) -> Option<f64> {
        let (sum, count) = self.samples_of(pixel);
        (count > 1).then(|| (sum.variance(count) / f64::from(count)).sqrt())
    }

    /// Whether any sample of a pixel shows a surface.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn shows_surface(&self, pixel: UVec2) -> bool {
        let (sum, count) = self.samples_of(pixel);
        sum.shows_surface(count)
    }

    /// Number of samples of a pixel.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn sample_count(&self, pixel: UVec2) -> u32 {
        self.samples_of(pixel).1
    }

    /// The sum and the number of a pixel's samples; the sum of 0 samples is undefined.
    fn samples_of(&self, pixel: UVec2) -> (&SampleSum, u32) {
        let i = self.index(pixel);
        let has_samples = self.tiles[self.plan.tile_of(pixel)].has_samples;
        (&self.sums[i], if has_samples { self.counts[i] } else { 0 })
    }

    /// The plan being rendered.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.plan.size()
    }

    /// sRGB with alpha 255, row by row from the top.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    fn index(&self, pixel: UVec2) -> usize {
        pixel.y as usize * self.plan.size().x as usize + pixel.x as usize
    }
}

/// `count` copies of a value, if there is enough memory.
fn filled<T: Clone>(value: T, count: usize) -> Result<Vec<T>, TryReserveError> {
    let mut values = Vec::new();
    values.try_reserve_exact(count)?;
    values.resize(count, value);
    Ok(values)
}

#[cfg(test)]
mod tests;

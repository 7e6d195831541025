//! Film: accumulates samples and encodes them for a display.
//!
//! Sums are integers, so the picture doesn't depend on the order in which tiles arrive, and bright samples
//! aren't clamped. Pixels without a sample show the colour of their block from a coarser pass; those of a tile that the
//! plan hasn't reached keep the colours of the plan before it.

mod adding;
mod noise;
mod shown;
mod sum;

pub use noise::{Noise, NoiseSum};
pub use shown::{ShownPixel, ShownPixels};
pub use sum::{SampleSum, Seen};

use crate::Camera;
use crate::plan::{PixelRect, Plan, WorkUnit};
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
    /// Until a later pass of the tile arrives. The film's sums, counts and block sizes of the tile are meaningless then.
    first_pass: Option<FirstPass>,
    /// The camera of the picture that the pixels show, if they show one and it is known.
    camera: Option<Camera>,
}

/// A tile's samples of a first pass of blocks, of the plan or of an earlier one. While the camera moves, pictures end with
/// this pass, so that spreading its samples over the film would be wasted time.
#[derive(Clone, Debug)]
struct FirstPass {
    /// Size of the blocks in pixels.
    step: u8,
    /// Sums in the order of the pass.
    sums: Vec<SampleSum>,
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

/// Memory of a film whose first pass traces each pixel.
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

    /// The indices of a rectangle's pixels in a row.
    fn row(&self, rect: PixelRect, y: u32) -> Range<usize> {
        self.index(UVec2::new(rect.min.x, y))..self.index(UVec2::new(rect.max.x, y))
    }

    /// Counts a tile that couldn't be traced as finished; its pixels keep their colour.
    pub fn skip(&mut self, unit: WorkUnit) {
        self.tiles_done[unit.pass] += 1;
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
            if !state.has_samples {
                state.camera = None;
            } else if let Some(first_pass) = state.first_pass.take() {
                self.fill_blocks(rect, first_pass.step.into(), &first_pass.sums);
                self.tiles[tile].first_pass = Some(first_pass);
                continue;
            }
            for y in rect.min.y..rect.max.y {
                for x in rect.min.x..rect.max.x {
                    let pixel = UVec2::new(x, y);
                    let i = self.index(pixel);
                    self.pixels[i] = self.shown(pixel, &display).unwrap_or(background);
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
        let state = &self.tiles[self.plan.tile_of(pixel)];
        if !state.has_samples {
            return None;
        }
        if let Some(first) = &state.first_pass {
            let sum = &first.sums[self.plan.index_in_first_pass(pixel)];
            return Some(self.encoded(sum, 1, display));
        }
        let i = match self.shown_step[self.index(pixel)] {
            u8::MAX => return None,
            0 => self.index(pixel),
            step => self.index(Plan::representative(self.size(), pixel, step.into())),
        };
        // A pixel that represents a block has a sample.
        Some(self.encoded(&self.sums[i], self.counts[i], display))
    }

    /// The displayed colour of the mean of `count` samples.
    fn encoded(&self, sum: &SampleSum, count: u32, display: &Display) -> [u8; 4] {
        let count = count.max(1);
        let part = sum.background_part(count);
        if part == 0.0 || *display == Display::default() {
            return display.encode(sum.mean(count));
        }
        let light = sum.mean(count) - part * self.background;
        display.encode_over(light, part, self.background)
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
        let state = &self.tiles[self.plan.tile_of(pixel)];
        match &state.first_pass {
            _ if !state.has_samples => (&self.sums[i], 0),
            None => (&self.sums[i], self.counts[i]),
            Some(first) => {
                let (step, size) = (first.step.into(), self.size());
                let is_traced = Plan::representative(size, pixel, step) == pixel;
                let sum = &first.sums[self.plan.index_in_first_pass(pixel)];
                (sum, u32::from(is_traced))
            }
        }
    }

    /// Width and height, in pixels, of the blocks of equal colour that the whole picture consists of, from its top left
    /// corner; 1 unless every tile shows the plan's first pass only.
    pub fn block_px(&self) -> u32 {
        let is_first = |tile: &TileState| tile.has_samples && tile.first_pass.is_some();
        if self.tiles.iter().all(is_first) {
            self.plan.first_step()
        } else {
            1
        }
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

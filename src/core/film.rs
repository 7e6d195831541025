//! Film: accumulates samples and encodes them for display.
//!
//! Sums are integers, so the picture doesn't depend on the order in which tiles arrive. Pixels without a
//! sample show the colour of their block from a coarser pass.

use crate::plan::{Pass, PixelRect, Plan, WorkUnit};
use crate::srgb::to_display;
use glam::{UVec2, Vec3};
use std::collections::TryReserveError;
use std::sync::LazyLock;

/// A sum of samples in linear RGB, in units of 2⁻¹⁶, which is finer than 8-bit sRGB.
pub type FixedRgb = [u32; 3];

/// The value 1 in [`FixedRgb`].
const ONE: f32 = 65536.0;
/// Samples are clamped to this radiance, so that the sum of 4096 of them stays below 2³².
const BRIGHTEST: f32 = 15.0;

/// The radiance of a sample in fixed point; `None` if it isn't finite.
pub fn fixed(radiance: Vec3) -> Option<FixedRgb> {
    let channel = |x: f32| (x.clamp(0.0, BRIGHTEST) * ONE).round() as u32;
    radiance
        .is_finite()
        .then(|| radiance.to_array().map(channel))
}

/// The samples of one tile in one pass, pixel by pixel in the pass's order.
#[derive(Clone, Debug)]
pub struct TileSamples {
    /// Which pass and tile.
    pub unit: WorkUnit,
    /// Sums over the pass's samples.
    pub sums: Vec<FixedRgb>,
}

/// A picture that is being rendered.
#[derive(Clone, Debug)]
pub struct Film {
    plan: Plan,
    sums: Vec<FixedRgb>,
    counts: Vec<u16>,
    /// Size in pixels of the block whose colour a pixel shows; 0 once the pixel has a sample of its own.
    shown_step: Vec<u8>,
    /// sRGB with alpha 255, row by row from the top.
    pixels: Vec<[u8; 4]>,
    /// Finished tiles per pass.
    tiles_done: Vec<usize>,
}

/// Memory of a film.
pub const BYTES_PER_PIXEL: usize =
    size_of::<FixedRgb>() + size_of::<u16>() + size_of::<u8>() + size_of::<[u8; 4]>();

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
        Ok(Self {
            sums: filled([0; 3], count)?,
            counts: filled(0, count)?,
            shown_step: filled(u8::MAX, count)?,
            pixels: filled(encode(fixed(background).unwrap_or_default(), 1), count)?,
            tiles_done: vec![0; plan.pass_count()],
            plan,
        })
    }

    /// Discards all samples and starts another plan. If the size stays the same, pixels keep their colour until
    /// they receive a sample.
    pub fn restart(&mut self, plan: Plan, background: Vec3) {
        if plan.size() != self.plan.size() {
            *self = Self::new(plan, background);
            return;
        }
        self.sums.fill([0; 3]);
        self.counts.fill(0);
        self.shown_step.fill(u8::MAX);
        self.tiles_done = vec![0; plan.pass_count()];
        self.plan = plan;
    }

    /// Adds a tile and returns the pixels that changed.
    pub fn add(&mut self, tile: &TileSamples) -> PixelRect {
        let pass = self.plan.pass(tile.unit.pass);
        let rect = self.plan.tile_rect(tile.unit.tile);
        let samples = pass.samples_per_pixel() as u16;
        let pixels: Vec<UVec2> = self.plan.pixels(tile.unit).collect();
        for (pixel, sum) in pixels.into_iter().zip(&tile.sums) {
            let i = self.index(pixel);
            for (total, part) in self.sums[i].iter_mut().zip(sum) {
                *total += part;
            }
            self.counts[i] += samples;
            self.shown_step[i] = 0;
            self.pixels[i] = encode(self.sums[i], u32::from(self.counts[i]));
            if let Pass::Lattice { step } = pass {
                self.fill_block(pixel, step);
            }
        }
        self.tiles_done[tile.unit.pass] += 1;
        rect
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

/// The mean of a pixel's samples as 8-bit sRGB.
fn encode(sum: FixedRgb, count: u32) -> [u8; 4] {
    /// sRGB for each linear value in units of 2⁻¹⁶. A table, because `powf` per pixel is too slow for the UI thread.
    static SRGB: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let encoded = |i: u32| (255.0 * to_display(i as f32 / ONE)).round() as u8;
        (0..=ONE as u32).map(encoded).collect()
    });
    let [r, g, b] = sum.map(|s| SRGB[(s / count).min(ONE as u32) as usize]);
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_of_samples_is_encoded_as_srgb() {
        // 128/255 through the transfer function.
        let grey = fixed(Vec3::splat(0.215_861)).expect("finite");
        assert_eq!(encode(grey, 1), [128, 128, 128, 255]);
        assert_eq!(encode(grey.map(|x| x * 4), 4), [128, 128, 128, 255]);
        assert_eq!(encode([u32::MAX; 3], 4096), [255; 4]);
    }

    #[test]
    fn non_finite_samples_are_rejected_and_others_are_clamped() {
        assert_eq!(fixed(Vec3::new(0.0, f32::NAN, 0.0)), None);
        assert_eq!(fixed(Vec3::splat(-1.0)), Some([0; 3]));
        assert_eq!(fixed(Vec3::splat(1e9)), fixed(Vec3::splat(BRIGHTEST)));
    }

    #[test]
    fn the_order_of_tiles_does_not_change_the_picture() {
        let plan = Plan::new(UVec2::new(70, 50), 4, 4);
        let tiles: Vec<TileSamples> = (0..plan.unit_count())
            .map(|k| {
                let unit = plan.unit(k);
                let shade = |p: UVec2| [p.x * 500, p.y * 700, k as u32 * 90];
                let samples = plan.pass(unit.pass).samples_per_pixel();
                let sums = plan.pixels(unit).map(|p| shade(p).map(|x| x * samples));
                TileSamples {
                    unit,
                    sums: sums.collect(),
                }
            })
            .collect();
        let mut forwards = Film::new(plan.clone(), Vec3::ZERO);
        let mut backwards = forwards.clone();
        tiles.iter().for_each(|tile| _ = forwards.add(tile));
        tiles.iter().rev().for_each(|tile| _ = backwards.add(tile));
        assert!(forwards.is_complete() && backwards.is_complete());
        assert_eq!(forwards.pixels(), backwards.pixels());
        assert_eq!(forwards.samples(), 4);
    }

    #[test]
    fn a_pixel_without_a_sample_shows_the_colour_of_its_block() {
        // Of whole blocks: at the border a block's pixel may have been sampled for a larger one.
        let size = UVec2::new(144, 96);
        let shade = |p: UVec2| [p.x * 600, p.y * 1200, 77];
        for first_step in [16, 12, 6] {
            let plan = Plan::new(size, first_step, 1);
            let mut film = Film::new(plan.clone(), Vec3::ONE);
            let mut has_sample = vec![false; size.element_product() as usize];
            for pass in 0..plan.pass_count() {
                for tile in 0..plan.tile_count() {
                    let unit = WorkUnit { pass, tile };
                    plan.pixels(unit)
                        .for_each(|p| has_sample[film.index(p)] = true);
                    let sums = plan.pixels(unit).map(shade).collect();
                    film.add(&TileSamples { unit, sums });
                }
                let Pass::Lattice { step } = plan.pass(pass) else {
                    panic!("{pass} is a pass of a plan of one sample");
                };
                for i in 0..size.element_product() {
                    let p = UVec2::new(i % size.x, i / size.x);
                    let middle = p / step * step + step / 2;
                    let shown = if has_sample[i as usize] { p } else { middle };
                    let expected = encode(shade(shown), 1);
                    assert_eq!(film.pixels()[i as usize], expected, "{p} by {step}");
                }
            }
        }
    }

    #[test]
    fn a_restarted_film_of_the_same_size_keeps_its_colours() {
        let size = UVec2::new(50, 2);
        let mut film = Film::new(Plan::new(size, 1, 1), Vec3::ZERO);
        let white = |film: &mut Film| {
            for tile in 0..film.plan().tile_count() {
                let unit = film.plan().unit(tile);
                let sums = film.plan().pixels(unit).map(|_| [ONE as u32; 3]).collect();
                film.add(&TileSamples { unit, sums });
            }
        };
        white(&mut film);
        assert_eq!((film.samples(), film.is_complete()), (1, true));
        film.restart(Plan::new(size, 2, 1), Vec3::ZERO);
        assert_eq!((film.samples(), film.passes_done()), (0, 0));
        assert!(film.pixels().iter().all(|&p| p == [255; 4]));
        // Nothing is left of the samples before: white once more is no brighter.
        white(&mut film);
        assert_eq!(film.counts.iter().filter(|&&n| n == 1).count(), 25);
        let size = UVec2::new(51, 2);
        film.restart(Plan::new(size, 1, 1), Vec3::ZERO);
        assert_eq!(film.size(), size);
        assert_eq!(film.pixels(), [[0, 0, 0, 255]; 102]);
    }

    #[test]
    fn a_film_counts_skipped_tiles_as_done() {
        let plan = Plan::new(UVec2::new(50, 50), 1, 1);
        let mut film = Film::new(plan.clone(), Vec3::ONE);
        (0..plan.unit_count()).for_each(|k| film.skip(plan.unit(k)));
        assert!(film.is_complete());
        assert!(film.pixels().iter().all(|&p| p == [255; 4]));
    }

    #[test]
    fn the_union_of_rectangles_contains_both() {
        let rect = |a, b, c, d| PixelRect {
            min: UVec2::new(a, b),
            max: UVec2::new(c, d),
        };
        let (first, second) = (rect(3, 1, 5, 9), rect(2, 4, 8, 6));
        assert_eq!(first.union(second), rect(2, 1, 8, 9));
        assert_eq!(second.union(first), rect(2, 1, 8, 9));
    }

    #[test]
    fn the_first_pass_covers_the_whole_picture() {
        let plan = Plan::new(UVec2::new(101, 53), 8, 1);
        let mut film = Film::new(plan.clone(), Vec3::ZERO);
        for tile in 0..plan.tile_count() {
            let unit = plan.unit(tile);
            let sums = plan.pixels(unit).map(|_| [ONE as u32; 3]).collect();
            film.add(&TileSamples { unit, sums });
        }
        assert!(film.pixels().iter().all(|&p| p == [255; 4]));
        assert_eq!((film.passes_done(), film.samples()), (1, 0));
    }
}

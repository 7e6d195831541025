//! Film: accumulates samples and encodes them for a display.
//!
//! Sums are integers of 128 bits, so the picture doesn't depend on the order in which tiles arrive, and bright samples
//! aren't clamped. Pixels without a
//! sample show the colour of their block from a coarser pass.

use crate::plan::{Pass, PixelRect, Plan, WorkUnit};
use crate::srgb::luminance;
use crate::tone::Display;
use glam::{UVec2, Vec3};
use std::collections::TryReserveError;

/// The sum of a pixel's samples. The order in which samples are added doesn't matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleSum {
    /// Linear RGB in units of 2⁻⁶⁴.
    rgb: [u128; 3],
    /// Squared luminance in the same units, for the variance.
    square: u128,
}

/// The value 1 in [`SampleSum`].
const ONE: f64 = 18_446_744_073_709_551_616.0;

impl SampleSum {
    /// Adds a sample in linear RGB, and returns whether it was finite. One that isn't is left out, and a negative number
    /// counts as 0.
    ///
    /// Digits below 2⁻⁶⁴ are dropped, and sums end at 2⁶⁴.
    pub fn add(&mut self, radiance: Vec3) -> bool {
        // A negative number becomes 0.
        let fixed = |x: f64| (x * ONE) as u128;
        if !radiance.is_finite() {
            return false;
        }
        let brightness = f64::from(luminance(radiance));
        self.merge(&Self {
            rgb: radiance.to_array().map(|x| fixed(x.into())),
            square: fixed(brightness * brightness),
        });
        true
    }

    fn merge(&mut self, other: &Self) {
        for (sum, part) in self.rgb.iter_mut().zip(other.rgb) {
            *sum = sum.saturating_add(part);
        }
        self.square = self.square.saturating_add(other.square);
    }

    /// The mean of `count` samples.
    fn mean(&self, count: u32) -> Vec3 {
        let unit = 1.0 / (ONE * f64::from(count));
        Vec3::from_array(self.rgb.map(|sum| (sum as f64 * unit) as f32))
    }

    /// The variance of the luminance of a single sample, estimated from `count` samples; 0 for fewer than 2.
    fn variance(&self, count: u32) -> f64 {
        if count < 2 {
            return 0.0;
        }
        let n = f64::from(count);
        let mean = f64::from(luminance(self.mean(count)));
        let square = self.square as f64 / (ONE * n);
        (square - mean * mean).max(0.0) * n / (n - 1.0)
    }
}

/// The samples of one tile in one pass, pixel by pixel in the pass's order.
#[derive(Clone, Debug)]
pub struct TileSamples {
    /// Which pass and tile.
    pub unit: WorkUnit,
    /// Sums over the pass's samples.
    pub sums: Vec<SampleSum>,
}

/// A picture that is being rendered.
#[derive(Clone, Debug)]
pub struct Film {
    plan: Plan,
    display: Display,
    /// The linear colour of pixels that show nothing.
    background: Vec3,
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
            sums: filled(SampleSum::default(), count)?,
            counts: filled(0, count)?,
            shown_step: filled(u8::MAX, count)?,
            pixels: filled(display.encode(background), count)?,
            tiles_done: vec![0; plan.pass_count()],
            plan,
        })
    }

    /// Discards all samples and starts another plan. If the size stays the same, pixels keep their colour until
    /// they receive a sample.
    pub fn restart(&mut self, plan: Plan, background: Vec3) {
        if plan.size() != self.plan.size() {
            let display = self.display;
            *self = Self::new(plan, background);
            self.set_display(display);
            return;
        }
        self.background = background;
        self.sums.fill(SampleSum::default());
        self.counts.fill(0);
        self.shown_step.fill(u8::MAX);
        self.tiles_done = vec![0; plan.pass_count()];
        self.plan = plan;
    }

    /// Adds a tile and returns the pixels that changed.
    pub fn add(&mut self, tile: &TileSamples) -> PixelRect {
        let pass = self.plan.pass(tile.unit.pass);
        let rect = self.plan.tile_rect(tile.unit.tile);
        let samples = pass.samples_per_pixel();
        let pixels: Vec<UVec2> = self.plan.pixels(tile.unit).collect();
        for (pixel, sum) in pixels.into_iter().zip(&tile.sums) {
            let i = self.index(pixel);
            self.sums[i].merge(sum);
            self.counts[i] += samples;
            self.shown_step[i] = 0;
            self.pixels[i] = self.display.encode(self.sums[i].mean(self.counts[i]));
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

    /// Changes exposure and tone curve, and returns whether they differ from before. All pixels are encoded again, from
    /// the same samples; those that don't show any yet show the background.
    pub fn set_display(&mut self, display: Display) -> bool {
        if display == self.display {
            return false;
        }
        self.display = display;
        let background = display.encode(self.background);
        for i in 0..self.pixels.len() {
            let shown = match self.shown_step[i] {
                u8::MAX => None,
                step => Some(self.shown_index(i, step.into())),
            };
            // A pixel that represents a block has a sample.
            self.pixels[i] = shown.map_or(background, |shown| {
                display.encode(self.sums[shown].mean(self.counts[shown].max(1)))
            });
        }
        true
    }

    /// The index of the pixel whose samples a pixel shows.
    fn shown_index(&self, i: usize, step: u32) -> usize {
        if step == 0 {
            return i;
        }
        let width = self.plan.size().x;
        let pixel = UVec2::new(i as u32 % width, i as u32 / width);
        self.index(self.plan.representative(pixel, step))
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
        let i = self.index(pixel);
        (self.counts[i] > 0).then(|| self.sums[i].mean(self.counts[i]))
    }

    /// The standard error of the luminance of a pixel; `None` for fewer than two samples.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn standard_error(&self, pixel: UVec2) -> Option<f64> {
        let (sum, count) = (
            &self.sums[self.index(pixel)],
            self.counts[self.index(pixel)],
        );
        (count > 1).then(|| (sum.variance(count) / f64::from(count)).sqrt())
    }

    /// Number of samples of a pixel.
    ///
    /// # Panics
    /// If the pixel lies outside of the picture.
    pub fn sample_count(&self, pixel: UVec2) -> u32 {
        self.counts[self.index(pixel)]
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
mod tests {
    use super::*;
    use crate::brightness::MAX_BRIGHTNESS;
    use crate::random::Random;

    fn sum_of(samples: &[Vec3]) -> SampleSum {
        let mut sum = SampleSum::default();
        samples.iter().for_each(|&sample| _ = sum.add(sample));
        sum
    }

    #[test]
    fn the_mean_of_equal_samples_is_that_sample() {
        let grey = Vec3::splat(0.215_861);
        assert_eq!(sum_of(&[grey; 4]).mean(4), grey);
    }

    #[test]
    fn a_changed_display_gives_the_pixels_of_a_film_that_had_it_from_the_start() {
        let display = Display::new(1.5, crate::tone::TONE_CURVES[1]);
        // Blocks at the right and lower border are cut.
        let plan = Plan::new(UVec2::new(101, 53), 16, 2);
        let background = Vec3::new(0.1, 0.2, 0.3);
        let mut with = Film::new(plan.clone(), background);
        assert!(with.set_display(display));
        assert!(!with.set_display(display));
        let mut without = Film::new(plan.clone(), background);
        let shade = |p: UVec2| Vec3::new(p.x as f32, 2.0 * p.y as f32, 9.0) / 50.0;
        for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
            let sums = plan.pixels(unit).map(|p| sum_of(&[shade(p)])).collect();
            let tile = TileSamples { unit, sums };
            with.add(&tile);
            without.add(&tile);
            if unit.tile % 2 == 0 {
                without.set_display(display);
                assert!(without.pixels() == with.pixels(), "{unit:?}");
                without.set_display(Display::default());
            }
        }
        // A restart keeps the display.
        with.restart(Plan::new(UVec2::ONE, 1, 1), background);
        assert_eq!(with.display(), display);
        assert_eq!(with.pixels(), [display.encode(background)]);
    }

    #[test]
    fn non_finite_samples_are_rejected_and_bright_ones_are_not_clamped() {
        let mut sum = SampleSum::default();
        assert!(!sum.add(Vec3::new(0.0, f32::NAN, 0.0)));
        assert!(!sum.add(Vec3::new(0.0, f32::INFINITY, 0.0)));
        assert!(sum.add(Vec3::splat(-1.0)));
        assert_eq!(sum.mean(1), Vec3::ZERO);
        assert!(sum.add(Vec3::new(1e9, 1e-9, 3.0)));
        assert_eq!(sum.mean(1), Vec3::new(1e9, 1e-9, 3.0));
        (0..3).for_each(|_| _ = sum.add(Vec3::splat(f32::MAX)));
        // The end of the range, 2⁶⁴.
        assert_eq!(sum.mean(1), Vec3::splat(ONE as f32));
    }

    #[test]
    fn no_sum_of_the_brightest_light_is_cut() {
        let samples = vec![Vec3::splat(MAX_BRIGHTNESS); 1 << 16];
        // The sum is 2⁶⁴ less one unit of the sums, which the mean rounds away.
        let mean = sum_of(&samples).mean(1 << 16);
        assert_eq!(mean, Vec3::splat(MAX_BRIGHTNESS));
    }

    #[test]
    fn the_order_of_samples_of_any_brightness_does_not_change_their_sum() {
        let mut random = Random::new(4);
        let mut samples = [(); 100].map(|()| {
            let exponent = random.index(60) as i32 - 40;
            Vec3::from_array([(); 3].map(|()| random.unit() as f32 * 2f32.powi(exponent)))
        });
        let sum = sum_of(&samples);
        samples.reverse();
        assert_eq!(sum_of(&samples), sum);
        samples.sort_by(|a, b| a.x.total_cmp(&b.x));
        assert_eq!(sum_of(&samples), sum);
    }

    #[test]
    fn the_variance_is_that_of_single_samples() {
        let grey = |x: f32| Vec3::splat(x);
        // Of 1, 2, 3, 6: deviations −2, −1, 0, 3, and 14/3.
        let sum = sum_of(&[1.0, 2.0, 3.0, 6.0].map(grey));
        // Luminances are rounded to f32.
        assert!((sum.variance(4) - 14.0 / 3.0).abs() < 1e-5);
        assert_eq!(sum_of(&[grey(0.25); 2]).variance(1), 0.0);
        assert!(sum_of(&[grey(0.1); 9]).variance(9) < 1e-9);
    }

    #[test]
    fn the_order_of_tiles_does_not_change_the_picture() {
        let plan = Plan::new(UVec2::new(70, 50), 4, 4);
        let tiles: Vec<TileSamples> = (0..plan.unit_count())
            .map(|k| {
                let unit = plan.unit(k);
                let shade = |p: UVec2| Vec3::new(p.x as f32, p.y as f32, k as f32) / 90.0;
                let samples = plan.pass(unit.pass).samples_per_pixel() as usize;
                let sums = plan.pixels(unit).map(|p| sum_of(&vec![shade(p); samples]));
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
        let shade = |p: UVec2| Vec3::new(p.x as f32, 2.0 * p.y as f32, 1.0) / 192.0;
        for first_step in [16, 12, 6] {
            let plan = Plan::new(size, first_step, 1);
            let mut film = Film::new(plan.clone(), Vec3::ONE);
            let mut has_sample = vec![false; size.element_product() as usize];
            for pass in 0..plan.pass_count() {
                for tile in 0..plan.tile_count() {
                    let unit = WorkUnit { pass, tile };
                    plan.pixels(unit)
                        .for_each(|p| has_sample[film.index(p)] = true);
                    let sums = plan.pixels(unit).map(|p| sum_of(&[shade(p)])).collect();
                    film.add(&TileSamples { unit, sums });
                }
                let Pass::Lattice { step } = plan.pass(pass) else {
                    panic!("{pass} is a pass of a plan of one sample");
                };
                for i in 0..size.element_product() {
                    let p = UVec2::new(i % size.x, i / size.x);
                    let middle = p / step * step + step / 2;
                    let shown = if has_sample[i as usize] { p } else { middle };
                    let expected = Display::default().encode(shade(shown));
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
                let sums = film
                    .plan()
                    .pixels(unit)
                    .map(|_| sum_of(&[Vec3::ONE]))
                    .collect();
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
            let sums = plan.pixels(unit).map(|_| sum_of(&[Vec3::ONE])).collect();
            film.add(&TileSamples { unit, sums });
        }
        assert!(film.pixels().iter().all(|&p| p == [255; 4]));
        assert_eq!((film.passes_done(), film.samples()), (1, 0));
    }
}

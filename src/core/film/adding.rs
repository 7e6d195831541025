//! Adding tiles to a film.

use super::{Film, FirstPass, SampleSum, TileSamples, TileState};
use crate::plan::{Pass, PixelRect, WorkUnit};
use glam::UVec2;

impl Film {
    /// Adds a tile and returns the pixels that changed.
    pub fn add(&mut self, tile: TileSamples) -> PixelRect {
        let WorkUnit { pass, tile: index } = tile.unit;
        let rect = self.plan.tile_rect(index);
        self.tiles_done[pass] += 1;
        match self.plan.pass(pass) {
            // A later pass has no samples where an earlier one has.
            Pass::Lattice { step } if pass == 0 && step > 1 && !self.tiles[index].has_samples => {
                self.fill_blocks(rect, step, &tile.sums);
                self.tiles[index] = TileState {
                    has_samples: true,
                    first_pass: Some(FirstPass {
                        step: step as u8,
                        sums: tile.sums,
                    }),
                    camera: self.camera,
                };
            }
            pass => {
                self.begin_tile(index);
                self.merge(pass, &tile);
            }
        }
        rect
    }

    /// Adds the samples of a tile to those in the film.
    fn merge(&mut self, pass: Pass, tile: &TileSamples) {
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
            self.pixels[i] = self.encoded(&self.sums[i], self.counts[i], &self.display);
            if let Pass::Lattice { step } = pass {
                self.fill_block(pixel, step);
            }
        }
    }

    /// Prepares a tile's part of the film for samples: discards those of an earlier plan, or spreads those of the first
    /// pass over it.
    pub(super) fn begin_tile(&mut self, tile: usize) {
        let state = &mut self.tiles[tile];
        let first_pass = state.first_pass.take();
        if !state.has_samples {
            (state.has_samples, state.camera) = (true, self.camera);
            self.clear_tile(tile, u8::MAX);
        } else if let Some(first_pass) = first_pass {
            self.clear_tile(tile, first_pass.step);
            let pixels = self.plan.pixels(WorkUnit { pass: 0, tile });
            let places: Vec<usize> = pixels.map(|pixel| self.index(pixel)).collect();
            for (i, sum) in places.into_iter().zip(first_pass.sums) {
                (self.sums[i], self.counts[i], self.shown_step[i]) = (sum, 1, 0);
            }
        }
    }

    /// Discards all samples of a tile, whose pixels show blocks of this size.
    fn clear_tile(&mut self, tile: usize, step: u8) {
        let rect = self.plan.tile_rect(tile);
        for y in rect.min.y..rect.max.y {
            let row = self.row(rect, y);
            self.counts[row.clone()].fill(0);
            self.shown_step[row].fill(step);
        }
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

    /// Gives a tile's pixels the colours of their blocks, whose sums are in the order of the first pass.
    pub(super) fn fill_blocks(&mut self, tile: PixelRect, step: u32, sums: &[SampleSum]) {
        for (corner, sum) in tile.blocks(step).zip(sums) {
            let colour = self.encoded(sum, 1, &self.display);
            let width = step.min(tile.max.x - corner.x) as usize;
            let i = self.index(corner);
            self.pixels[i..i + width].fill(colour);
        }
        for top in (tile.min.y..tile.max.y).step_by(step as usize) {
            let source = self.row(tile, top);
            for y in top + 1..(top + step).min(tile.max.y) {
                let row = self.row(tile, y);
                self.pixels.copy_within(source.clone(), row.start);
            }
        }
    }
}

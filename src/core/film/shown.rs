//! The pixels whose samples a picture on the screen shows.
//!
//! The film changes before its changes are on the screen: tiles arrive, or another picture is begun. So whoever uploads
//! the film's pixels notes here what they show.

use super::Film;
use crate::plan::{PixelRect, Plan};
use glam::UVec2;

/// For each pixel of a picture on the screen, the pixel whose samples it shows.
#[derive(Clone, Debug, Default)]
pub struct ShownPixels {
    size: UVec2,
    /// Size in pixels of the block whose colour a pixel shows; 0 for its own.
    steps: Vec<u8>,
}

impl ShownPixels {
    /// Notes that a rectangle of the film is on the screen now.
    pub fn update(&mut self, film: &Film, rect: PixelRect) {
        let size = film.size();
        if size != self.size {
            self.size = size;
            self.steps.clear();
            self.steps.resize(film.pixels().len(), 0);
        }
        for y in rect.min.y..rect.max.y {
            let row = film.index(UVec2::new(rect.min.x, y))..film.index(UVec2::new(rect.max.x, y));
            for (shown, &step) in self.steps[row.clone()]
                .iter_mut()
                .zip(&film.shown_step[row])
            {
                // A pixel without a sample keeps the colour that it had.
                if step != u8::MAX {
                    *shown = step;
                }
            }
        }
    }

    /// The pixel whose samples a pixel shows: itself, or the one that represents its block in a coarse pass.
    pub fn pixel(&self, pixel: UVec2) -> UVec2 {
        let index = pixel.y as usize * self.size.x as usize + pixel.x as usize;
        let is_inside = pixel.cmplt(self.size).all();
        match self.steps.get(index) {
            Some(&step) if is_inside && step > 0 => {
                Plan::representative(self.size, pixel, step.into())
            }
            _ => pixel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{SampleSum, TileSamples};
    use crate::plan::TILE_PX;
    use glam::Vec3;

    /// Adds the units of a pass, each pixel in a colour of its own.
    fn trace(film: &mut Film, pass: usize) {
        let plan = film.plan().clone();
        for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
            if unit.pass == pass {
                let sum = |pixel| {
                    let mut sum = SampleSum::default();
                    sum.add(colour(pixel));
                    sum
                };
                let sums = plan.pixels(unit).map(sum).collect();
                film.add(&TileSamples { unit, sums });
            }
        }
    }

    fn colour(pixel: UVec2) -> Vec3 {
        // Far enough apart to differ in 8 bits.
        Vec3::new(pixel.x as f32 / 64.0, pixel.y as f32 / 64.0, 0.5)
    }

    #[test]
    fn every_pixel_has_the_colour_of_the_pixel_that_it_shows() {
        let size = UVec2::new(TILE_PX + 7, 31);
        let mut film = Film::new(Plan::new(size, 4, 1), Vec3::ZERO);
        let mut shown = ShownPixels::default();
        for pass in 0..film.plan().pass_count() {
            trace(&mut film, pass);
            let rect = PixelRect {
                min: UVec2::ZERO,
                max: size,
            };
            shown.update(&film, rect);
            let before: Vec<[u8; 4]> = film.pixels().to_vec();
            let mut next = film.clone();
            // What is on the screen stays when the film begins another picture.
            next.restart(Plan::new(size, 16, 1), Vec3::ONE);
            for (i, pixel) in before.iter().enumerate() {
                let at = UVec2::new(i as u32 % size.x, i as u32 / size.x);
                let of = shown.pixel(at);
                assert_eq!(*pixel, film.display().encode(colour(of)), "{at} shows {of}");
            }
            shown.update(
                &next,
                PixelRect {
                    min: UVec2::ZERO,
                    max: UVec2::ONE,
                },
            );
            let corner = shown.pixel(UVec2::ZERO);
            assert_eq!(before[0], film.display().encode(colour(corner)));
        }
        assert_eq!(shown.pixel(UVec2::new(9, 8)), UVec2::new(9, 8));
    }
}

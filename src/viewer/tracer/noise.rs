//! The noise of a picture: the standard errors of its pixels.

use glam::UVec2;
use hitscope_core::Film;

/// The noise of a picture: standard errors of its pixels' luminance, in linear light where white is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// The mean over all pixels.
    pub mean: f64,
    /// The largest.
    pub worst: f64,
}

/// The noise of each tile, so that a new tile changes the total without a look at all pixels.
#[derive(Default)]
pub(super) struct TileNoise(Vec<Option<TileErrors>>);

/// The standard errors of a tile's pixels.
#[derive(Clone, Copy)]
struct TileErrors {
    sum: f64,
    worst: f64,
    count: usize,
}

impl TileNoise {
    /// Unknown noise of this many tiles.
    pub fn new(tiles: usize) -> Self {
        Self(vec![None; tiles])
    }

    /// Updates a tile that has received samples.
    pub fn update(&mut self, film: &Film, tile: usize) {
        let rect = film.plan().tile_rect(tile);
        let mut errors = TileErrors {
            sum: 0.0,
            worst: 0.0,
            count: 0,
        };
        for y in rect.min.y..rect.max.y {
            for x in rect.min.x..rect.max.x {
                let Some(error) = film.standard_error(UVec2::new(x, y)) else {
                    return;
                };
                errors.sum += error;
                errors.worst = errors.worst.max(error);
                errors.count += 1;
            }
        }
        self.0[tile] = Some(errors);
    }

    /// The noise of the picture; `None` while a pixel has fewer than two samples.
    pub fn total(&self) -> Option<Noise> {
        let (mut sum, mut worst, mut count) = (0.0, 0.0_f64, 0);
        for tile in &self.0 {
            let tile = tile.as_ref()?;
            sum += tile.sum;
            worst = worst.max(tile.worst);
            count += tile.count;
        }
        (count > 0).then(|| Noise {
            mean: sum / count as f64,
            worst,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::film::{SampleSum, TileSamples};
    use hitscope_core::plan::{Plan, WorkUnit};

    #[test]
    fn the_noise_is_known_once_each_pixel_has_two_samples_and_agrees_with_the_film() {
        let size = UVec2::new(60, 50);
        let plan = Plan::new(size, 1, 2);
        let mut film = Film::new(plan.clone(), Vec3::ZERO);
        let mut noise = TileNoise::new(plan.tile_count());
        for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
            assert_eq!(noise.total(), None, "{unit:?}");
            let shade = |pixel: UVec2, pass: usize| Vec3::splat((pass as u32 * pixel.x) as f32);
            let sum_of = |pixel| {
                let mut sum = SampleSum::default();
                assert!(sum.add(shade(pixel, unit.pass)));
                sum
            };
            let sums = plan.pixels(unit).map(sum_of).collect();
            let WorkUnit { tile, .. } = unit;
            film.add(&TileSamples { unit, sums });
            noise.update(&film, tile);
        }
        let total = noise.total().expect("two samples each");
        // Of 0 and x: variance x²/2, standard error x/2. Columns 0 to 59 have the mean 29.5. f64 has 16 digits, of which
        // the variance loses a few.
        assert!((total.mean - 29.5 / 2.0).abs() < 1e-9, "{total:?}");
        assert!((total.worst - 59.0 / 2.0).abs() < 1e-9, "{total:?}");
    }
}

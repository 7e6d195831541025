//! The noise of a picture while tiles arrive.

use hitscope_core::Film;
use hitscope_core::film::{Noise, NoiseSum};

/// The noise of each tile, so that a new tile changes the total without a look at all pixels.
#[derive(Default)]
pub(super) struct TileNoise(Vec<Option<NoiseSum>>);

impl TileNoise {
    /// Unknown noise of this many tiles.
    pub fn new(tiles: usize) -> Self {
        Self(vec![None; tiles])
    }

    /// Updates a tile that has received samples.
    pub fn update(&mut self, film: &Film, tile: usize) {
        let sum = NoiseSum::of(film, film.plan().tile_rect(tile));
        self.0[tile] = sum.or(self.0[tile]);
    }

    /// The noise of the picture; `None` while a pixel has fewer than two samples.
    pub fn total(&self) -> Option<Noise> {
        let mut total = NoiseSum::default();
        for tile in &self.0 {
            total.merge(tile.as_ref()?);
        }
        (!self.0.is_empty()).then(|| total.noise())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{UVec2, Vec3};
    use hitscope_core::film::{SampleSum, TileSamples};
    use hitscope_core::plan::{PixelRect, Plan, WorkUnit};

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
            film.add(TileSamples { unit, sums });
            noise.update(&film, tile);
        }
        let whole = NoiseSum::of(&film, PixelRect::whole(size)).expect("two samples each");
        let (total, whole) = (noise.total().expect("two samples each"), whole.noise());
        // Sums of 3000 numbers of 16 digits in another order.
        assert!(
            (total.mean / whole.mean - 1.0).abs() < 1e-12,
            "{total:?} {whole:?}"
        );
        assert!((total.worst / whole.worst - 1.0).abs() < 1e-12);
        // For 0 and x, the mean and the standard error are x/2, so that the mean error equals the mean luminance.
        assert!((total.mean - 1.0).abs() < 1e-6, "{total:?}");
    }
}

//! The noise of a picture: standard errors of its pixels' luminance.

use super::Film;
use crate::plan::PixelRect;
use crate::srgb::luminance_f64;
use glam::{UVec2, Vec3};

/// The noise of a picture: standard errors of its pixels' luminance relative to the mean luminance.
///
/// Neither exposure nor the unit of light changes it. Pixels that show no surface don't count. The errors are computed
/// from the variance of each pixel's samples as if these were independent; evenly distributed samples have smaller
/// errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// The mean of the relative standard errors.
    pub mean: f64,
    /// The largest relative standard error.
    pub worst: f64,
    /// The pixel with the largest standard error.
    pub worst_at: UVec2,
    /// The mean luminance, to which the errors are relative.
    pub luminance: f64,
}

/// Sums over pixels of a picture, from which [`Noise`] is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSum {
    /// Number of pixels that show a surface.
    count: u64,
    luminance: f64,
    error: f64,
    worst: f64,
    worst_at: UVec2,
}

impl NoiseSum {
    /// The sums over the pixels of a rectangle; `None` while one of them has fewer than two samples.
    ///
    /// # Panics
    /// If the rectangle reaches out of the picture.
    pub fn of(film: &Film, rect: PixelRect) -> Option<Self> {
        let mut sum = Self::default();
        for y in rect.min.y..rect.max.y {
            for x in rect.min.x..rect.max.x {
                let pixel = UVec2::new(x, y);
                let error = film.standard_error(pixel)?;
                if film.shows_surface(pixel) {
                    sum.merge(&Self {
                        count: 1,
                        luminance: luminance_f64(film.radiance(pixel).unwrap_or(Vec3::ZERO)),
                        error,
                        worst: error,
                        worst_at: pixel,
                    });
                }
            }
        }
        Some(sum)
    }

    /// Adds the sums over other pixels.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.luminance += other.luminance;
        self.error += other.error;
        if other.worst > self.worst {
            (self.worst, self.worst_at) = (other.worst, other.worst_at);
        }
    }

    /// The same sums for a larger picture in which this one starts at the pixel `place`.
    #[must_use]
    pub fn moved_by(self, place: UVec2) -> Self {
        Self {
            worst_at: self.worst_at + place,
            ..self
        }
    }

    /// The noise of these pixels; zero if they are black or show no surface.
    pub fn noise(&self) -> Noise {
        if self.luminance == 0.0 {
            return Noise::default();
        }
        let luminance = self.luminance / self.count as f64;
        Noise {
            mean: self.error / self.luminance,
            worst: self.worst / luminance,
            worst_at: self.worst_at,
            luminance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{SampleSum, Seen, TileSamples};
    use crate::plan::Plan;

    /// A film of four pixels with two samples each: two pixels show surfaces, one the background, one an environment.
    fn film(scale: f32) -> Film {
        let samples = [[1.0, 3.0], [4.0, 4.0], [9.0, 9.0], [0.0, 8.0]];
        let seen = [
            Seen::Surface,
            Seen::Surface,
            Seen::Background,
            Seen::Environment,
        ];
        let plan = Plan::new(UVec2::new(4, 1), 1, 2);
        let mut film = Film::new(plan.clone(), Vec3::ZERO);
        for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
            let sum_of = |pixel: UVec2| {
                let (mut sum, x) = (SampleSum::default(), pixel.x as usize);
                for k in plan.pass(unit.pass).samples() {
                    let grey = Vec3::splat(scale * samples[x][k as usize]);
                    assert!(sum.add_seen(grey, seen[x]));
                }
                sum
            };
            let sums = plan.pixels(unit).map(sum_of).collect();
            film.add(TileSamples { unit, sums });
        }
        film
    }

    #[test]
    fn noise_is_relative_to_the_luminance_of_the_pixels_that_show_a_surface() {
        for scale in [1.0, 1e-9, 1e9] {
            let film = film(scale);
            let rect = film.plan().tile_rect(0);
            let noise = NoiseSum::of(&film, rect).expect("two samples").noise();
            // Of 1 and 3: variance 2, standard error 1. The mean luminance of 2 and 4 is 3. Rounding to f32 is 2⁻²⁴.
            let is_near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
            assert!(is_near(noise.mean, 0.5 / 3.0), "{noise:?}");
            assert!(is_near(noise.worst, 1.0 / 3.0), "{noise:?}");
            assert!(
                is_near(noise.luminance, 3.0 * f64::from(scale)),
                "{noise:?}"
            );
            assert_eq!(noise.worst_at, UVec2::ZERO);
        }
    }

    #[test]
    fn noise_is_unknown_with_one_sample_and_none_where_all_is_black() {
        let one = Film::new(Plan::new(UVec2::ONE, 1, 1), Vec3::ZERO);
        assert_eq!(NoiseSum::of(&one, one.plan().tile_rect(0)), None);
        let black = film(0.0);
        let sum = NoiseSum::of(&black, black.plan().tile_rect(0));
        assert_eq!(sum.expect("two samples").noise(), Noise::default());
    }
}

//! What is shown of a film: its picture, with exposure and tone curve, or its noise.

use crate::settings::Settings;
use crate::tracer::Tracer;
use glam::UVec2;
use hitscope_core::Film;
use hitscope_core::colour::{ColourMap, ColourScale, colour_map};
use hitscope_core::integrator::Legend;
use hitscope_core::plan::PixelRect;
use hitscope_core::tone::Display;
use rayon::prelude::*;
use std::sync::LazyLock;

/// What is shown of a film.
#[derive(Clone, Copy, PartialEq)]
pub enum Look {
    /// The picture. The film's own display is the default one.
    Picture(Display),
    /// The standard error of each pixel, multiplied by the factor.
    Noise(f64),
}

impl Look {
    /// The look that these settings give a tracer's film.
    pub fn of(settings: &Settings, tracer: &Tracer) -> Self {
        if !tracer.shows_lit() {
            Self::plain()
        } else if settings.shows_noise {
            // Without light there is no noise, whatever the factor.
            Self::Noise(tracer.luminance().map_or(1.0, |luminance| 1.0 / luminance))
        } else {
            Self::Picture(settings.display())
        }
    }

    /// The film's own pixels.
    pub fn plain() -> Self {
        Self::Picture(Display::default())
    }

    fn is_plain(&self) -> bool {
        *self == Self::plain()
    }
}

/// The range of the colours for noise, in percent of the mean luminance.
const NOISE_RANGE: [f64; 2] = [0.01, 100.0];

fn noise_map() -> &'static ColourMap {
    colour_map("dusk").expect("in the table")
}

/// The scale of [`Look::Noise`].
pub fn noise_scale() -> ColourScale {
    ColourScale::new("Noise", "%", NOISE_RANGE, noise_map(), true).expect("a positive range")
}

/// The legend of [`Look::Noise`].
pub fn noise_legend() -> Legend {
    vec![noise_scale().entries(5)]
}

/// A film's pixels as they are shown.
pub struct Development {
    look: Look,
    size: UVec2,
    /// Empty for [`Look::plain`].
    pixels: Vec<[u8; 4]>,
}

impl Default for Development {
    fn default() -> Self {
        Self {
            look: Look::plain(),
            size: UVec2::ZERO,
            pixels: Vec::new(),
        }
    }
}

impl Development {
    /// The pixels of a film as they were last shown: all of them, row by row from the top.
    pub fn pixels<'a>(&'a self, film: &'a Film) -> &'a [[u8; 4]] {
        if self.pixels.len() == film.pixels().len() {
            &self.pixels
        } else {
            film.pixels()
        }
    }

    /// Updates the pixels of a film that changed; all of them if the look or the size changed. Returns all pixels, row
    /// by row from the top, and the rectangle to upload; `None` if nothing changed, also for a film of another size.
    pub fn update<'a>(
        &'a mut self,
        film: &'a Film,
        changed: Option<PixelRect>,
        look: Look,
    ) -> Option<(&'a [[u8; 4]], PixelRect)> {
        let size = film.size();
        let (is_same_look, is_same_size) = (look == self.look, size == self.size);
        let rect = match changed {
            Some(rect) if is_same_look && is_same_size => rect,
            // A new film has nothing to show before its first pixels change.
            None if is_same_look || !is_same_size => return None,
            _ => PixelRect::whole(size),
        };
        (self.look, self.size) = (look, size);
        let count = if look.is_plain() {
            0
        } else {
            size.element_product() as usize
        };
        self.pixels.resize(count, [0; 4]);
        if look.is_plain() {
            return Some((film.pixels(), rect));
        }
        let rows = self.pixels.par_chunks_mut(size.x as usize).enumerate();
        let rows = rows.skip(rect.min.y as usize);
        let rows = rows.take((rect.max.y - rect.min.y) as usize);
        rows.for_each(|(y, row)| {
            for x in rect.min.x..rect.max.x {
                row[x as usize] = shown(film, UVec2::new(x, y as u32), look);
            }
        });
        Some((&self.pixels, rect))
    }
}

/// The colour of a pixel. A pixel without samples, or without a known error, has its colour in the film.
fn shown(film: &Film, pixel: UVec2, look: Look) -> [u8; 4] {
    let in_film = film.pixels()[(pixel.y * film.size().x + pixel.x) as usize];
    match look {
        Look::Picture(display) => film.shown(pixel, &display).unwrap_or(in_film),
        Look::Noise(factor) => {
            let error = film.standard_error(pixel);
            error.map_or(in_film, |error| noise_colour(factor * error))
        }
    }
}

/// The colour of noise on a scale of 256 steps, which is fast enough for each pixel.
fn noise_colour(error: f64) -> [u8; 4] {
    static RAMP: LazyLock<Vec<[u8; 4]>> = LazyLock::new(|| {
        let colour = |step: u8| noise_map().colour(f32::from(step) / 255.0);
        (0..=255)
            .map(|step| Display::default().encode(colour(step)))
            .collect()
    });
    let [least, most] = NOISE_RANGE;
    let part = ((100.0 * error).max(least) / least).ln() / (most / least).ln();
    RAMP[(255.0 * part.min(1.0)).round() as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::film::{SampleSum, Seen, TileSamples};
    use hitscope_core::plan::Plan;
    use hitscope_core::tone::TONE_CURVES;

    const SIZE: UVec2 = UVec2::new(3, 2);

    /// A film whose pixels have these samples.
    fn film(samples: &[f32]) -> Film {
        let plan = Plan::new(SIZE, 1, samples.len() as u32);
        let mut film = Film::new(plan.clone(), Vec3::ZERO);
        for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
            let mut sum = SampleSum::default();
            let taken = plan.pass(unit.pass).samples();
            taken.for_each(|k| assert!(sum.add(Vec3::splat(samples[k as usize]))));
            let sums = plan.pixels(unit).map(|_| sum).collect();
            film.add(TileSamples { unit, sums });
        }
        film
    }

    fn all() -> PixelRect {
        PixelRect::whole(SIZE)
    }

    #[test]
    fn exposure_multiplies_light_before_it_is_clipped() {
        let film = film(&[4.0, 2.0]);
        let mut development = Development::default();
        let (pixels, _) = development
            .update(&film, Some(all()), Look::plain())
            .expect("changed");
        assert_eq!(pixels, [[255; 4]; 6]);
        let darker = Look::Picture(Display::new(-2.0, TONE_CURVES[0]));
        let (pixels, rect) = development.update(&film, None, darker).expect("a new look");
        assert_eq!((rect.min, rect.max), (UVec2::ZERO, SIZE));
        assert_eq!(pixels, [Display::default().encode(Vec3::splat(0.75)); 6]);
        assert!(development.update(&film, None, darker).is_none());
    }

    #[test]
    fn exposure_leaves_the_background_as_it_is() {
        let background = Vec3::new(0.1, 0.2, 0.3);
        let plan = Plan::new(SIZE, 1, 1);
        let mut film = Film::new(plan.clone(), background);
        let mut development = Development::default();
        let brighter = Look::Picture(Display::new(2.0, TONE_CURVES[1]));
        let expected = [Display::default().encode(background); 6];
        // Before there are samples, and with samples that hit nothing.
        let (pixels, _) = development
            .update(&film, Some(all()), brighter)
            .expect("changed");
        assert_eq!(pixels, expected);
        let mut sum = SampleSum::default();
        assert!(sum.add_seen(background, Seen::Background));
        let sums = vec![sum; 6];
        let unit = plan.unit(0);
        film.add(TileSamples { unit, sums });
        let (pixels, _) = development
            .update(&film, Some(all()), brighter)
            .expect("changed");
        assert_eq!(pixels, expected);
    }

    #[test]
    fn noise_has_the_colours_of_its_legend_and_needs_two_samples() {
        let mut development = Development::default();
        let one = film(&[0.5]);
        let noise = Look::Noise(1.0);
        assert!(development.update(&one, None, noise).is_none(), "unseen");
        let (pixels, _) = development
            .update(&one, Some(all()), noise)
            .expect("changed");
        assert_eq!(pixels, one.pixels());
        // The standard error of 0.4 and 0.6 is 0.1.
        let two = film(&[0.4, 0.6]);
        let (pixels, _) = development
            .update(&two, Some(all()), noise)
            .expect("changed");
        let (ten_percent, text) = noise_legend()[0][3].clone();
        assert_eq!(text, "10 %");
        let expected = Display::default().encode(ten_percent);
        // A step of the ramp is at most two steps of sRGB.
        for (channel, expected) in pixels[0].into_iter().zip(expected) {
            assert!(channel.abs_diff(expected) <= 2, "{pixels:?} {expected}");
        }
    }
}

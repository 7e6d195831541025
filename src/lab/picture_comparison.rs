//! The error figures of a picture relative to a reference.

use glam::{UVec2, Vec3};
use hitscope_core::picture::{PictureEncoding, PictureFile};
use hitscope_core::srgb::to_display;
use serde::Serialize;

/// The differences of a picture A from a reference B.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureComparison {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether the numbers are linear RGB; else they are sRGB from 0 to 1.
    pub is_linear: bool,
    /// The channels. Alpha is one of them if a picture has transparent pixels.
    pub channels: Vec<ChannelFigures>,
    /// The mean of the squared differences over pixels and channels.
    pub mse: f64,
    /// Its square root.
    pub rmse: f64,
    /// The peak signal-to-noise ratio in decibels, for a peak of 1; `None` if there is no difference.
    pub psnr_db: Option<f64>,
    /// The mean of the squared differences relative to the reference, of linear pictures; see [`RELATIVE_FLOOR`].
    pub relative_mse: Option<f64>,
    /// The largest difference; `None` if there is none.
    pub worst: Option<WorstPixel>,
    /// The tolerance below.
    pub tolerance: f64,
    /// Pixels with a channel that differs by more than the tolerance.
    pub pixels_over_tolerance: usize,
    /// The same in percent of all pixels.
    pub percent_over_tolerance: f64,
    /// Pixels of which a number isn't finite in one of the pictures. They count in no other figure.
    pub non_finite_pixels: usize,
}

/// The figures of a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelFigures {
    /// `R`, `G`, `B` or `A`.
    pub name: &'static str,
    /// The mean in A.
    pub mean_a: f64,
    /// The mean in B.
    pub mean_b: f64,
    /// The mean of the squared differences.
    pub mse: f64,
}

/// The pixel with the largest difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstPixel {
    /// The pixel, from the top left.
    pub pixel: [u32; 2],
    /// The channel.
    pub channel: &'static str,
    /// Its value in A.
    pub a: f32,
    /// Its value in B.
    pub b: f32,
    /// The magnitude of the difference.
    pub difference: f64,
}

/// ε of the relative MSE, the mean of (a − b)²/(b² + ε): it keeps dark pixels from dominating.
///
/// Source: Rousselle, Knaus, Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization", SIGGRAPH
/// Asia 2011; 0.01 is what most comparisons since then use.
pub const RELATIVE_FLOOR: f64 = 0.01;

const NAMES: [&str; 4] = ["R", "G", "B", "A"];

/// Why pictures can't be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the pictures differ in size: {}x{} and {}x{} pixels", a.x, a.y, b.x, b.y)]
pub struct SizesDiffer {
    a: UVec2,
    b: UVec2,
}

/// Two pictures whose numbers can be compared.
#[derive(Clone, Debug)]
pub struct PicturePair {
    a: PictureFile,
    b: PictureFile,
    /// The number of channels that are compared.
    channel_count: usize,
}

impl PicturePair {
    /// A pair of pictures. If one is linear and one is not, the other is made linear.
    ///
    /// # Errors
    /// [`SizesDiffer`].
    pub fn new(a: PictureFile, b: PictureFile) -> Result<Self, SizesDiffer> {
        if a.size != b.size {
            let (a, b) = (a.size, b.size);
            return Err(SizesDiffer { a, b });
        }
        let (a, b) = if a.encoding == b.encoding {
            (a, b)
        } else {
            (a.into_linear(), b.into_linear())
        };
        let mut texels = a.texels.iter().chain(&b.texels);
        let has_alpha = texels.any(|texel| texel[3] != 1.0);
        Ok(Self {
            channel_count: 3 + usize::from(has_alpha),
            a,
            b,
        })
    }

    /// The error figures. Pixels that differ by more than `tolerance` are counted.
    pub fn compared(&self, tolerance: f64) -> PictureComparison {
        let is_linear = self.a.encoding == PictureEncoding::Linear;
        let mut sums = Sums::default();
        for (index, (a, b)) in self.a.texels.iter().zip(&self.b.texels).enumerate() {
            sums.add(
                index,
                &a[..self.channel_count],
                &b[..self.channel_count],
                tolerance,
            );
        }
        let UVec2 {
            x: width,
            y: height,
        } = self.a.size;
        let pixels = sums.finite_pixels.max(1) as f64;
        let channels: Vec<ChannelFigures> = (0..self.channel_count)
            .map(|channel| ChannelFigures {
                name: NAMES[channel],
                mean_a: sums.a[channel] / pixels,
                mean_b: sums.b[channel] / pixels,
                mse: sums.squares[channel] / pixels,
            })
            .collect();
        let mean = |total: f64| total / (pixels * self.channel_count as f64);
        let mse = mean(sums.squares.iter().sum());
        let all = f64::from(width) * f64::from(height);
        PictureComparison {
            size: [width, height],
            is_linear,
            channels,
            mse,
            rmse: mse.sqrt(),
            psnr_db: (mse > 0.0).then(|| -10.0 * mse.log10()),
            relative_mse: is_linear.then(|| mean(sums.relative_squares)),
            worst: sums.worst.map(|worst| WorstPixel {
                pixel: [worst.index as u32 % width, worst.index as u32 / width],
                channel: NAMES[worst.channel],
                a: self.a.texels[worst.index][worst.channel],
                b: self.b.texels[worst.index][worst.channel],
                difference: worst.difference,
            }),
            tolerance,
            pixels_over_tolerance: sums.over_tolerance,
            percent_over_tolerance: 100.0 * sums.over_tolerance as f64 / all,
            non_finite_pixels: sums.non_finite_pixels,
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.a.size
    }

    /// A picture of the differences for the screen: the magnitude in each colour channel, times `gain`. Pixels that aren't
    /// finite in both pictures are magenta.
    pub fn difference_picture(&self, gain: f64) -> Vec<[u8; 4]> {
        let is_linear = self.a.encoding == PictureEncoding::Linear;
        let shown = |difference: f64| {
            let value = (gain * difference).min(1.0) as f32;
            let value = if is_linear { to_display(value) } else { value };
            (255.0 * value).round() as u8
        };
        let pixel = |(a, b): (&[f32; 4], &[f32; 4])| {
            let difference = Vec3::from_slice(a).as_dvec3() - Vec3::from_slice(b).as_dvec3();
            if !difference.is_finite() {
                return [255, 0, 255, 255];
            }
            let [r, g, b] = difference.abs().to_array().map(shown);
            [r, g, b, 255]
        };
        self.a
            .texels
            .iter()
            .zip(&self.b.texels)
            .map(pixel)
            .collect()
    }
}

/// The sums over all pixels.
#[derive(Default)]
struct Sums {
    a: [f64; 4],
    b: [f64; 4],
    squares: [f64; 4],
    relative_squares: f64,
    worst: Option<Worst>,
    over_tolerance: usize,
    finite_pixels: usize,
    non_finite_pixels: usize,
}

#[derive(Clone, Copy)]
struct Worst {
    index: usize,
    channel: usize,
    difference: f64,
}

impl Sums {
    fn add(&mut self, index: usize, a: &[f32], b: &[f32], tolerance: f64) {
        if !a.iter().chain(b).all(|x| x.is_finite()) {
            self.non_finite_pixels += 1;
            return;
        }
        self.finite_pixels += 1;
        let mut is_over = false;
        for (channel, (a, b)) in a.iter().zip(b).enumerate() {
            let (a, b) = (f64::from(*a), f64::from(*b));
            let (difference, square) = ((a - b).abs(), (a - b) * (a - b));
            self.a[channel] += a;
            self.b[channel] += b;
            self.squares[channel] += square;
            self.relative_squares += square / (b * b + RELATIVE_FLOOR);
            is_over |= difference > tolerance;
            let least = self.worst.map_or(0.0, |worst| worst.difference);
            if difference > least {
                self.worst = Some(Worst {
                    index,
                    channel,
                    difference,
                });
            }
        }
        self.over_tolerance += usize::from(is_over);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(encoding: PictureEncoding, texels: &[[f32; 4]]) -> PictureFile {
        PictureFile {
            size: UVec2::new(2, texels.len() as u32 / 2),
            encoding,
            texels: texels.to_vec(),
        }
    }

    /// Four grey pixels, all but one equal to the reference.
    fn pair(encoding: PictureEncoding) -> PicturePair {
        let grey = [0.5, 0.5, 0.5, 1.0];
        let b = picture(encoding, &[grey; 4]);
        let a = picture(encoding, &[grey, grey, [0.5, 0.9, 0.5, 1.0], grey]);
        PicturePair::new(a, b).expect("of one size")
    }

    #[test]
    fn the_figures_of_one_different_pixel_are_known() {
        for (encoding, is_linear) in [
            (PictureEncoding::Display, false),
            (PictureEncoding::Linear, true),
        ] {
            let found = pair(encoding).compared(0.1);
            let square = 0.4f64 * 0.4;
            // f32 holds 0.9 up to 2⁻²⁵.
            let near = |x: f64, expected: f64| (x - expected).abs() < 1e-7;
            assert!(near(found.mse, square / 12.0), "{found:?}");
            assert!(near(found.rmse, (square / 12.0).sqrt()));
            let psnr = found.psnr_db.expect("a difference");
            assert!((psnr - -10.0 * (square / 12.0).log10()).abs() < 1e-5);
            let relative = is_linear.then_some(square / (0.25 + RELATIVE_FLOOR) / 12.0);
            assert_eq!(found.relative_mse.is_some(), relative.is_some());
            assert!(near(
                found.relative_mse.unwrap_or(0.0),
                relative.unwrap_or(0.0)
            ));
            let worst = found.worst.expect("a difference");
            assert_eq!((worst.pixel, worst.channel), ([0, 1], "G"));
            assert!(near(worst.difference, 0.4));
            assert_eq!(found.percent_over_tolerance, 25.0);
            let [r, g, b] = &found.channels[..] else {
                panic!("opaque pictures have three channels");
            };
            assert_eq!((r.mean_a, r.mse, b.mean_b), (0.5, 0.0, 0.5));
            assert!(near(g.mean_a, 0.6) && near(g.mse, square / 4.0));
        }
    }

    #[test]
    fn equal_pictures_have_no_difference() {
        let mut same = pair(PictureEncoding::Display);
        same.a = same.b.clone();
        let found = same.compared(0.0);
        assert_eq!((found.mse, found.psnr_db, found.worst), (0.0, None, None));
        assert_eq!(found.pixels_over_tolerance, 0);
        assert!(
            same.difference_picture(10.0)
                .iter()
                .all(|p| *p == [0, 0, 0, 255])
        );
    }

    #[test]
    fn non_finite_pixels_are_counted_apart_and_alpha_is_a_channel() {
        let mut found = pair(PictureEncoding::Linear);
        found.a.texels[0][2] = f32::NAN;
        let figures = found.compared(0.1);
        assert_eq!(
            (figures.non_finite_pixels, figures.pixels_over_tolerance),
            (1, 1)
        );
        assert!(figures.mse.is_finite());
        let shown = found.difference_picture(1.0);
        assert_eq!(shown[0], [255, 0, 255, 255]);
        assert_eq!((shown[1], shown[2][0]), ([0, 0, 0, 255], 0));
        assert!(shown[2][1] > 100);
        let mut clear = pair(PictureEncoding::Display);
        clear.a.texels[0][3] = 0.0;
        let (a, b) = (clear.a, clear.b);
        let four = PicturePair::new(a, b).expect("of one size").compared(0.1);
        assert_eq!(four.channels.len(), 4);
        assert_eq!(four.worst.expect("a difference").channel, "A");
    }

    #[test]
    fn a_screen_picture_becomes_linear_beside_a_linear_one() {
        let display = picture(PictureEncoding::Display, &[[1.0, 0.0, 0.5, 1.0]; 2]);
        let linear = display.clone().into_linear();
        let found = PicturePair::new(display, linear)
            .expect("of one size")
            .compared(0.0);
        assert!(found.is_linear && found.worst.is_none());
        let small = picture(PictureEncoding::Linear, &[[0.0; 4]; 2]);
        let large = picture(PictureEncoding::Linear, &[[0.0; 4]; 4]);
        let error = PicturePair::new(small, large).expect_err("sizes");
        assert_eq!(
            error.to_string(),
            "the pictures differ in size: 2x1 and 2x2 pixels"
        );
    }
}

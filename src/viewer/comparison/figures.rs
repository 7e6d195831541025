//! Figures of the differences between both sides.

use super::rasterized::RasterizedPicture;
use glam::{UVec2, Vec2, Vec3};
use hitscope_core::Intersector;
use hitscope_core::picture::{PictureEncoding, PictureFile};
use hitscope_lab::picture_comparison::{PictureComparison, PicturePair};
use rayon::prelude::*;
use std::sync::Arc;

/// The pixels of a side.
pub enum Pixels {
    /// sRGB with alpha 255, as on the screen.
    Display(Vec<[u8; 4]>),
    /// Linear RGB without exposure.
    Linear(Vec<Vec3>),
    /// Pixels of a file.
    File(Arc<PictureFile>),
}

/// The pictures to compare.
pub struct ComparedPictures {
    /// Width and height of both sides.
    pub size: UVec2,
    /// Side A.
    pub a: Pixels,
    /// Side B.
    pub b: Pixels,
    /// How visible triangles are compared, if a side is rasterized and both show the same scene.
    pub visibility: Option<Visibility>,
}

/// How the visible triangles of both sides are found.
pub enum Visibility {
    /// The rasterizer, and rays through the centres of the pixels.
    TracedAndRasterized(Arc<dyn Intersector>, Arc<RasterizedPicture>),
    /// The rasterizer, for both sides.
    Rasterized([Arc<RasterizedPicture>; 2]),
}

/// Figures of the differences.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// The differences of the colours.
    pub picture: PictureComparison,
    /// The differences of the visible triangles, if a side is rasterized.
    pub visibility: Option<VisibilityDifference>,
}

/// The pixels at whose centres both sides show different triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VisibilityDifference {
    /// Pixels that show a triangle in either picture.
    pub covered: usize,
    /// Pixels that differ.
    pub different: usize,
}

impl Pixels {
    fn into_picture(self, size: UVec2) -> PictureFile {
        let part = |x: u8| f32::from(x) / 255.0;
        let (encoding, texels) = match self {
            Self::File(picture) => return (*picture).clone(),
            Self::Display(pixels) => {
                let texels = pixels.into_iter().map(|pixel| pixel.map(part));
                (PictureEncoding::Display, texels.collect())
            }
            Self::Linear(pixels) => {
                let texels = pixels.into_iter().map(|rgb| rgb.extend(1.0).to_array());
                (PictureEncoding::Linear, texels.collect())
            }
        };
        PictureFile {
            size,
            encoding,
            texels,
        }
    }
}

impl ComparedPictures {
    /// Computes the figures. A pixel counts as different if any channel differs.
    ///
    /// # Errors
    /// If the pictures have different sizes.
    pub fn figures(self) -> Result<Figures, String> {
        let pictures = [self.a, self.b].map(|pixels| pixels.into_picture(self.size));
        let [a, b] = pictures;
        let pair = PicturePair::new(a, b).map_err(|error| error.to_string())?;
        Ok(Figures {
            picture: pair.compared(0.0),
            visibility: self.visibility.as_ref().map(Visibility::difference),
        })
    }
}

impl Visibility {
    fn difference(&self) -> VisibilityDifference {
        match self {
            Self::TracedAndRasterized(intersector, picture) => traced(&**intersector, picture),
            Self::Rasterized([a, b]) => {
                let pairs = a.triangles.iter().zip(&b.triangles);
                let covered = pairs.clone().filter(|(a, b)| (**a, **b) != (0, 0));
                VisibilityDifference {
                    covered: covered.count(),
                    different: pairs.filter(|(a, b)| a != b).count(),
                }
            }
        }
    }
}

/// Traces a ray through the centre of each pixel of a rasterized picture.
fn traced(intersector: &dyn Intersector, picture: &RasterizedPicture) -> VisibilityDifference {
    let context = &picture.request.context;
    let (camera, scene) = (&context.camera, &context.scene);
    let width = camera.resolution().x as usize;
    let of_row = |(y, row): (usize, &[u32])| {
        let ray = |x: usize| camera.ray(UVec2::new(x as u32, y as u32), Vec2::splat(0.5));
        let rays: Vec<_> = (0..row.len()).map(ray).collect();
        let mut hits = vec![None; rays.len()];
        intersector.coherent_hits(&rays, &mut hits);
        let traced = hits.iter().map(|hit| match hit {
            Some(hit) if scene.is_triangle(hit.primitive) => Some(hit.primitive + 1),
            // A shape that isn't rasterized: the pixel differs whatever is drawn there.
            Some(_) => None,
            None => Some(0),
        });
        let pairs = row.iter().zip(traced);
        pairs.fold([0, 0], |[covered, different], (drawn, traced)| {
            let is_covered = *drawn != 0 || traced != Some(0);
            let differs = traced != Some(*drawn);
            [
                covered + usize::from(is_covered),
                different + usize::from(differs),
            ]
        })
    };
    let rows = picture.triangles.par_chunks(width.max(1)).enumerate();
    let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
    let [covered, different] = rows.map(of_row).reduce(|| [0, 0], sum);
    VisibilityDifference { covered, different }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_pixels_are_counted_in_any_encoding() {
        let size = UVec2::new(2, 1);
        let figures = |a, b| {
            let compare = ComparedPictures {
                size,
                a,
                b,
                visibility: None,
            };
            compare.figures().expect("of one size").picture
        };
        let shown = |x| Pixels::Display(vec![[x, x, x, 255], [7, 8, 9, 255]]);
        assert_eq!(figures(shown(5), shown(5)).pixels_over_tolerance, 0);
        assert_eq!(figures(shown(5), shown(6)).pixels_over_tolerance, 1);
        let linear = |x| Pixels::Linear(vec![Vec3::splat(x), Vec3::ZERO]);
        let found = figures(linear(0.5), linear(1.0));
        assert!(found.is_linear);
        assert_eq!((found.mse, found.pixels_over_tolerance), (0.125, 1));
        let file = PictureFile {
            size: UVec2::new(1, 1),
            encoding: PictureEncoding::Linear,
            texels: vec![[0.0; 4]],
        };
        let compare = ComparedPictures {
            size,
            a: linear(0.0),
            b: Pixels::File(Arc::new(file)),
            visibility: None,
        };
        assert!(compare.figures().is_err());
    }
}

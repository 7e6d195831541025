//! Pictures from files: PNG, OpenEXR and Radiance HDR.

use crate::obj::linear_picture::{Memory, Picture, Problem, linear_decoder};
use crate::obj::{self, LoadError, printable};
use crate::progress::Progress;
use crate::srgb::from_display;
use glam::{UVec2, Vec3};
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder as _, ImageError, Limits};
use std::io::Cursor;
use std::path::Path;

/// What the numbers of a picture mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureEncoding {
    /// sRGB, from 0 to 1.
    Display,
    /// Linear RGB.
    Linear,
}

/// A picture from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFile {
    /// Width and height in pixels.
    pub size: UVec2,
    /// What the colours mean.
    pub encoding: PictureEncoding,
    /// Red, green, blue and alpha, row by row from the top, as the file has them. Alpha is 1 if the file has none, or isn't
    /// a PNG file.
    pub texels: Vec<[f32; 4]>,
}

/// The bytes of a texel while a picture is read.
const BYTES_PER_TEXEL: u64 = (size_of::<[f32; 4]>() + size_of::<Vec3>()) as u64;
/// What a PNG file begins with.
const PNG_START: &[u8] = b"\x89PNG\r\n\x1a\n";

impl PictureFile {
    /// Whether the extension of a name is that of a picture.
    pub fn is_name_of_one(path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default();
        ["png", "exr", "hdr"]
            .iter()
            .any(|known| extension.eq_ignore_ascii_case(known))
    }

    /// Loads a picture with at most `max_memory` bytes. The format is recognised by the file's first bytes.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(path: &Path, max_memory: u64, progress: &Progress) -> Result<Self, LoadError> {
        let unreadable = |source| LoadError::Unreadable {
            path: path.to_owned(),
            source,
        };
        let bytes = obj::read_past(path, max_memory).map_err(unreadable)?;
        Self::read(&bytes, max_memory, progress).map_err(|problem| problem.in_file(path))
    }

    fn read(bytes: &[u8], max_memory: u64, progress: &Progress) -> Result<Self, Problem> {
        progress.check()?;
        let memory = Memory {
            max_bytes: max_memory.saturating_sub(bytes.len() as u64),
            bytes_per_texel: BYTES_PER_TEXEL,
        };
        if bytes.starts_with(PNG_START) {
            return Ok(obj::fenced("decoding", || png(bytes, memory))??);
        }
        let decode = linear_decoder(bytes);
        let decode = decode
            .ok_or_else(|| "neither a PNG nor an OpenEXR nor a Radiance HDR picture".to_owned())?;
        let Picture { size, texels } =
            obj::fenced("decoding", || decode(bytes, memory, progress))??;
        Ok(Self {
            size,
            encoding: PictureEncoding::Linear,
            texels: texels
                .iter()
                .map(|texel| texel.extend(1.0).to_array())
                .collect(),
        })
    }

    /// The same picture in linear RGB.
    #[must_use]
    pub fn into_linear(mut self) -> Self {
        if self.encoding == PictureEncoding::Display {
            for [r, g, b, _] in &mut self.texels {
                [*r, *g, *b] = from_display(Vec3::new(*r, *g, *b)).to_array();
            }
            self.encoding = PictureEncoding::Linear;
        }
        self
    }
}

/// Decodes a PNG picture of any depth.
fn png(bytes: &[u8], memory: Memory) -> Result<PictureFile, String> {
    let message = |error: ImageError| printable(error.to_string().trim());
    let mut limits = Limits::default();
    limits.max_alloc = Some(memory.max_bytes);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(message)?;
    let size = UVec2::from(decoder.dimensions());
    let count = u64::from(size.x) * u64::from(size.y);
    // Decoded, and converted.
    let needed = count
        .saturating_mul(memory.bytes_per_texel)
        .saturating_add(decoder.total_bytes());
    if needed > memory.max_bytes {
        let (megabytes, left) = (needed.div_ceil(1 << 20), memory.max_bytes >> 20);
        return Err(format!(
            "{} x {} pixels need {megabytes} MB of memory, but only {left} MB is left (--max-memory)",
            size.x, size.y
        ));
    }
    let picture = DynamicImage::from_decoder(decoder)
        .map_err(message)?
        .into_rgba32f();
    Ok(PictureFile {
        size,
        encoding: PictureEncoding::Display,
        texels: picture.pixels().map(|pixel| pixel.0).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};

    fn encoded(picture: impl Into<DynamicImage>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let written = picture.into().write_to(&mut bytes, ImageFormat::Png);
        written.expect("encoded");
        bytes.into_inner()
    }

    fn read(bytes: &[u8], max_memory: u64) -> Result<PictureFile, String> {
        let read = PictureFile::read(bytes, max_memory, &Progress::default());
        read.map_err(|problem| problem.in_file(Path::new("a")).to_string())
    }

    #[test]
    fn a_png_has_its_colours_and_alpha_from_0_to_1() {
        let picture = RgbaImage::from_fn(3, 2, |x, y| Rgba([51 * x as u8, 0, 255, 255 * y as u8]));
        let read = read(&encoded(picture), 1 << 20).expect("a picture");
        assert_eq!(
            (read.size, read.encoding),
            (UVec2::new(3, 2), PictureEncoding::Display)
        );
        assert_eq!(read.texels[1], [0.2, 0.0, 1.0, 0.0]);
        assert_eq!(read.texels[4][3], 1.0);
        let linear = read.into_linear();
        assert!(
            (linear.texels[2][0] - 0.132_868_3).abs() < 1e-6,
            "{:?}",
            linear.texels[2]
        );
        assert_eq!(linear.encoding, PictureEncoding::Linear);
    }

    #[test]
    fn what_is_no_picture_or_too_large_is_refused() {
        let small = encoded(RgbImage::from_pixel(100, 100, Rgb([1, 2, 3])));
        let message = read(&small, 100_000).expect_err("too large");
        assert!(message.contains("need 1 MB of memory"), "{message}");
        let message = read(&small[..small.len() / 2], 1 << 30).expect_err("truncated");
        assert!(message.starts_with("a: "), "{message}");
        assert_eq!(
            read(b"v 1 2 3", 1 << 20).expect_err("an OBJ"),
            "a: neither a PNG nor an OpenEXR nor a Radiance HDR picture"
        );
        for (name, is_one) in [
            ("a.PNG", true),
            ("a.exr", true),
            ("a.hdr", true),
            ("a.obj", false),
        ] {
            assert_eq!(
                PictureFile::is_name_of_one(Path::new(name)),
                is_one,
                "{name}"
            );
        }
    }
}

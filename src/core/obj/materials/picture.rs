//! Decoder of texture pictures: PNG and JPEG in 8 bits, OpenEXR and Radiance HDR as linear numbers.

use super::linear_picture::{self, Decoder, Memory, Problem, linear_decoder};
use super::stored_file;
use crate::brightness::MAX_BRIGHTNESS;
use crate::mesh::Texture;
use crate::obj::error::{printable, reason};
use crate::obj::fence::fenced;
use crate::progress::Progress;
use glam::{UVec2, Vec3};
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;

/// A decoded picture.
pub(crate) struct Picture {
    pub texture: Texture,
    /// What is wrong with the file.
    pub fault: Option<String>,
}

/// Reads and decodes a picture with at most `max_bytes` of memory.
///
/// # Errors
/// The reason; see [`decode`].
pub(crate) fn read(path: &Path, max_bytes: u64, progress: &Progress) -> Result<Picture, String> {
    let bytes = stored_file::read(path, max_bytes).map_err(|error| reason(&error))?;
    let name = path.to_string_lossy();
    let left = max_bytes.saturating_sub(bytes.len() as u64);
    decode(&name, &bytes, left, progress)
}

/// Decodes a picture with at most `max_bytes` of memory, not counting the file's bytes.
///
/// # Errors
/// The reason. It never quotes the content of a file that isn't a picture.
pub(super) fn decode(
    name: &str,
    bytes: &[u8],
    max_bytes: u64,
    progress: &Progress,
) -> Result<Picture, String> {
    if let Some(decoder) = linear_decoder(bytes) {
        return linear(name, bytes, decoder, max_bytes, progress);
    }
    let (picture, alpha) = fenced("decoding", || pixels(bytes, max_bytes))??;
    let size = UVec2::new(picture.width(), picture.height());
    let texture = Texture::new(name, size, picture.into_raw());
    Ok(Picture {
        texture: texture.ok_or("the picture is empty")?.with_alpha(alpha),
        fault: (bytes.starts_with(JPEG_START) && !has_jpeg_end(bytes))
            .then(|| "truncated file: part of the picture is missing".to_owned()),
    })
}

/// Decodes a picture in a linear format.
fn linear(
    name: &str,
    bytes: &[u8],
    decode: Decoder,
    max_bytes: u64,
    progress: &Progress,
) -> Result<Picture, String> {
    let memory = Memory {
        max_bytes,
        bytes_per_texel: size_of::<Vec3>() as u64,
    };
    let decoded = fenced("decoding", || decode(bytes, memory, progress))?;
    let linear_picture::Picture { size, texels } = decoded.map_err(|problem| match problem {
        Problem::Content(message) => message,
        Problem::Cancelled => "cancelled".to_owned(),
    })?;
    let all = 3 * u64::from(size.x) * u64::from(size.y);
    let (texture, replaced) = Texture::linear(name, size, texels).ok_or("the picture is empty")?;
    let fault = (replaced > 0).then(|| {
        format!(
            "{replaced} of {all} numbers in the picture can't be used: larger ones than {MAX_BRIGHTNESS:.1e} count as this limit, negative and other ones as 0"
        )
    });
    Ok(Picture { texture, fault })
}

/// The pixels, and their alpha values unless all are opaque.
fn pixels(bytes: &[u8], max_bytes: u64) -> Result<(image::RgbImage, Vec<u8>), String> {
    // Some messages end with a newline.
    let message = |error: image::ImageError| printable(error.to_string().trim());
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| message(error.into()))?;
    let Some(format @ (ImageFormat::Png | ImageFormat::Jpeg)) = reader.format() else {
        return Err("not a PNG, JPEG, OpenEXR or Radiance HDR picture".to_owned());
    };
    let mut limits = Limits::default();
    limits.max_alloc = Some(max_bytes);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(message)?;
    let needed = needed_bytes(&decoder, format, bytes.len() as u64);
    let megabytes = needed.div_ceil(1 << 20);
    if needed > max_bytes {
        let left = max_bytes >> 20;
        return Err(format!(
            "decoding needs {megabytes} MB of memory, but only {left} MB is left (--max-memory)"
        ));
    }
    // Try the allocation first: a failure in the decoder would abort the program.
    let memory = usize::try_from(needed).unwrap_or(usize::MAX);
    if Vec::<u8>::new().try_reserve_exact(memory).is_err() {
        return Err(format!("can't allocate {megabytes} MB"));
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(message)?;
    let of_16_bits = |alpha: u16| (alpha >> 8) as u8;
    let mut alpha: Vec<u8> = match &decoded {
        DynamicImage::ImageRgba8(picture) => picture.pixels().map(|p| p[3]).collect(),
        DynamicImage::ImageLumaA8(picture) => picture.pixels().map(|p| p[1]).collect(),
        DynamicImage::ImageRgba16(picture) => picture.pixels().map(|p| of_16_bits(p[3])).collect(),
        DynamicImage::ImageLumaA16(picture) => picture.pixels().map(|p| of_16_bits(p[1])).collect(),
        _ => Vec::new(),
    };
    if alpha.iter().all(|&alpha| alpha == u8::MAX) {
        alpha = Vec::new();
    }
    Ok((decoded.into_rgb8(), alpha))
}

/// The peak memory of decoding and of the conversion to 8-bit RGB, with alpha if the picture has it, in bytes.
fn needed_bytes(decoder: &impl ImageDecoder, format: ImageFormat, file_bytes: u64) -> u64 {
    /// 16-bit coefficients of up to four components. A progressive JPEG keeps them for the whole picture.
    const JPEG_BYTES_PER_PIXEL: u64 = 8;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    let decoded = decoder.total_bytes();
    let converted = match decoder.color_type() {
        ColorType::Rgb8 => 0,
        colour if colour.has_alpha() => 4 * pixels,
        _ => 3 * pixels,
    };
    let working = match format {
        // The decoder copies the file.
        ImageFormat::Jpeg => JPEG_BYTES_PER_PIXEL * pixels + file_bytes,
        _ => 0,
    };
    // The coefficients are freed before the conversion.
    decoded.saturating_add(working.max(converted))
}

/// The start marker (SOI).
const JPEG_START: &[u8] = b"\xFF\xD8";

/// Whether a JPEG has its end marker (EOI). If it is missing, the decoder fills missing rows with grey.
///
/// Source: ITU-T T.81 (1992), B.1.1, markers and their segments.
fn has_jpeg_end(bytes: &[u8]) -> bool {
    let mut at = JPEG_START.len();
    while let Some(found) = memchr::memchr(0xFF, bytes.get(at..).unwrap_or_default()) {
        at += found + 1;
        match bytes.get(at) {
            Some(0xD9) => return true,
            // A fill byte before the marker.
            Some(0xFF) | None => {}
            // A data byte 0xFF, a restart marker, a marker without a segment, or a second start marker.
            Some(0x00 | 0x01 | 0xD0..=0xD8) => at += 1,
            Some(_) => {
                let length = bytes
                    .get(at + 1..at + 3)
                    .map(|b| u16::from_be_bytes([b[0], b[1]]));
                at += 1 + usize::from(length.unwrap_or(0));
            }
        }
    }
    false
}

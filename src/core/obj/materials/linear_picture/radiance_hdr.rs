//! Decoder of Radiance HDR pictures (`.hdr`, `.pic`).
//!
//! Source: G. Ward, "Radiance File Formats", <https://radsite.lbl.gov/radiance/refer/filefmts.pdf>.

use super::{Cancellable, Memory, Picture, Problem, black};
use crate::obj::printable;
use crate::progress::{Cancelled, Progress};
use glam::{UVec2, Vec3};
use image::codecs::hdr::{HdrDecoder, HdrMetadata};
use image::error::UnsupportedErrorKind;
use image::{ImageDecoder, ImageError};
use std::io::{ErrorKind, Read};

/// What a file starts with. `RADIANCE` or another program's name follows.
pub(super) const START: &[u8] = b"#?";
/// The only first line that the decoder accepts.
const SIGNATURE: &[u8] = b"#?RADIANCE";

/// Decodes a picture. Its radiance is the stored one divided by `EXPOSURE` and `COLORCORR`, as the format demands.
pub(super) fn decode(
    bytes: &[u8],
    memory: Memory,
    progress: &Progress,
) -> Result<Picture, Problem> {
    let first_line = memchr::memchr(b'\n', bytes).unwrap_or(bytes.len());
    let rest = Cancellable::new(&bytes[first_line..], progress);
    let problem = |error: ImageError| match progress.check() {
        Ok(()) => Problem::Content(message(&error)),
        Err(Cancelled) => Problem::Cancelled,
    };
    let decoder = HdrDecoder::new(SIGNATURE.chain(rest)).map_err(problem)?;
    let divisor = divisor(&decoder.metadata())?;
    let size = UVec2::from(decoder.dimensions());
    let mut texels = black(size, memory)?;
    let read = decoder.read_image(bytemuck::cast_slice_mut(&mut texels));
    read.map_err(problem)?;
    if divisor != Vec3::ONE {
        texels.iter_mut().for_each(|texel| *texel /= divisor);
    }
    Ok(Picture { size, texels })
}

/// By what stored colours are divided.
fn divisor(header: &HdrMetadata) -> Result<Vec3, String> {
    let exposure = header.exposure.unwrap_or(1.0);
    let (r, g, b) = header.color_correction.unwrap_or((1.0, 1.0, 1.0));
    let divisor = exposure * Vec3::new(r, g, b);
    if divisor.is_finite() && divisor.min_element() > 0.0 {
        Ok(divisor)
    } else {
        Err("EXPOSURE or COLORCORR isn't a positive finite number".to_owned())
    }
}

fn message(error: &ImageError) -> String {
    let text = printable(error.to_string().trim());
    match error {
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            "the file is truncated".to_owned()
        }
        ImageError::Unsupported(error) => match error.kind() {
            UnsupportedErrorKind::Format(_) => {
                "colours other than RGB aren't supported (FORMAT isn't 32-bit_rle_rgbe)".to_owned()
            }
            UnsupportedErrorKind::GenericFeature(what) if what.starts_with("Orientation") => {
                let found = printable(what.trim_start_matches("Orientation").trim());
                format!(
                    "orientation {found} isn't supported, only -Y +X: rows from top to bottom, columns from left to right"
                )
            }
            _ => text,
        },
        // The header ends before the line with the size.
        _ if text.contains("EOF") => "the file is truncated".to_owned(),
        _ => text,
    }
}

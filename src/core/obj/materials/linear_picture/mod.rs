//! Decoders of pictures in linear RGB: OpenEXR and Radiance HDR.

mod open_exr;
mod radiance_hdr;

use crate::obj::LoadError;
use crate::progress::{Cancelled, Progress};
use glam::{UVec2, Vec3};
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

/// A decoded picture in linear RGB, row by row from the top.
pub(crate) struct Picture {
    pub size: UVec2,
    pub texels: Vec<Vec3>,
}

/// The memory for a picture.
#[derive(Clone, Copy)]
pub(crate) struct Memory {
    pub max_bytes: u64,
    /// The bytes that each texel takes in the end.
    pub bytes_per_texel: u64,
}

/// Why a file gives no picture.
pub(crate) enum Problem {
    Content(String),
    Cancelled,
}

impl From<Cancelled> for Problem {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<String> for Problem {
    fn from(message: String) -> Self {
        Self::Content(message)
    }
}

impl Problem {
    pub(crate) fn in_file(self, path: &Path) -> LoadError {
        let path = path.to_owned();
        match self {
            Self::Content(message) => LoadError::Content { path, message },
            Self::Cancelled => LoadError::Cancelled { path },
        }
    }
}

/// Decodes the bytes of a file.
pub(crate) type Decoder = fn(&[u8], Memory, &Progress) -> Result<Picture, Problem>;

/// The decoder for a file that begins with these bytes; `None` for other formats.
pub(crate) fn linear_decoder(bytes: &[u8]) -> Option<Decoder> {
    if bytes.starts_with(radiance_hdr::START) {
        Some(radiance_hdr::decode)
    } else if bytes.starts_with(open_exr::START) {
        Some(open_exr::decode)
    } else {
        None
    }
}

/// Black texels for a picture of this size, if it has any and fits into memory.
pub(super) fn black(size: UVec2, memory: Memory) -> Result<Vec<Vec3>, String> {
    let count = u64::from(size.x) * u64::from(size.y);
    if count == 0 {
        return Err("the picture has no pixels".to_owned());
    }
    let needed = count.saturating_mul(memory.bytes_per_texel);
    let megabytes = needed.div_ceil(1 << 20);
    if needed > memory.max_bytes {
        return Err(format!(
            "{} x {} pixels need {megabytes} MB of memory, but only {} MB is left (--max-memory)",
            size.x,
            size.y,
            memory.max_bytes >> 20
        ));
    }
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    let mut texels = Vec::new();
    if texels.try_reserve_exact(count).is_err() {
        return Err(format!("can't allocate {megabytes} MB"));
    }
    texels.resize(count, Vec3::ZERO);
    Ok(texels)
}

/// Reads bytes until the load is cancelled.
pub(super) struct Cancellable<'a> {
    bytes: Cursor<&'a [u8]>,
    progress: &'a Progress,
}

impl<'a> Cancellable<'a> {
    pub fn new(bytes: &'a [u8], progress: &'a Progress) -> Self {
        Self {
            bytes: Cursor::new(bytes),
            progress,
        }
    }
}

impl Read for Cancellable<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.progress.check().map_err(io::Error::other)?;
        self.bytes.read(buffer)
    }
}

impl Seek for Cancellable<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

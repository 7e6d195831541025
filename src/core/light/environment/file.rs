//! Reader of environment files.

use super::map::{EnvironmentMap, MapError};
use super::{open_exr, radiance_hdr};
use crate::brightness::MAX_BRIGHTNESS;
use crate::obj::{self, LoadError, Warning};
use crate::progress::{Cancelled, Progress};
use glam::{UVec2, Vec3};
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Arc, LazyLock};

/// A map that was read from a file.
#[derive(Clone, Debug)]
pub struct LoadedMap {
    /// The map.
    pub map: Arc<EnvironmentMap>,
    /// What was wrong with the file.
    pub warnings: Vec<Warning>,
}

/// A decoded picture in linear RGB, row by row from the top.
pub(super) struct Picture {
    pub size: UVec2,
    pub texels: Vec<Vec3>,
}

/// Why a file gives no map.
pub(super) enum Problem {
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
    fn in_file(self, path: &Path) -> LoadError {
        let path = path.to_owned();
        match self {
            Self::Content(message) => LoadError::Content { path, message },
            Self::Cancelled => LoadError::Cancelled { path },
        }
    }
}

impl EnvironmentMap {
    /// Loads a picture in Radiance HDR or OpenEXR format with at most `max_memory` bytes.
    ///
    /// # Errors
    /// See [`read`](Self::read); and the file can't be read.
    pub fn load(path: &Path, max_memory: u64, progress: &Progress) -> Result<LoadedMap, LoadError> {
        let unreadable = |source| LoadError::Unreadable {
            path: path.to_owned(),
            source,
        };
        let is_folder = std::fs::metadata(path).map_err(unreadable)?.is_dir();
        if is_folder {
            let message = "this is a directory, not a picture".to_owned();
            return Err(Problem::Content(message).in_file(path));
        }
        let bytes = obj::read_past(path, max_memory).map_err(unreadable)?;
        Self::read(&bytes, path, max_memory, progress)
    }

    /// Decodes a picture in Radiance HDR or OpenEXR format with at most `max_memory` bytes, including those of the file.
    /// `path` is for messages only; the format is recognised by the file's first bytes.
    ///
    /// # Errors
    /// [`LoadError::Content`] if the file is neither, is broken, or takes too much memory, and [`LoadError::Cancelled`].
    pub fn read(
        bytes: &[u8],
        path: &Path,
        max_memory: u64,
        progress: &Progress,
    ) -> Result<LoadedMap, LoadError> {
        let loaded = decoded(bytes, max_memory, progress);
        loaded.map_err(|problem| problem.in_file(path))
    }

    /// The map of [`Environment::built_in`](super::Environment::built_in).
    pub fn built_in() -> Arc<Self> {
        /// Made by `assets/studio_environment.rs`.
        static STUDIO: &[u8] = include_bytes!("../../../../assets/studio.hdr");
        static MAP: LazyLock<Arc<EnvironmentMap>> = LazyLock::new(|| {
            let loaded = EnvironmentMap::read(
                STUDIO,
                Path::new("studio.hdr"),
                u64::MAX,
                &Progress::default(),
            );
            loaded.expect("the built-in file is valid").map
        });
        Arc::clone(&MAP)
    }
}

fn decoded(bytes: &[u8], max_memory: u64, progress: &Progress) -> Result<LoadedMap, Problem> {
    progress.check()?;
    let Some(left) = max_memory.checked_sub(bytes.len() as u64) else {
        let message = format!(
            "larger than the {} MB of memory left (--max-memory)",
            max_memory >> 20
        );
        return Err(message.into());
    };
    let decode = if bytes.starts_with(radiance_hdr::START) {
        radiance_hdr::decode
    } else if bytes.starts_with(open_exr::START) {
        open_exr::decode
    } else {
        return Err("neither a Radiance HDR nor an OpenEXR picture"
            .to_owned()
            .into());
    };
    let Picture { size, texels } = obj::fenced("decoding", || decode(bytes, left, progress))??;
    let map = EnvironmentMap::new(size, texels, progress).map_err(|error| match error {
        MapError::Cancelled => Problem::Cancelled,
        MapError::Size => error.to_string().into(),
    })?;
    let warning = (map.replaced() > 0).then(|| {
        let (replaced, all) = (map.replaced(), 3 * u64::from(size.x) * u64::from(size.y));
        Warning::of_file(format!(
            "{replaced} of {all} numbers in the picture are negative, not finite or above {MAX_BRIGHTNESS:.1e}: those above become this limit, infinite ones the largest of the others, and all else 0"
        ))
    });
    Ok(LoadedMap {
        map: Arc::new(map),
        warnings: warning.into_iter().collect(),
    })
}

/// Black texels for a picture of this size, if it has any and its map fits into `max_bytes`.
pub(super) fn black(size: UVec2, max_bytes: u64) -> Result<Vec<Vec3>, String> {
    let count = u64::from(size.x) * u64::from(size.y);
    if count == 0 {
        return Err(MapError::Size.to_string());
    }
    let needed = count.saturating_mul(EnvironmentMap::BYTES_PER_TEXEL as u64);
    let megabytes = needed.div_ceil(1 << 20);
    if needed > max_bytes {
        return Err(format!(
            "{} x {} pixels need {megabytes} MB of memory, but only {} MB is left (--max-memory)",
            size.x,
            size.y,
            max_bytes >> 20
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

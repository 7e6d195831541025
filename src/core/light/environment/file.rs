//! Reader of environment files.

use super::map::{EnvironmentMap, MapError};
use crate::brightness::MAX_BRIGHTNESS;
use crate::obj::linear_picture::{Memory, Picture, Problem, linear_decoder};
use crate::obj::{self, LoadError, Warning};
use crate::progress::Progress;
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

    /// The built-in studio: a large key light, a fill light, a light from behind, and a dim floor. A white horizontal
    /// surface that faces up reflects the radiance 1.
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
    let Some(decode) = linear_decoder(bytes) else {
        return Err("neither a Radiance HDR nor an OpenEXR picture"
            .to_owned()
            .into());
    };
    let memory = Memory {
        max_bytes: left,
        bytes_per_texel: EnvironmentMap::BYTES_PER_TEXEL as u64,
    };
    let Picture { size, texels } = obj::fenced("decoding", || decode(bytes, memory, progress))??;
    let map = EnvironmentMap::new(size, texels, progress).map_err(|error| match error {
        MapError::Cancelled => Problem::Cancelled,
        MapError::Size => error.to_string().into(),
    })?;
    let warning = (map.replaced() > 0).then(|| {
        let (replaced, all) = (map.replaced(), 3 * u64::from(size.x) * u64::from(size.y));
        Warning::of_file(format!(
            "{replaced} of {all} numbers in the picture can't be used: negative ones and NaN count as 0, infinite ones as the largest of the others, larger ones than {MAX_BRIGHTNESS:.1e} as this limit"
        ))
    });
    Ok(LoadedMap {
        map: Arc::new(map),
        warnings: warning.into_iter().collect(),
    })
}

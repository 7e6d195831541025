//! The output files of one camera.

use super::super::{CommandError, Output, PreparedPicture};
use hitscope_core::picture::{write_depth, write_ids};
use std::path::PathBuf;

/// The names of the files of one camera.
pub(super) struct OutputNames {
    /// The picture of each view.
    pub pictures: Vec<PathBuf>,
    /// The file of distances.
    pub depth_map: Option<PathBuf>,
    /// The file of numbers.
    pub ids: Option<PathBuf>,
}

impl OutputNames {
    /// All names.
    pub(super) fn all(&self) -> impl Iterator<Item = &PathBuf> {
        self.pictures.iter().chain(&self.depth_map).chain(&self.ids)
    }

    /// Checks that the files can be written. Call this before long work.
    ///
    /// # Errors
    /// See [`Output::create`].
    pub(super) fn create(&self) -> Result<Outputs, CommandError> {
        let create = |path: &PathBuf| Output::create(path);
        let pictures = self.pictures.iter().map(create);
        Ok(Outputs {
            pictures: pictures.collect::<Result<_, _>>()?,
            depth_map: self.depth_map.as_ref().map(create).transpose()?,
            ids: self.ids.as_ref().map(create).transpose()?,
        })
    }
}

/// The files of one camera, which were writable when this was created.
pub(super) struct Outputs {
    /// The picture of each view.
    pub pictures: Vec<Output>,
    depth_map: Option<Output>,
    ids: Option<Output>,
}

impl Outputs {
    /// Writes the files of distances and numbers that were asked for.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub(super) fn write_surfaces(&self, picture: &PreparedPicture<'_>) -> Result<(), CommandError> {
        if self.depth_map.is_none() && self.ids.is_none() {
            return Ok(());
        }
        let surfaces = picture.surfaces()?;
        if let Some(output) = &self.depth_map {
            output.write_seekable(|to| write_depth(&surfaces, to))?;
        }
        if let Some(output) = &self.ids {
            let names = picture.loaded().scene.mesh().attributes();
            output.write_seekable(|to| write_ids(&surfaces, names, to))?;
        }
        Ok(())
    }
}

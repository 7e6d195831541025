//! The option that aims the camera at an element of the scene.

use super::CommandError;
use super::camera::CameraArgs;
use super::input::{is_stdin, name_of};
use crate::element::{Element, ElementError, Rereadable};
use clap::Args;
use glam::DVec3;
use hitscope_core::Camera;
use hitscope_core::loading::LoadedScene;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The element to look at.
#[derive(Args, Clone, Copy, Debug)]
pub struct AimArg {
    /// Look at an element and frame it; with --eye, only look at it. Triangles and faces are counted from 0, vertices and
    /// lines of the file from 1
    #[arg(
        long,
        value_name = "triangle:N|face:N|vertex:N|line:N|X,Y,Z",
        allow_hyphen_values = true,
        conflicts_with = "target"
    )]
    pub look_at: Option<Element>,
}

/// A camera, and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aimed {
    /// The camera.
    pub camera: Camera,
    /// The point that was named, in the scene's coordinates.
    pub target: Option<DVec3>,
}

impl AimArg {
    /// The camera for a scene that was loaded from `file`.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if the scene has no such element; else see [`CameraArgs::camera`].
    pub fn aimed(
        &self,
        camera: &CameraArgs,
        loaded: &LoadedScene,
        file: &Path,
    ) -> Result<Aimed, CommandError> {
        let (scene, view) = (&*loaded.scene, loaded.view.as_ref());
        let Some(element) = self.look_at else {
            return Ok(Aimed {
                camera: camera.camera(scene, view)?,
                target: camera.target.map(|target| target - scene.mesh().origin()),
            });
        };
        let open = || reopen(file);
        let file = Rereadable {
            path: name_of(file),
            open: &open,
        };
        let place = element.place(loaded, file).map_err(|error| match error {
            ElementError::Missing(message) => {
                CommandError::Usage(format!("--look-at {element}: {message}"))
            }
            ElementError::Load(error) => error.into(),
        })?;
        Ok(Aimed {
            camera: camera.camera_at(scene, view, &place)?,
            target: Some(place.centre),
        })
    }
}

/// Opens a regular file, which can be read twice.
fn reopen(path: &Path) -> io::Result<Box<dyn Read>> {
    // Opening a pipe would block until there is a writer.
    if is_stdin(path) || !std::fs::metadata(path)?.is_file() {
        let why = "to find a vertex or a line in it, the file must be a regular one";
        return Err(io::Error::new(io::ErrorKind::Unsupported, why));
    }
    Ok(Box::new(File::open(path)?))
}

//! The commands that need no window. Results go to stdout; errors are one line for stderr.

mod args;
mod bench;
mod info;
mod inspect;
mod lab;
mod render;
mod trace;

pub use args::{CameraArgs, MemoryArg};
pub use bench::BenchArgs;
pub use info::InfoArgs;
pub use inspect::InspectArgs;
pub use lab::LabArgs;
pub use render::{
    DARK_BACKGROUND, PictureArgs, RenderArgs, Rendered, default_thread_count, write_png,
};
pub use trace::TraceArgs;

use hitscope_core::camera::CameraError;
use hitscope_core::obj::{LoadError, LoadOptions, shown};
use hitscope_core::progress::Progress;
use hitscope_core::render::RenderPanic;
use hitscope_core::scene::{LoadedScene, SceneOptions};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

/// Why a command failed: the input is bad.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// The mesh couldn't be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The camera can't be.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The pixel isn't in the picture.
    #[error("pixel {x},{y} is outside of the picture of {width}x{height}")]
    PixelOutside {
        /// The pixel's column.
        x: u32,
        /// The pixel's row.
        y: u32,
        /// Of the picture.
        width: u32,
        /// Of the picture.
        height: u32,
    },
    /// A file other than the mesh couldn't be read or written.
    #[error("{}: {source}", shown(path))]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The picture couldn't be encoded or written.
    #[error("{}: {source}", shown(path))]
    Image {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        source: image::ImageError,
    },
    /// Rendering panicked.
    #[error(transparent)]
    Render(#[from] RenderPanic),
    /// Results couldn't be written to stdout.
    #[error("stdout: {0}")]
    Stdout(#[from] io::Error),
    /// Something else was asked for that this machine or file doesn't have.
    #[error("{0}")]
    Other(String),
}

/// What a system's error about a file other than the mesh is to a command.
fn file_error(path: &Path, source: io::Error) -> CommandError {
    CommandError::File {
        path: path.to_owned(),
        source,
    }
}

/// Loads a scene, with a line about it on a terminal's stderr.
///
/// # Errors
/// See [`LoadError`].
pub fn load(
    path: &Path,
    load_options: LoadOptions,
    options: SceneOptions,
) -> Result<LoadedScene, LoadError> {
    let loaded = LoadedScene::load(path, load_options, options, &Progress::default())?;
    if io::stderr().is_terminal() {
        let triangles = loaded.scene.mesh().triangles.len();
        let ms = (loaded.load_time + loaded.scene.build_time()).as_secs_f64() * 1e3;
        eprintln!("{}: {triangles} triangles in {ms:.0} ms", shown(path));
        for warning in &loaded.warnings {
            eprintln!("{}: warning: {warning}", shown(path));
        }
    }
    Ok(loaded)
}

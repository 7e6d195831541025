//! The commands that need no window. They print results to stdout and errors, one line each, to stderr.

mod aim;
mod args;
mod bench;
mod camera;
mod camera_text;
mod clip;
mod colours;
mod compare;
mod converge;
mod digits;
mod display;
mod draft;
mod environment;
mod info;
mod input;
mod inspect;
mod kernel;
mod lab;
mod legend;
mod light;
mod lights;
mod materials;
mod numbers;
mod output;
mod path;
mod picture;
mod prepared;
mod render;
mod scene;
mod stderr;
mod thickness;
mod threads;
mod trace;

pub use aim::{AimArg, Aimed};
pub use args::MemoryArg;
pub use bench::BenchArgs;
pub use camera::CameraArgs;
pub use clip::{ClipArgs, MAX_OVERLAY_PLANES};
pub use colours::{ColourArgs, RangeArg, SpacingArg};
pub use compare::CompareArgs;
pub use converge::ConvergeArgs;
pub use display::DisplayArgs;
pub use environment::EnvironmentSource;
pub use info::InfoArgs;
pub use input::{is_stdin, print_warnings};
pub use inspect::InspectArgs;
pub use kernel::KernelArg;
pub use lab::LabArgs;
pub use light::LightArgs;
pub use output::{Output, PngRows};
pub use path::PathArgs;
pub use picture::{DARK_BACKGROUND, PictureArgs, Rendered, require_picture_memory};
pub use prepared::{PreparedPicture, PreparedScene, PreparedView};
pub use render::{OverlayPen, PictureFormat, RenderArgs, parse_png};
pub use scene::{SceneArgs, ShadingArg};
pub use stderr::print_line;
pub use thickness::ThicknessArg;
pub use threads::{ThreadsArg, default_thread_count, start_thread_pool};
pub use trace::TraceArgs;

use hitscope_core::camera::CameraError;
use hitscope_core::obj::{LoadError, reason, shown};
use hitscope_core::render::RenderError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// The arguments contradict each other or are impossible to satisfy.
    #[error("{0}")]
    Usage(String),
    /// The mesh couldn't be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// No camera can see the mesh.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The pixel isn't in the picture.
    #[error("pixel {x},{y} is outside the picture of {width}x{height} pixels")]
    PixelOutside {
        /// The pixel's column.
        x: u32,
        /// The pixel's row.
        y: u32,
        /// Width of the picture.
        width: u32,
        /// Height of the picture.
        height: u32,
    },
    /// A file other than the mesh couldn't be read or written.
    #[error("{}: {}", shown(path), reason(source))]
    File {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The picture couldn't be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Results couldn't be written to stdout.
    #[error("stdout: {0}")]
    Stdout(#[from] io::Error),
    /// The machine lacks a resource, such as memory or threads.
    #[error("{0}")]
    Other(String),
}

impl CommandError {
    /// Whether the command line is wrong, rather than a file or the machine.
    pub fn is_usage(&self) -> bool {
        matches!(self, Self::Usage(_) | Self::PixelOutside { .. })
    }
}

/// The error for a file other than the mesh.
fn file_error(path: &Path, source: io::Error) -> CommandError {
    CommandError::File {
        path: path.to_owned(),
        source,
    }
}

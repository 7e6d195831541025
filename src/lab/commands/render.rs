//! `hitscope render`: a picture without a window.

use super::CommandError;
use super::args::{CameraArgs, CreaseArg, KernelArg, MeshArgs, ViewArg, kernel_names};
use clap::{Args, ValueEnum};
use glam::{UVec2, Vec3};
use hitscope_core::integrator::Context;
use hitscope_core::kernel::triangle_kernel;
use hitscope_core::obj::Recentre;
use hitscope_core::render::plan::Plan;
use hitscope_core::render::{Job, render};
use hitscope_core::scene::{LoadedScene, Shading};
use hitscope_core::srgb::from_display;
use hitscope_core::{Camera, Film, Intersector};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Renders a mesh to a PNG file
#[derive(Args, Clone, Debug)]
pub struct RenderArgs {
    /// The OBJ file
    pub file: PathBuf,
    /// The PNG file to write
    #[arg(short, long, value_name = "OUT.png", value_parser = parse_png)]
    pub output: PathBuf,
    /// Picture
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Draw the polygons' edges over it (needs a GPU, or software that acts as one)
    #[arg(long)]
    pub wireframe: bool,
    /// Draw normals over it (likewise)
    #[arg(long)]
    pub normals: bool,
}

/// What a traced picture shows
#[derive(Args, Clone, Debug)]
pub struct PictureArgs {
    /// Camera
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Samples for each pixel, rounded up to a power of two
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub samples: u32,
    /// How normals vary over a triangle
    #[arg(long, default_value = "flat")]
    pub shading: ShadingArg,
    /// View
    #[command(flatten)]
    pub view: ViewArg,
    /// Kernel
    #[command(flatten)]
    pub kernel: KernelArg,
    /// Where smooth shading has edges.
    #[command(flatten)]
    pub crease: CreaseArg,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// What the view “disagreement” holds the kernel against
    #[arg(long, value_name = "KERNEL", default_value = "exact", value_parser = kernel_names())]
    pub against: String,
    /// Threads [default: one a core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// How normals vary over a triangle.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ShadingArg {
    /// One normal a triangle
    Flat,
    /// Interpolated from the vertices
    Smooth,
}

impl From<ShadingArg> for Shading {
    fn from(arg: ShadingArg) -> Self {
        match arg {
            ShadingArg::Flat => Self::Flat,
            ShadingArg::Smooth => Self::Smooth,
        }
    }
}

/// A picture, with what is needed to draw over it.
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// From where it was taken.
    pub camera: Camera,
    /// What it shows.
    pub loaded: LoadedScene,
    /// How its normals vary.
    pub shading: Shading,
}

/// What is behind the mesh, in sRGB: the dark theme's, and that of pictures without a window.
pub const DARK_BACKGROUND: Vec3 = Vec3::new(0.13, 0.14, 0.16);

/// One a core.
pub fn default_thread_count() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl RenderArgs {
    /// Traces the picture. The overlay is left to the caller, who has a GPU or hasn't.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self) -> Result<Rendered, CommandError> {
        let loaded = self.picture.mesh.load(&self.file, Recentre::Auto)?;
        self.picture.trace(loaded)
    }
}

impl PictureArgs {
    /// Traces the picture of a scene.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self, mut loaded: LoadedScene) -> Result<Rendered, CommandError> {
        loaded.scene = self.crease.apply(loaded.scene);
        let camera = self.camera.camera(&loaded.scene)?;
        let shading = self.shading.into();
        let intersector: Arc<dyn Intersector> =
            Arc::from(loaded.scene.intersector(self.kernel.kernel()));
        let chosen = triangle_kernel(&self.against).expect("clap takes names from the table only");
        let integrator = self.view.integrator();
        let context = Context {
            second: integrator.second(&loaded.scene, &intersector, chosen),
            intersector,
            scene: Arc::clone(&loaded.scene),
            camera,
            shading,
            background: from_display(DARK_BACKGROUND),
        };
        let job = Job {
            context,
            integrator,
            plan: Plan::new(camera.resolution(), 1, self.samples),
        };
        let threads = self.threads.map_or_else(default_thread_count, usize::from);
        Ok(Rendered {
            film: render(job, threads)?,
            camera,
            loaded,
            shading,
        })
    }
}

/// A path that says what will be in the file.
fn parse_png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let extension = path.extension().unwrap_or_default();
    if extension.eq_ignore_ascii_case("png") {
        Ok(path)
    } else {
        Err("only PNG files are written: the name must end in .png".to_owned())
    }
}

/// Writes sRGB pixels, row by row from the top, as a PNG file.
///
/// # Errors
/// [`CommandError::Image`].
pub fn write_png(path: &Path, size: UVec2, pixels: &[[u8; 4]]) -> Result<(), CommandError> {
    let bytes = pixels.as_flattened();
    let kind = image::ExtendedColorType::Rgba8;
    image::save_buffer_with_format(path, bytes, size.x, size.y, kind, image::ImageFormat::Png)
        .map_err(|source| CommandError::Image {
            path: path.to_owned(),
            source,
        })
}

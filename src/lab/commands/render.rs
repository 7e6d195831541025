//! `hitscope render`: renders a picture without a window.

use super::output::is_stream;
use super::{CommandError, PictureArgs, Rendered};
use clap::Args;
use std::path::{Path, PathBuf};

/// Render a picture to a PNG or OpenEXR file
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope render bunny.obj -o bunny.png
  hitscope render bunny.obj -o bunny.png --size 1920x1080 --samples 64
  hitscope render bunny.obj -o bunny.png --shading smooth --wireframe
  hitscope render bunny.obj -o bunny.png --overlay grid --overlay axes
  hitscope render bunny.obj -o bunny.png --eye 3,2,4 --target 0,1,0
  hitscope render bunny.obj -o bunny.png --view path --samples 256 --noise
  hitscope render bunny.obj -o bunny.exr --view path --environment built-in
  hitscope render bunny.obj -o /dev/stdout --view cost | display

A name ending in .exr gives linear radiance in f32 with the layers albedo,
normal, Z, id, sampleCount and variance, for denoisers and compositing;
exposure and tone curve don't change it. The output file appears under its
name once it is complete. A picture takes 73 bytes of memory per pixel.")]
pub struct RenderArgs {
    /// PNG or OpenEXR file, or a pipe or device for PNG, to write
    #[arg(short, long, value_name = "OUT.png|OUT.exr", value_parser = parse_picture)]
    pub output: PathBuf,
    /// Picture.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Draw an overlay over the picture; may be given more than once (needs a GPU or a software renderer for Vulkan)
    #[arg(long, value_name = "NAME")]
    pub overlay: Vec<String>,
    /// Draw the edges of the polygons, as --overlay wireframe
    #[arg(long)]
    pub wireframe: bool,
    /// Draw normals: as --overlay face-normals with flat shading, else as --overlay vertex-normals
    #[arg(long)]
    pub normals: bool,
    /// Print the standard error of the pixels' luminance, on average and at most
    #[arg(long)]
    pub noise: bool,
}

impl RenderArgs {
    /// Checks the arguments without the mesh. Call this before long work.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self) -> Result<(), CommandError> {
        let refuse = |message: &str| Err(CommandError::Usage(message.to_owned()));
        if self.is_exr() && self.has_overlay() {
            return refuse("overlays are drawn over PNG pictures only");
        }
        if self.noise && self.picture.samples < 2 {
            return refuse("--noise needs at least 2 samples per pixel");
        }
        if self.noise && is_stream(&self.output) {
            return refuse("--noise prints to standard output; write the picture to a file");
        }
        self.picture.check()
    }

    /// Traces the picture. Drawing the overlay is left to the caller, which may have a GPU.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self) -> Result<Rendered, CommandError> {
        self.check()?;
        let loaded = self.picture.scene.load()?;
        self.picture.trace(loaded, self.is_exr())
    }

    /// Whether an overlay is drawn over the picture.
    pub fn has_overlay(&self) -> bool {
        self.wireframe || self.normals || !self.overlay.is_empty()
    }

    /// Whether the output is an OpenEXR file.
    pub fn is_exr(&self) -> bool {
        has_extension(&self.output, "exr") && !is_stream(&self.output)
    }
}

/// Parses the path of a picture: a name ending in .png, a pipe or a device.
///
/// # Errors
/// A message for the user.
pub fn parse_png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if has_extension(&path, "png") || is_stream(&path) {
        Ok(path)
    } else {
        Err("only PNG files are written: the name must end in .png, or be /dev/stdout".to_owned())
    }
}

/// Parses the path of a picture: as [`parse_png`], or a name ending in .exr.
///
/// # Errors
/// A message for the user.
fn parse_picture(text: &str) -> Result<PathBuf, String> {
    if has_extension(Path::new(text), "exr") {
        return Ok(text.into());
    }
    parse_png(text).map_err(|_| {
        "PNG and OpenEXR files are written: the name must end in .png or .exr, or be /dev/stdout"
            .to_owned()
    })
}

fn has_extension(path: &Path, extension: &str) -> bool {
    let own = path.extension().unwrap_or_default();
    own.eq_ignore_ascii_case(extension)
}

//! `hitscope render`: renders a picture without a window.

use super::light::refuse_without_effect;
use super::output::is_stream;
use super::{CommandError, Output, PictureArgs, PreparedPicture, Rendered};
use clap::Args;
use hitscope_core::integrator::Setting;
use hitscope_core::obj::shown;
use hitscope_core::picture::{write_depth, write_ids};
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
  hitscope render bunny.obj -o out-{view}.png --view shaded --view depth
  hitscope render bunny.obj -o error.png --view error-t --range 1,1000 --legend
  hitscope render bunny.obj -o half.png --clip-plane 1,0,0,0.5
  hitscope render bunny.obj -o out.png --depth-map depth.exr --ids ids.exr

A name ending in .exr gives linear radiance in f32 with the layers albedo,
normal, Z, id, sampleCount and variance, for denoisers and compositing;
exposure and tone curve don't change it. Output files appear under their
names once they are complete. A picture takes 73 bytes of memory per pixel.")]
pub struct RenderArgs {
    /// PNG or OpenEXR file, or a pipe or device for PNG, to write; {view} stands for the name of the view
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
    /// Draw a bar with the colours of a view of numbers to the right of the picture, and print its title and range
    #[arg(long)]
    pub legend: bool,
    /// Also write the distances of the pixels' centres as OpenEXR: t along the ray, and Z along the direction of the view
    /// (32-bit floats; inf where the ray hits nothing)
    #[arg(long, value_name = "OUT.exr", value_parser = parse_exr)]
    pub depth_map: Option<PathBuf>,
    /// Also write the numbers of the surfaces in the pixels' centres as OpenEXR: primitive, group and material (32-bit
    /// integers; 4294967295 where there is none), with the names of groups and materials
    #[arg(long, value_name = "OUT.exr", value_parser = parse_exr)]
    pub ids: Option<PathBuf>,
}

/// The place of the view's name in the name of an output.
const VIEW_PLACE: &str = "{view}";

/// The output files of `render`, which were writable when this was created.
pub struct RenderOutputs {
    /// The picture of each view.
    pub pictures: Vec<Output>,
    depth_map: Option<Output>,
    ids: Option<Output>,
}

impl RenderOutputs {
    /// Writes the files of distances and numbers that were asked for.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn write_surfaces(&self, picture: &PreparedPicture<'_>) -> Result<(), CommandError> {
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
        if self.has_overlay() && self.picture.clip.clip().is_some() {
            return refuse("overlays aren't clipped: they need the whole scene");
        }
        if self.is_exr() && self.legend {
            return refuse("legends are drawn beside PNG pictures only");
        }
        let prints = self.noise || self.legend;
        if self.noise && self.picture.samples < 2 {
            return refuse("--noise needs at least 2 samples per pixel");
        }
        if prints && is_stream(&self.output) {
            return refuse(
                "--noise and --legend print to standard output; write the picture to a file",
            );
        }
        self.check_names()?;
        if let Some(views) = self.picture.view.known(&self.picture.scene.file) {
            refuse_without_effect(&views, &[("--legend", self.legend, Setting::Scale)])?;
        }
        self.picture.check()
    }

    /// Refuses outputs of which one would replace another.
    fn check_names(&self) -> Result<(), CommandError> {
        let refuse = |message: String| Err(CommandError::Usage(message));
        let (views, has_place) = (&self.picture.view.view, self.has_view_place());
        if views.len() > 1 && !has_place {
            return refuse(format!(
                "several views need {VIEW_PLACE} in the name of the output, as in out-{VIEW_PLACE}.png"
            ));
        }
        if views.is_empty() && has_place {
            return refuse(format!(
                "{VIEW_PLACE} in the name of the output needs --view"
            ));
        }
        let mut paths = self.paths();
        paths.extend(self.depth_map.iter().chain(&self.ids).cloned());
        for (k, path) in paths.iter().enumerate() {
            if paths[..k].contains(path) {
                return refuse(format!("two outputs have the name {}", shown(path)));
            }
        }
        Ok(())
    }

    fn has_view_place(&self) -> bool {
        self.output.to_string_lossy().contains(VIEW_PLACE)
    }

    /// The paths of the pictures, one per view.
    fn paths(&self) -> Vec<PathBuf> {
        let views = &self.picture.view.view;
        if views.is_empty() || !self.has_view_place() {
            return vec![self.output.clone()];
        }
        let text = self.output.to_string_lossy();
        let path = |view: &String| PathBuf::from(text.replace(VIEW_PLACE, view));
        views.iter().map(path).collect()
    }

    /// The outputs, checked to be writable. Call this before long work.
    ///
    /// # Errors
    /// [`CommandError::File`] with the system's error.
    pub fn outputs(&self) -> Result<RenderOutputs, CommandError> {
        let create = |path: &PathBuf| Output::create(path);
        Ok(RenderOutputs {
            pictures: self.paths().iter().map(create).collect::<Result<_, _>>()?,
            depth_map: self.depth_map.as_ref().map(create).transpose()?,
            ids: self.ids.as_ref().map(create).transpose()?,
        })
    }

    /// Loads the scene.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn prepare(&self) -> Result<PreparedPicture<'_>, CommandError> {
        self.check()?;
        let loaded = self.picture.scene.load()?;
        let prepared = self.picture.prepare(loaded, self.is_exr())?;
        let legend = [("--legend", self.legend, Setting::Scale)];
        refuse_without_effect(prepared.views(), &legend)?;
        Ok(prepared)
    }

    /// Traces the picture of the first view. Drawing the overlay is left to the caller, which may have a GPU.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self) -> Result<Rendered, CommandError> {
        let prepared = self.prepare()?;
        prepared.trace(prepared.views()[0])
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

/// Parses the path of an OpenEXR file.
///
/// # Errors
/// A message for the user.
fn parse_exr(text: &str) -> Result<PathBuf, String> {
    if has_extension(Path::new(text), "exr") {
        Ok(text.into())
    } else {
        Err("the name must end in .exr".to_owned())
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    let own = path.extension().unwrap_or_default();
    own.eq_ignore_ascii_case(extension)
}

//! `hitscope render`: renders pictures without a window.
//!
//! | part | file |
//! |---|---|
//! | options, and the run | `mod` |
//! | the cameras of a run | `shots` |
//! | the file of `--cameras` | `camera_list` |
//! | the cameras of `--turntable` | `turntable` |
//! | the files of one camera | `outputs` |
//! | formats, and the names of several outputs | `format`, `output_names` |

mod camera_list;
mod format;
mod output_names;
mod outputs;
mod shots;
mod turntable;

pub(super) use format::parse_output;
pub use format::{PictureFormat, parse_png};

use super::aim::AimArg;
use super::light::refuse_without_effect;
use super::output::{is_same_file, is_stream};
use super::picture::noise_text;
use super::{CommandError, Output, PictureArgs, PreparedScene, PreparedView, Rendered};
use crate::progress::{Meter, ProgressBar};
use clap::Args;
use format::parse_exr;
use glam::UVec2;
use hitscope_core::film::NoiseSum;
use hitscope_core::integrator::{Comparison, Integrator, Setting};
use hitscope_core::obj::shown;
use hitscope_core::render::STRIP_BYTES;
use outputs::{OutputNames, Outputs};
use shots::Shots;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  hitscope render bunny.obj -o bunny.png
  hitscope render bunny.obj -o bunny.png --size 1920x1080 --samples 64
  hitscope render bunny.obj -o bunny.png --shading smooth --wireframe
  hitscope render bunny.obj -o bunny.png --overlay grid --overlay axes
  hitscope render bunny.obj -o bunny.png --eye 3,2,4 --target 0,1,0
  hitscope render bunny.obj -o bunny.png --look-at triangle:123
  hitscope render bunny.obj -o bunny.png --session bunny.hitscope
  hitscope render bunny.obj -o bunny.png --view path --samples 256 --noise
  hitscope render bunny.obj -o bunny.exr --view path --environment built-in
  hitscope render bunny.obj -o - --view cost | display
  hitscope render bunny.obj -o out-{view}.png --view shaded --view depth
  hitscope render bunny.obj -o error.png --view error-t --range 1,1000 --legend
  hitscope render bunny.obj -o half.png --clip-plane 1,0,0,0.5
  hitscope render bunny.obj -o cut-out.png --transparent --samples 16
  hitscope render bunny.obj -o out.png --depth-map depth.exr --ids ids.exr
  hitscope render bunny.obj -o frame-{index}.png --turntable 36
  hitscope render bunny.obj -o bunny-{name}.png --cameras cameras.json

Several pictures are rendered from one load. A file of cameras is a JSON list:

  [ {\"name\": \"front\", \"eye\": [0, 1, 5], \"target\": [0, 1, 0]},
    {\"name\": \"plan\", \"eye\": [0, 9, 0], \"up\": [0, 0, -1], \"ortho\": 4} ]

Its fields are those of the options: eye, target, up, fov, ortho and size (as in
[640, 480]); all may be missing. In the names of outputs, {view} stands for the
name of the view, {name} for the camera's name, and {index} for its number,
which is counted from 0.

A name ending in .exr gives linear radiance in f32 with the layers albedo,
normal, Z, id, sampleCount and variance, for denoisers and compositing;
exposure and tone curve don't change it. Output files appear under their
names once they are complete. PNG pictures are rendered in strips of 256 MB of
memory; others, and those with --depth-map or --ids, take 105 bytes per pixel.";

/// Render pictures to PNG or OpenEXR files
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RenderArgs {
    /// PNG or OpenEXR file, or a pipe or device, to write; - for standard output; {view}, {name} and {index} stand for the
    /// names of view and camera, and the camera's number
    #[arg(short, long, value_name = "OUT.png|OUT.exr", value_parser = parse_output)]
    pub output: PathBuf,
    /// Format of the picture, whatever its name [default: that of its name; PNG for pipes and devices]
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<PictureFormat>,
    /// Picture.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Element to look at.
    #[command(flatten)]
    pub aim: AimArg,
    /// Render with each camera of this JSON file; see below
    #[arg(long, value_name = "CAMERAS.json", conflicts_with_all = CAMERA_OPTIONS)]
    pub cameras: Option<PathBuf>,
    /// Render N pictures, 1 to 100000, from all sides: the camera turns about the up axis (--up, else y or z) through its
    /// target
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub turntable: Option<u32>,
    /// Draw an overlay over the picture; may be given more than once (needs a GPU or a software renderer for Vulkan)
    #[arg(long, value_name = "NAME")]
    pub overlay: Vec<String>,
    /// Draw the edges of the polygons, as --overlay wireframe
    #[arg(long)]
    pub wireframe: bool,
    /// Draw normals: as --overlay face-normals with flat shading, else as --overlay vertex-normals
    #[arg(long)]
    pub normals: bool,
    /// Make the background transparent: alpha is the part of a pixel's samples that hit something (PNG: straight alpha;
    /// OpenEXR: the channel A, and colours premultiplied by it)
    #[arg(long)]
    pub transparent: bool,
    /// Print the noise: the standard error of the pixels' luminance, on average and at most, in percent of the mean
    /// luminance, without pixels that show no surface
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
    /// Memory of the strips in which PNG pictures are rendered, in bytes. Not an option: pictures don't depend on it.
    #[arg(skip = STRIP_BYTES)]
    pub strip_bytes: u64,
}

/// Options that a file of cameras replaces.
const CAMERA_OPTIONS: [&str; 8] = [
    "eye",
    "target",
    "up",
    "fov",
    "ortho",
    "session",
    "look_at",
    "turntable",
];

/// Draws overlays over the pixels of a picture or a strip, which are sRGB with alpha. Strips arrive from top to bottom.
pub type OverlayPen<'a> =
    Box<dyn FnMut(&mut [[u8; 4]], &Rendered) -> Result<(), CommandError> + 'a>;

impl RenderArgs {
    /// Checks the arguments without the mesh.
    ///
    /// # Errors
    /// [`CommandError::Usage`]; [`CommandError::File`] and [`CommandError::Other`] about the file of cameras.
    pub fn check(&self) -> Result<(), CommandError> {
        self.checked().map(drop)
    }

    /// Renders and writes the pictures. `open_pen` opens what draws overlays, if they are asked for.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run<'a>(
        &self,
        open_pen: impl FnOnce() -> Result<OverlayPen<'a>, CommandError>,
        out: &mut dyn Write,
    ) -> Result<(), CommandError> {
        // Do everything that can fail without the mesh before loading it.
        let shots = self.checked()?;
        let outputs = shots.output_names();
        let outputs = outputs.iter().map(OutputNames::create);
        let outputs: Vec<Outputs> = outputs.collect::<Result<_, _>>()?;
        let mut pen = self.has_overlay().then(open_pen).transpose()?;
        let scene = self.prepare(shots.count())?;
        let cameras = shots.cameras(&scene)?;
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        let (all, mut number, mut figures) = (cameras.len() * scene.views().len(), 0, Vec::new());
        for (camera, outputs) in cameras.into_iter().zip(&outputs) {
            let picture = scene.seen_by(camera);
            for (view, output) in scene.views().iter().zip(&outputs.pictures) {
                number += 1;
                meter.begin(match all {
                    1 => "Rendering".to_owned(),
                    _ => format!("Rendering {number} of {all}"),
                });
                let view = picture.view(view)?;
                let noise = self.write(&view, output, pen.as_mut(), &meter)?;
                let names = (output, shots.count());
                self.print_figures((&view, &noise), names, &mut figures)?;
            }
            outputs.write_surfaces(&picture)?;
        }
        drop(bar);
        Ok(out.write_all(&figures)?)
    }

    /// Traces the picture of the first camera and view, and neither draws over it nor writes it.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self) -> Result<Rendered, CommandError> {
        let shots = self.checked()?;
        let scene = self.prepare(shots.count())?;
        let first = shots.cameras(&scene)?[0];
        scene
            .seen_by(first)
            .trace(scene.views()[0], &Meter::default())
    }

    /// Whether an overlay is drawn over the pictures.
    pub fn has_overlay(&self) -> bool {
        self.wireframe || self.normals || !self.overlay.is_empty()
    }

    fn checked(&self) -> Result<Shots<'_>, CommandError> {
        let refuse = |message: &str| Err(CommandError::Usage(message.to_owned()));
        let is_exr = self.format()? == PictureFormat::Exr;
        // A format that is given could overwrite the mesh, whatever its name.
        if self.format.is_some() && is_same_file(&self.picture.scene.file, &self.output) {
            return refuse(&format!("{} is the mesh itself", shown(&self.output)));
        }
        if is_exr && self.has_overlay() {
            return refuse("overlays are drawn over PNG pictures only");
        }
        if self.has_overlay() && self.picture.clip.has_too_many_for_overlays() {
            return refuse("overlays are clipped by at most 16 planes; a box is six of them");
        }
        if is_exr && self.legend {
            return refuse("legends are drawn beside PNG pictures only");
        }
        if self.noise && self.picture.samples < 2 {
            return refuse("--noise needs at least 2 samples per pixel");
        }
        if (self.noise || self.legend) && is_stream(&self.output) {
            return refuse(
                "--noise and --legend print to standard output; write the picture to a file",
            );
        }
        let shots = Shots::new(self)?;
        if let Some(views) = self.picture.view.known(&self.picture.scene.file) {
            self.check_legend(&views)?;
            self.check_transparency(&views)?;
        }
        self.picture.check_options()?;
        // The size of a scene file's picture may be known only later.
        if let Some(size) = self.picture.camera.known_size(&self.picture.scene.file) {
            self.check_size(size)?;
        }
        Ok(shots)
    }

    fn check_legend(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        refuse_without_effect(views, &[("--legend", self.legend, Setting::Scale)])
    }

    fn check_transparency(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        let compares = |view: &&&Integrator| view.needs.second != Comparison::Nothing;
        match views.iter().find(compares) {
            Some(view) if self.transparent => Err(CommandError::Usage(format!(
                "--transparent can't be used with the view “{}”: where one kernel hits nothing, the other may hit",
                view.name
            ))),
            _ => Ok(()),
        }
    }

    /// Loads the scene.
    fn prepare(&self, shot_count: usize) -> Result<PreparedScene<'_>, CommandError> {
        let first_tree = self.picture.first_tree(shot_count);
        let loaded = self.picture.scene.load_with_tree(first_tree)?;
        let has_guides = self.format()? == PictureFormat::Exr;
        let mut scene = self.picture.prepare(loaded, has_guides)?;
        scene.is_transparent = self.transparent;
        self.check_legend(scene.views())?;
        self.check_transparency(scene.views())?;
        Ok(scene)
    }

    /// Traces a picture, in strips if it is a PNG file, and writes it. Returns its noise.
    fn write(
        &self,
        view: &PreparedView<'_>,
        output: &Output,
        mut pen: Option<&mut OverlayPen<'_>>,
        meter: &Meter,
    ) -> Result<NoiseSum, CommandError> {
        let mut noise = NoiseSum::default();
        if self.needs_whole()? {
            view.require_whole()?;
        }
        if self.format()? == PictureFormat::Exr {
            let rendered = view.trace(0..view.size().y, meter)?;
            if self.noise {
                noise.merge(&rendered.noise_sum());
            }
            let (guides, alpha) = (rendered.guides.as_deref(), rendered.alpha.as_ref());
            output.write_exr(&rendered.film, guides, alpha)?;
            return Ok(noise);
        }
        let legend = self.legend.then(|| view.legend()).flatten();
        let mut size = view.size();
        if let Some(legend) = &legend {
            size.x = legend.width_together();
        }
        let strips = view.strips(self.strip_bytes)?;
        output.write_png_rows(size, |png| {
            for rows in strips.rows() {
                let rendered = view.trace(rows, meter)?;
                if self.noise {
                    noise.merge(&rendered.noise_sum());
                }
                let mut pixels = rendered.pixels();
                if let Some(pen) = pen.as_deref_mut() {
                    pen(&mut pixels, &rendered)?;
                }
                match &legend {
                    Some(legend) => png.write(&legend.beside(&pixels, rendered.rows.start))?,
                    None => png.write(&pixels)?,
                }
            }
            Ok::<(), CommandError>(())
        })?;
        Ok(noise)
    }

    /// Prints the noise and the scale of a picture if they are asked for; of one of several pictures with its name.
    fn print_figures(
        &self,
        (view, noise): (&PreparedView<'_>, &NoiseSum),
        (output, camera_count): (&Output, usize),
        out: &mut dyn Write,
    ) -> Result<(), CommandError> {
        let name = if camera_count > 1 {
            format!("{}: ", shown(output.path()))
        } else if self.picture.view.view.len() > 1 {
            format!("{}: ", view.name())
        } else {
            String::new()
        };
        if self.noise {
            writeln!(out, "{name}{}", noise_text(&noise.noise()))?;
        }
        if self.legend
            && let Some(scale) = view.scale()
        {
            writeln!(out, "{name}{scale}")?;
        }
        Ok(())
    }

    /// Refuses a size whose picture exceeds the memory limit on its own.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    fn check_size(&self, size: UVec2) -> Result<(), CommandError> {
        if self.needs_whole()? {
            return self.picture.check_size(size);
        }
        Ok(())
    }

    /// Whether some output is made from the whole picture, not from strips of it.
    fn needs_whole(&self) -> Result<bool, CommandError> {
        let is_exr = self.format()? == PictureFormat::Exr;
        Ok(is_exr || self.depth_map.is_some() || self.ids.is_some())
    }

    /// The format of the pictures.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if neither the option nor the name tells.
    fn format(&self) -> Result<PictureFormat, CommandError> {
        let named = || PictureFormat::of_name(&self.output);
        self.format.or_else(named).ok_or_else(|| {
            CommandError::Usage(format!(
                "the format of {} isn't known: the name must end in .png or .exr, or --format must be given",
                shown(&self.output)
            ))
        })
    }
}

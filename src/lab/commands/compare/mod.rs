//! `hitscope compare`: the differences of two surfaces, or of two pictures.

mod pictures;
mod surfaces;

use super::args::MeshArgs;
use super::camera::CameraArgs;
use super::colours::map_names;
use super::kernel::KernelArg;
use super::output::is_same_file;
use super::render::{parse_output, parse_png};
use super::{CommandError, ThreadsArg, is_stdin};
use clap::Args;
use hitscope_core::picture::PictureFile;
use std::io::Write;
use std::path::{Path, PathBuf};

const ABOUT: &str = "\
Measure the distances between two surfaces, or the differences of two pictures

Surfaces: OBJ files and scene files with meshes, such as two versions of a
mesh, or a mesh and its simplification. Distances are measured from each
vertex of A, and from points that are uniform over A's area, to the nearest
point of B, and back. `mean`, `rms` and the quantiles are those of the points;
`max` counts vertices, too, and is a lower bound of the Hausdorff distance.
Lengths are in units of the files, and also relative to the diagonal of the
box around both. With -o, A is drawn in the colours of its distance from B.

Pictures: .png, .exr and .hdr, of the same size; B is the reference. Numbers of
two .png are sRGB from 0 to 1, else linear RGB. With -o, the differences are
drawn.

Values of pictures, in the text and in JSON:

  mse, rmse          mean of the squared differences over pixels and
                     channels, and its square root
  psnr_db            peak signal-to-noise ratio for a peak of 1; null if there
                     is no difference
  relative_mse       of linear pictures: mean of (a - b)^2 / (b^2 + 0.01)
  worst              the largest difference with its pixel and channel
  pixels_over_tolerance
                     pixels with a channel that differs by more than
                     --tolerance
  non_finite_pixels  pixels with a number that isn't finite; they count in no
                     other figure";

const EXAMPLES: &str = "\
Examples:
  hitscope compare bunny.obj simplified.obj
  hitscope compare bunny.obj simplified.obj -o out.png --limit 0.01 --legend
  hitscope compare old.obj new.obj --json --one-sided
  hitscope compare render.png reference.png -o difference.png --gain 10

Exit status:
  0  success, however large the differences are
  1  a file can't be read, the scenes have no meshes, or the pictures differ in
     size
  2  the command line is wrong";

/// Measure the distances between two surfaces, or the differences of two pictures
#[derive(Args, Clone, Debug)]
#[command(long_about = ABOUT, after_help = EXAMPLES)]
pub struct CompareArgs {
    /// OBJ file, plain or gzipped, scene file (.xml) with meshes, or picture (.png, .exr, .hdr)
    pub a: PathBuf,
    /// File of the same kind; of pictures, the reference
    pub b: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Write a picture of A's distances from B, or of the differences; - for standard output
    #[arg(short, long, value_name = "OUT.png", value_parser = parse_png_output)]
    pub output: Option<PathBuf>,
    /// Options of surfaces.
    #[command(flatten, next_help_heading = "Surfaces")]
    pub surfaces: SurfaceOptions,
    /// Options of pictures.
    #[command(flatten, next_help_heading = "Pictures")]
    pub pictures: PictureOptions,
    /// How files are loaded.
    #[command(flatten, next_help_heading = "Options")]
    pub mesh: MeshArgs,
}

/// Options of surfaces
#[derive(Args, Clone, Debug)]
pub struct SurfaceOptions {
    /// Points of each surface from which distances are measured, 1 to 100000000
    #[arg(long, value_name = "N", default_value_t = 100_000, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    pub points: u32,
    /// Measure only from A to B
    #[arg(long)]
    pub one_sided: bool,
    /// Distance that has the last colour in the picture [default: the largest]
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true, requires = "output", value_parser = parse_length)]
    pub limit: Option<f64>,
    /// Colour map of the picture [default: viridis]
    #[arg(long, value_name = "NAME", requires = "output", value_parser = map_names())]
    pub colour_map: Option<String>,
    /// Draw a bar with the colours to the right of the picture
    #[arg(long, requires = "output")]
    pub legend: bool,
    /// Samples per pixel of the picture, 1 to 65536
    #[arg(long, value_name = "N", default_value_t = 4, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub samples: u32,
    /// Camera of the picture.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Kernel of the picture.
    #[command(flatten)]
    pub kernel: KernelArg,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
}

/// Options of pictures
#[derive(Args, Clone, Copy, Debug)]
pub struct PictureOptions {
    /// Count the pixels that differ by more than this
    #[arg(long, value_name = "DIFFERENCE", default_value_t = 0.01, allow_negative_numbers = true, value_parser = parse_tolerance)]
    pub tolerance: f64,
    /// Brighten the picture of the differences by this factor
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true, requires = "output", value_parser = parse_length)]
    pub gain: f64,
}

impl CompareArgs {
    /// Compares and prints.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let refuse = |message: &str| Err(CommandError::Usage(message.to_owned()));
        if [&self.a, &self.b].into_iter().any(|file| is_stdin(file)) {
            return refuse("compare needs two files, not standard input");
        }
        let output = self.output.as_deref();
        if output.is_some_and(|output| [&self.a, &self.b].iter().any(|f| is_same_file(f, output))) {
            return refuse("the output is one of the files that are compared");
        }
        match [&self.a, &self.b].map(|file| PictureFile::is_name_of_one(file)) {
            [true, true] => self.compare_pictures(out),
            [false, false] => self.compare_surfaces(out),
            _ => refuse("a picture can't be compared with a mesh"),
        }
    }

    /// The picture's output, which is checked before long work.
    fn created_output(&self) -> Result<Option<super::Output>, CommandError> {
        self.output
            .as_deref()
            .map(super::Output::create)
            .transpose()
    }

    /// Whether the output is standard output, so that nothing else can be printed there.
    fn prints_picture(&self) -> bool {
        self.output.as_deref().is_some_and(super::output::is_stream)
    }
}

/// `a: message`, where the message doesn't name the file.
fn about(file: &Path, message: impl std::fmt::Display) -> CommandError {
    let file = hitscope_core::obj::shown(file);
    CommandError::Other(format!("{file}: {message}"))
}

/// As [`parse_png`], or `-`.
fn parse_png_output(text: &str) -> Result<PathBuf, String> {
    let path = parse_output(text)?;
    parse_png(&path.to_string_lossy())
}

/// `0.5`.
fn parse_length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length > 0.0 && length.is_finite() => Ok(length),
        _ => Err("expected a number above 0".to_owned()),
    }
}

/// `0.01`.
fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance >= 0.0 && tolerance.is_finite() => Ok(tolerance),
        _ => Err("expected a number of at least 0".to_owned()),
    }
}

//! `hitscope inspect`: prints the inspection of one pixel's ray.

use super::CommandError;
use super::aim::AimArg;
use super::camera::CameraArgs;
use super::clip::ClipArgs;
use super::path::{PathArgs, print_path};
use super::scene::SceneArgs;
use super::thickness::{ThicknessArg, print_thickness};
use crate::inspection::{
    CrossingReport, ExactReport, HitReport, Inspection, KernelRow, OperandName, SolidReport,
};
use clap::Args;
use glam::UVec2;
use hitscope_core::counts::{counted, counted_as};
use hitscope_core::obj::shown;
use std::fmt::Debug;
use std::io::Write;

const ABOUT: &str = "\
Show the ray of one pixel: its hit with the formula, all crossings, the exact
answer, every kernel's answer

The ray goes through the centre of the pixel, as in `render` with the same
camera. The exact answer is computed with integers; the table compares every
kernel with it.

Values, in the text and in JSON:

  t                  in lengths of the ray's direction, which has unit length
                     up to rounding
  barycentric        barycentric coordinates for the triangle's corners A, B
                     and C
  triangle, face     indices, counted from 0, in the order of the file
  line               line of the face in the file, counted from 1
  side               front if the corners run counterclockwise as seen from
                     the ray's origin, else back
  position           in the file's coordinates
  parameters         of a shape other than a triangle, by name; points in the
                     file's coordinates
  solid              of a solid (csg): the operand that is hit, with its
                     parameters, and the tree of operations with the intervals
                     of t inside each part
  is_subtracted      whether an operand is subtracted: the solid's normal is
                     the opposite of its own
  formula            derivation of t in f64 for the ray r(t) = o + t d
  crossings          all points where the ray crosses a surface, by the chosen
                     kernel, ordered by t
  t_error_ulps       error of t, in ulps of f32
  barycentric_error  largest error of a barycentric coordinate
  ray_rounding       largest distance per coordinate, in units of the file,
                     between this ray and the camera's ray in f64, where they
                     may meet the scene. It is large for a distant camera.
  thickness          with --thickness: what one exact ray each way along the
                     normal on the ray's side hits. inwards: the other side of
                     the wall; outwards: the next surface in front; null if
                     there is none. distance is along the normal, in units of
                     the file
  path               of a sample, with --view or --sample: the surfaces that it
                     meets, and the light in linear RGB that each adds to the
                     sample's radiance, emitted there (emission) or scattered
                     straight from a light (direct). from_afar is the light of
                     the environment, or the background, at the end of the
                     path. throughput is the part of
                     further light that reaches the camera; arriving, the part
                     of the light that surfaces let pass; survival, the
                     probability with which Russian roulette let the path go
                     on. The random numbers are those of `render`: sample 0
                     goes through the pixel's centre.

--clip-plane and --clip-box end the ray at the clip: hit, crossings, the exact
answer and all kernels are of the part that is shown.

Numbers in JSON parse as doubles without loss.";

const EXAMPLES: &str = "\
Examples:
  hitscope inspect bunny.obj --pixel 640,360
  hitscope inspect bunny.obj --pixel 12,7 --size 100x100 --eye 0,0.1,1 --json
  hitscope inspect bunny.obj --pixel 640,360 --kernel exact --shading smooth
  hitscope inspect bunny.obj --pixel 640,360 --view path --sample 3
  hitscope inspect bunny.obj --look-at face:1234 --thickness

Exit status:
  0  success, even if the ray hits nothing
  1  the scene can't be read; one line on stderr has the reason
  2  the command line is wrong, for example the pixel is outside the picture";

/// Show the ray of one pixel: its hit with the formula, all crossings, the exact answer, every kernel's answer
#[derive(Args, Clone, Debug)]
#[command(long_about = ABOUT, after_help = EXAMPLES)]
pub struct InspectArgs {
    /// Scene, shading and kernel.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Pixel; 0,0 is at the top left [default with --look-at: the one in the middle]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = parse_pixel, required_unless_present = "look_at")]
    pub pixel: Option<UVec2>,
    /// Camera
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Element to look at.
    #[command(flatten)]
    pub aim: AimArg,
    /// Clip
    #[command(flatten)]
    pub clip: ClipArgs,
    /// Thickness.
    #[command(flatten)]
    pub thickness: ThicknessArg,
    /// The path of a sample.
    #[command(flatten)]
    pub path: PathArgs,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

impl InspectArgs {
    /// Traces the ray and prints its inspection.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        if let Some(size) = self.camera.known_size(&self.scene.file) {
            self.check_pixel(size)?;
        }
        self.camera.check()?;
        self.scene.check()?;
        self.path.check()?;
        let mut loaded = self.scene.load()?;
        loaded.scene = self.clip.apply(loaded.scene)?;
        let scene = &loaded.scene;
        let aimed = self.aim.aimed(&self.camera, &loaded, &self.scene.file)?;
        let camera = aimed.camera;
        self.check_pixel(camera.resolution())?;
        let intersector = self.scene.intersector(scene);
        let shading = self.scene.shading.into();
        let up_axis = self.camera.up_axis(loaded.view.as_ref());
        let pixel = self.pixel.unwrap_or(camera.resolution() / 2);
        let mut inspection = Inspection::of_pixel(scene, &*intersector, shading, &camera, pixel);
        inspection.thickness = self.thickness.report(scene, &camera, pixel);
        inspection.find_line(&loaded.report.face_lines);
        let for_path = (pixel, self.scene.mesh.memory.bytes());
        inspection.path =
            self.path
                .report(&loaded, intersector, (&camera, up_axis), shading, for_path)?;
        if self.json {
            writeln!(out, "{}", inspection.to_json())?;
        } else {
            print(&inspection, out)?;
        }
        Ok(())
    }

    fn check_pixel(&self, size: UVec2) -> Result<(), CommandError> {
        if let Some(pixel) = self.pixel
            && pixel.cmpge(size).any()
        {
            return Err(CommandError::PixelOutside {
                x: pixel.x,
                y: pixel.y,
                width: size.x,
                height: size.y,
            });
        }
        Ok(())
    }
}

fn print(inspection: &Inspection, out: &mut dyn Write) -> std::io::Result<()> {
    let Inspection {
        pixel: [x, y],
        ray,
        kernel,
        hit,
        crossings,
        exact,
        kernels,
        cost,
        thickness,
        path,
    } = inspection;
    writeln!(out, "pixel      {x},{y}")?;
    writeln!(
        out,
        "ray        from {} along {}",
        list(ray.origin),
        list(ray.direction)
    )?;
    writeln!(
        out,
        "           rounded by {}, in the file's units",
        at_most(ray.ray_rounding)
    )?;
    writeln!(
        out,
        "cost       {}, {}",
        counted_as(cost.boxes as usize, "box", "boxes"),
        counted(cost.triangles as usize, "primitive")
    )?;
    print_hit(kernel, hit.as_ref(), out)?;
    print_crossings(crossings, out)?;
    if let Some(thickness) = thickness {
        print_thickness(thickness.as_ref(), out)?;
    }
    print_exact(exact.as_ref(), out)?;
    print_kernels(kernels, out)?;
    path.iter().try_for_each(|path| print_path(path, out))
}

fn print_exact(exact: Option<&ExactReport>, out: &mut dyn Write) -> std::io::Result<()> {
    let Some(exact) = exact else {
        return writeln!(out, "exact: no hit");
    };
    match &exact.fractions {
        Some(fractions) => {
            writeln!(out, "exact: triangle {}, counted from 0", exact.primitive)?;
            writeln!(out, "  t            {} = {}", exact.t, fractions.t_fraction)?;
            writeln!(out, "  barycentric  {}", list(fractions.barycentric))
        }
        None => {
            writeln!(out, "exact: primitive {}, counted from 0", exact.primitive)?;
            writeln!(out, "  t            {}", exact.t)
        }
    }
}

fn print_kernels(kernels: &[KernelRow], out: &mut dyn Write) -> std::io::Result<()> {
    let longest = kernels.iter().map(|row| row.name.len()).max();
    let width = longest.unwrap_or(0).max("kernel".len());
    writeln!(
        out,
        "{:<width$} {:>14} {:>14} {:>14}",
        "kernel", "t", "t error, ulps", "bary. error"
    )?;
    let number = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.3e}"));
    for row in kernels {
        let t = row.t.map_or("miss".to_owned(), |t| t.to_string());
        let (ulps, weights) = (number(row.t_error_ulps), number(row.barycentric_error));
        let name = row.name;
        writeln!(out, "{name:<width$} {t:>14} {ulps:>14} {weights:>14}")?;
    }
    Ok(())
}

fn print_hit(kernel: &str, hit: Option<&HitReport>, out: &mut dyn Write) -> std::io::Result<()> {
    let Some(hit) = hit else {
        return writeln!(out, "{kernel}: no hit");
    };
    let side = hit.side;
    match &hit.triangle {
        Some(triangle) => {
            let (index, face) = (triangle.index, triangle.face);
            let line = triangle.line;
            let line = line.map_or(String::new(), |line| format!(" on line {line}"));
            writeln!(
                out,
                "{kernel}: {side} side of triangle {index} in face {face}{line} (triangles and faces are counted from 0)"
            )?;
        }
        None => writeln!(
            out,
            "{kernel}: {side} side of {} (primitive {}, counted from 0)",
            hit.shape, hit.primitive
        )?,
    }
    let mut rows = vec![("t", hit.t.to_string())];
    if let Some(triangle) = &hit.triangle {
        rows.push(("barycentric", list(triangle.barycentric)));
    }
    rows.extend([
        ("position", list(hit.position)),
        ("normal", list(hit.geometric_normal) + " geometric"),
        ("", list(hit.shading_normal) + " shading"),
    ]);
    if let Some(triangle) = &hit.triangle {
        let [a, b, c] = triangle.vertices.map(list);
        rows.extend([("vertices", a), ("", b), ("", c)]);
    } else {
        for parameter in hit.parameters.iter().flat_map(|parameters| &parameters.0) {
            rows.push((parameter.name, parameter.value.to_string()));
        }
    }
    rows.extend(hit.solid.iter().flat_map(operand_rows));
    if let Some(uv) = hit.surface_uv {
        rows.push(("u, v", format!("{uv:?}")));
    }
    rows.push((
        "material",
        format!("{}, group {}", or_dash(&hit.material), or_dash(&hit.group)),
    ));
    for (name, value) in rows {
        writeln!(out, "  {name:<12} {value}")?;
    }
    writeln!(out, "formula")?;
    hit.formula
        .iter()
        .try_for_each(|line| writeln!(out, "  {line}"))
}

/// The operand of a solid that is hit.
fn operand_rows(solid: &SolidReport) -> Vec<(&'static str, String)> {
    let operand = &solid.operand;
    let OperandName { index, shape } = operand.name;
    let subtracted = if operand.is_subtracted {
        ", subtracted: the solid's normal is the opposite of its own"
    } else {
        ""
    };
    let mut rows = vec![("operand", format!("{index}, {shape}{subtracted}"))];
    let parameters = operand.parameters.0.iter();
    rows.extend(parameters.map(|parameter| (parameter.name, parameter.value.to_string())));
    rows
}

fn print_crossings(crossings: &[CrossingReport], out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "{}", counted(crossings.len(), "crossing"))?;
    for (index, crossing) in (1..).zip(crossings) {
        let CrossingReport {
            t,
            shape,
            primitive,
            side,
            ..
        } = crossing;
        let operand = crossing.operand.map_or_else(String::new, |operand| {
            format!(", operand {}, {}", operand.index, operand.shape)
        });
        let also = match crossing.also.len() {
            0 => String::new(),
            count => format!(" and {count} more"),
        };
        writeln!(
            out,
            "  {index:>3}  t {t:<14} {side:<5} of {shape} {primitive}{operand}{also}"
        )?;
    }
    Ok(())
}

/// A name from the file, without control characters; a dash if it is empty.
fn or_dash(name: &str) -> String {
    if name.is_empty() {
        "–".to_owned()
    } else {
        shown(name.as_ref())
    }
}

/// A bound with two digits, rounded up.
pub(super) fn at_most(bound: f64) -> String {
    if bound == 0.0 {
        return "0".to_owned();
    }
    let digit = 0.1 * 10_f64.powi(bound.log10().floor() as i32);
    let rounded = format!("{bound:.1e}");
    let is_less = rounded.parse::<f64>().is_ok_and(|rounded| rounded < bound);
    let rounded = if is_less {
        format!("{:.1e}", bound + 0.5 * digit)
    } else {
        rounded
    };
    format!("at most {rounded}")
}

/// Formats three numbers, minus zero as zero.
pub(super) fn list<T: Copy + Debug + Default + PartialEq>(numbers: [T; 3]) -> String {
    let plain = |x: T| if x == T::default() { T::default() } else { x };
    format!("{:?}", numbers.map(plain))
}

/// `640,360`.
fn parse_pixel(text: &str) -> Result<UVec2, String> {
    let parts = text.split_once(',');
    let numbers = parts.map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    match numbers {
        Some((Ok(x), Ok(y))) => Ok(UVec2::new(x, y)),
        _ => Err("expected two non-negative integers, such as 640,360".to_owned()),
    }
}

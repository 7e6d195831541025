//! `hitscope inspect`: what happens to one pixel's ray.

use super::CommandError;
use super::args::{CameraArgs, CreaseArg, KernelArg, MeshArgs};
use super::picture::ShadingArg;
use crate::inspection::{HitReport, Inspection};
use clap::Args;
use glam::UVec2;
use hitscope_core::obj::Recentre;
use std::io::Write;
use std::path::PathBuf;

/// Show the ray of one pixel: its hit, the exact answer, and the answer of every kernel
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope inspect bunny.obj --pixel 640,360
  hitscope inspect bunny.obj --pixel 12,80 --size 100x100 --eye 3,2,4 --target 0,1,0 --json")]
pub struct InspectArgs {
    /// OBJ file, plain or gzipped; - for standard input
    pub file: PathBuf,
    /// The pixel, counted from 0,0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub pixel: UVec2,
    /// Camera
    #[command(flatten)]
    pub camera: CameraArgs,
    /// How the shading normal varies over a triangle
    #[arg(long, default_value = "flat")]
    pub shading: ShadingArg,
    /// Kernel
    #[command(flatten)]
    pub kernel: KernelArg,
    /// Where smooth shading has edges.
    #[command(flatten)]
    pub crease: CreaseArg,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

impl InspectArgs {
    /// Traces the ray and prints what is known of it.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let (pixel, size) = (self.pixel, self.camera.size);
        if pixel.cmpge(size).any() {
            return Err(CommandError::PixelOutside {
                x: pixel.x,
                y: pixel.y,
                width: size.x,
                height: size.y,
            });
        }
        self.camera.check()?;
        self.crease.check(self.shading)?;
        let scene = self.mesh.load(&self.file, Recentre::Auto)?.scene;
        let scene = self.crease.apply(scene);
        let camera = self.camera.camera(&scene)?;
        let intersector = scene.intersector(self.kernel.kernel());
        let inspection =
            Inspection::of_pixel(&scene, &*intersector, self.shading.into(), &camera, pixel);
        if self.json {
            let json = serde_json::to_string_pretty(&inspection);
            writeln!(out, "{}", json.expect("an inspection is plain data"))?;
        } else {
            print(&inspection, out)?;
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
        exact,
        kernels,
        cost,
    } = inspection;
    writeln!(out, "pixel      {x},{y}")?;
    writeln!(
        out,
        "ray        from {:?} along {:?}",
        ray.origin, ray.direction
    )?;
    writeln!(
        out,
        "cost       {} boxes, {} triangles",
        cost.boxes, cost.triangles
    )?;
    print_hit(kernel, hit.as_ref(), out)?;
    match exact {
        None => writeln!(out, "exactly: no hit")?,
        Some(exact) => {
            writeln!(out, "exactly: triangle {}", exact.triangle)?;
            writeln!(out, "  t            {} = {}", exact.t, exact.t_fraction)?;
            writeln!(out, "  barycentric  {:?}", exact.barycentric)?;
        }
    }
    writeln!(
        out,
        "{:<18} {:>14} {:>12} {:>12}",
        "kernel", "t", "ulps off", "weights off"
    )?;
    let number = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.3e}"));
    for row in kernels {
        let t = row.t.map_or("miss".to_owned(), |t| t.to_string());
        let (ulps, weights) = (number(row.t_error_ulps), number(row.barycentric_error));
        writeln!(out, "{:<18} {t:>14} {ulps:>12} {weights:>12}", row.name)?;
    }
    Ok(())
}

fn print_hit(kernel: &str, hit: Option<&HitReport>, out: &mut dyn Write) -> std::io::Result<()> {
    match hit {
        None => writeln!(out, "{kernel}: no hit")?,
        Some(hit) => {
            writeln!(
                out,
                "{kernel}: triangle {} of face {}",
                hit.triangle, hit.face
            )?;
            writeln!(out, "  t            {}", hit.t)?;
            writeln!(out, "  barycentric  {:?}", hit.barycentric)?;
            writeln!(out, "  position     {:?}", hit.position)?;
            writeln!(out, "  normal       {:?} geometric", hit.geometric_normal)?;
            writeln!(out, "               {:?} shading", hit.shading_normal)?;
            writeln!(out, "  vertices     {:?}", hit.vertices[0])?;
            writeln!(out, "               {:?}", hit.vertices[1])?;
            writeln!(out, "               {:?}", hit.vertices[2])?;
            writeln!(
                out,
                "  material     {:?}, group {:?}",
                hit.material, hit.group
            )?;
        }
    }
    Ok(())
}

/// `640,360`.
fn parse_pixel(text: &str) -> Result<UVec2, String> {
    let parts = text.split_once(',');
    let numbers = parts.map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    match numbers {
        Some((Ok(x), Ok(y))) => Ok(UVec2::new(x, y)),
        _ => Err("expected two whole numbers, as in 640,360".to_owned()),
    }
}

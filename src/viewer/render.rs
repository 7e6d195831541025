//! The command `render`: the headless picture, with overlays that need a GPU.

use crate::gpu::GpuError;
use crate::gpu::adapter::Gpu;
use crate::offscreen;
use hitscope_lab::commands::{CommandError, Output, RenderArgs, Rendered};
use std::io::Write;

/// Renders the pictures and writes all outputs.
///
/// # Errors
/// See [`CommandError`].
pub fn run(args: &RenderArgs, out: &mut dyn Write) -> Result<(), CommandError> {
    let failed = |error: GpuError| CommandError::Other(error.to_string());
    // Do everything that can fail without the mesh before loading it.
    args.check()?;
    let outputs = args.outputs()?;
    let gpu = args.has_overlay().then(Gpu::open);
    let gpu = gpu.transpose().map_err(failed)?;
    let prepared = args.prepare()?;
    for (view, output) in prepared.views().iter().zip(&outputs.pictures) {
        let rendered = prepared.trace(view)?;
        let mut pixels = rendered.film.pixels().to_vec();
        if let Some(gpu) = &gpu {
            offscreen::draw_over(gpu, &mut pixels, args, &rendered).map_err(failed)?;
        }
        write_picture(args, &rendered, pixels, output)?;
        print_figures(args, &rendered, out)?;
    }
    outputs.write_surfaces(&prepared)
}

fn write_picture(
    args: &RenderArgs,
    rendered: &Rendered,
    pixels: Vec<[u8; 4]>,
    output: &Output,
) -> Result<(), CommandError> {
    if args.is_exr() {
        return output.write_exr(&rendered.film, rendered.guides.as_deref());
    }
    let legend = args.legend.then(|| rendered.with_legend(&pixels)).flatten();
    let (size, pixels) = legend.unwrap_or((rendered.film.size(), pixels));
    output.write_png(size, &pixels)
}

/// Prints the noise and the scale of a picture if they are asked for.
fn print_figures(
    args: &RenderArgs,
    rendered: &Rendered,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let view = if args.picture.view.view.len() > 1 {
        format!("{}: ", rendered.view.name)
    } else {
        String::new()
    };
    if args.noise {
        writeln!(out, "{view}{}", rendered.noise())?;
    }
    if args.legend
        && let Some(scale) = &rendered.scale
    {
        writeln!(out, "{view}{scale}")?;
    }
    Ok(())
}

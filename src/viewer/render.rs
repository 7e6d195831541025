//! The command `render`: the headless pictures, with overlays that need a GPU.

use crate::gpu::GpuError;
use crate::gpu::adapter::Gpu;
use crate::offscreen;
use hitscope_lab::commands::{CommandError, OverlayPen, RenderArgs, Rendered};
use std::io::Write;

/// Renders the pictures and writes all outputs.
///
/// # Errors
/// See [`CommandError`].
pub fn run(args: &RenderArgs, out: &mut dyn Write) -> Result<(), CommandError> {
    let failed = |error: GpuError| CommandError::Other(error.to_string());
    let open_pen = || -> Result<OverlayPen<'_>, CommandError> {
        let gpu = Gpu::open().map_err(failed)?;
        let draw = move |pixels: &mut [[u8; 4]], rendered: &Rendered| {
            offscreen::draw_over(&gpu, pixels, args, rendered).map_err(failed)
        };
        Ok(Box::new(draw))
    };
    args.run(open_pen, out)
}

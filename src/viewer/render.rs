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
        let mut overlays = None;
        let draw = move |pixels: &mut [[u8; 4]], rendered: &Rendered| {
            let tiles = match &mut overlays {
                // A later strip of the same picture.
                Some(tiles) if rendered.rows.start > 0 => tiles,
                overlays => {
                    let tiles = offscreen::overlays_of(&gpu, args, rendered);
                    overlays.insert(tiles.map_err(failed)?)
                }
            };
            tiles
                .draw_onto(pixels, rendered.rows.start, || true)
                .map_err(failed)
        };
        Ok(Box::new(draw))
    };
    args.run(open_pen, out)
}

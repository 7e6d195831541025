//! Renders and saves a picture of any size on a thread of its own.

use crate::gpu::GpuError;
use crate::offscreen::OverlayTiles;
use crate::overlay::{OverlayInput, Overlays};
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, RenderError, Strip, Strips};
use hitscope_core::tone::Display;
use hitscope_lab::commands::{CommandError, Output, PngRows, default_thread_count};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

/// The file format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// 8 bits per channel, as on the screen. Rendered in strips.
    Png,
    /// Linear radiance, without overlay. Rendered whole.
    Exr,
}

/// A picture to render and save.
pub(super) struct Order {
    pub job: Job,
    pub display: Display,
    pub overlay: Option<OrderedOverlay>,
    pub format: Format,
    pub path: PathBuf,
    /// Memory of the strips in bytes.
    pub strip_bytes: u64,
}

/// The lines over the picture.
pub(super) struct OrderedOverlay {
    pub input: OverlayInput,
    pub overlays: Overlays,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

/// The state that the window and the thread share.
#[derive(Default)]
pub(super) struct OrderState {
    /// The traced part in thousandths.
    thousandths: AtomicU32,
    /// Cancels the work.
    progress: Progress,
}

impl OrderState {
    /// The traced part, from 0 to 1.
    pub fn part(&self) -> f32 {
        self.thousandths.load(Ordering::Relaxed) as f32 / 1000.0
    }

    /// Stops the thread, which then frees its memory.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    fn goes_on(&self) -> bool {
        self.progress.check().is_ok()
    }
}

/// The reason why no picture was saved.
enum Stopped {
    Cancelled,
    Failed(String),
}

impl From<CommandError> for Stopped {
    fn from(error: CommandError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<GpuError> for Stopped {
    fn from(error: GpuError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<RenderError> for Stopped {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Cancelled => Self::Cancelled,
            error => Self::Failed(error.to_string()),
        }
    }
}

impl Order {
    /// Renders and saves the picture; `None` if it was cancelled.
    pub fn carry_out(self, state: &OrderState) -> Result<Option<PathBuf>, String> {
        match self.save(state) {
            Ok(()) => Ok(Some(self.path)),
            Err(Stopped::Cancelled) => Ok(None),
            Err(Stopped::Failed(message)) => Err(message),
        }
    }

    fn save(&self, state: &OrderState) -> Result<(), Stopped> {
        let output = Output::create(&self.path)?;
        let size = self.job.plan.size();
        match self.format {
            Format::Exr => {
                let whole = self.render(0..size.y, state)?;
                Ok(output.write_exr(&whole.film, None, whole.alpha.as_ref())?)
            }
            Format::Png => output.write_png_rows(size, |png| self.write_strips(png, state)),
        }
    }

    fn write_strips(&self, png: &mut PngRows<'_>, state: &OrderState) -> Result<(), Stopped> {
        let prepare = |overlay: &OrderedOverlay| {
            let gpu = (&overlay.device, &overlay.queue);
            OverlayTiles::new(gpu, &overlay.input, &overlay.overlays)
        };
        let mut overlay = self.overlay.as_ref().map(prepare).transpose()?;
        for rows in Strips::new(self.job.plan.size(), self.strip_bytes).rows() {
            let mut pixels = self.render(rows.clone(), state)?.pixels();
            if let Some(overlay) = &mut overlay {
                overlay.draw_onto(&mut pixels, rows.start, || state.goes_on())?;
            }
            if !state.goes_on() {
                return Err(Stopped::Cancelled);
            }
            png.write(&pixels)?;
        }
        Ok(())
    }

    fn render(&self, rows: Range<u32>, state: &OrderState) -> Result<Strip, RenderError> {
        let goes_on = |part: f64| {
            let thousandths = (1000.0 * part) as u32;
            state.thousandths.store(thousandths, Ordering::Relaxed);
            state.goes_on()
        };
        let threads = default_thread_count();
        let mut strip = Strip::render(&self.job, rows, threads, &state.progress, goes_on)?;
        strip.film.set_display(self.display);
        Ok(strip)
    }
}

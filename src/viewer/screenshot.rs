//! `--screenshot`: a picture of the whole window once it has converged, then the end.

use glam::UVec2;
use hitscope_lab::commands::write_png;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What was asked for.
#[derive(Clone, Debug)]
pub struct ScreenshotOptions {
    /// The PNG file to write.
    pub output: PathBuf,
    /// When; once the picture has converged without it.
    pub after: Option<Duration>,
    /// Where the result goes: the window is gone when the caller looks at it.
    pub outcome: Outcome,
}

/// What came of it; `None` while it isn't done.
pub type Outcome = Arc<Mutex<Option<Result<(), String>>>>;

/// A screenshot on its way.
pub struct Screenshot {
    options: ScreenshotOptions,
    since: Instant,
    is_requested: bool,
}

impl Screenshot {
    /// The clock starts now.
    pub fn new(options: ScreenshotOptions) -> Self {
        Self {
            options,
            since: Instant::now(),
            is_requested: false,
        }
    }

    /// Closes the window: there is nothing to take a picture of.
    pub fn fail(&self, ctx: &egui::Context, message: String) {
        let mut outcome = self
            .options
            .outcome
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *outcome = Some(Err(message));
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Takes the picture when it is time, and closes the window when it is written.
    pub fn step(&mut self, ctx: &egui::Context, is_settled: bool) {
        if self.is_requested {
            let outcome = self.options.outcome.lock();
            if outcome.unwrap_or_else(PoisonError::into_inner).is_some() {
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            return;
        }
        let is_time = match self.options.after {
            Some(after) => self.since.elapsed() >= after,
            None => is_settled,
        };
        if !is_time {
            ctx.request_repaint_after(Duration::from_millis(100));
            return;
        }
        self.is_requested = true;
        let (ctx_then, options) = (ctx.clone(), self.options.clone());
        ctx.request_screenshot(move |image| {
            let size = UVec2::new(image.width() as u32, image.height() as u32);
            let pixels: Vec<[u8; 4]> = image.pixels.iter().map(egui::Color32::to_array).collect();
            let result = write_png(&options.output, size, &pixels).map_err(|e| e.to_string());
            let mut outcome = options
                .outcome
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            *outcome = Some(result);
            ctx_then.request_repaint();
        });
        ctx.request_repaint();
    }
}

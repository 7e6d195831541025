//! The `--screenshot` option: saves a picture of the window when rendering has converged, and quits.

use glam::UVec2;
use hitscope_lab::commands::Output;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time and destination of a screenshot.
#[derive(Clone, Debug)]
pub struct ScreenshotOptions {
    /// The PNG file to write.
    pub output: Output,
    /// Time from the start to the screenshot; `None` to wait until rendering has converged.
    pub after: Option<Duration>,
    /// The result, which the caller reads after the window has closed.
    pub outcome: Outcome,
}

/// The result of a screenshot; `None` until it is taken.
pub type Outcome = Arc<Mutex<Option<Result<(), String>>>>;

/// A pending screenshot.
pub struct Screenshot {
    options: ScreenshotOptions,
    since: Instant,
    is_requested: bool,
}

impl Screenshot {
    /// Starts the clock.
    pub fn new(options: ScreenshotOptions) -> Self {
        Self {
            options,
            since: Instant::now(),
            is_requested: false,
        }
    }

    /// Sets the outcome to an error and closes the window.
    pub fn fail(&self, ctx: &egui::Context, message: String) {
        let mut outcome = self
            .options
            .outcome
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *outcome = Some(Err(message));
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Requests the screenshot when it is due, and closes the window once the file is written.
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
            let result = options
                .output
                .write_png(size, &pixels)
                .map_err(|e| e.to_string());
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

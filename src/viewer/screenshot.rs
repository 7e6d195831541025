//! The `--screenshot` option: saves a picture of the window when it is due, and quits.

use glam::UVec2;
use hitscope_lab::commands::Output;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// When a screenshot is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Due {
    /// When rendering has converged.
    #[default]
    Converged,
    /// This long after the window was opened.
    After(Duration),
    /// As soon as the first traced picture is shown.
    FirstPicture,
}

/// The result of a screenshot besides its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken {
    /// The time from the start of the program to the first traced picture; `None` if none was shown yet.
    pub first_picture: Option<Duration>,
}

/// Time and destination of a screenshot.
#[derive(Clone, Debug)]
pub struct ScreenshotOptions {
    /// The PNG file to write.
    pub output: Output,
    /// When it is taken.
    pub due: Due,
    /// The result, which the caller reads after the window has closed.
    pub outcome: Outcome,
}

impl ScreenshotOptions {
    fn outcome(&self) -> MutexGuard<'_, Option<Result<Taken, String>>> {
        self.outcome.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the pixels and sets the outcome, unless it is an error already.
    fn finish(&self, size: UVec2, pixels: &[[u8; 4]], taken: Taken) {
        let mut outcome = self.outcome();
        if outcome.is_none() {
            let written = self.output.write_png(size, pixels);
            let written = written.map_err(|error| error.to_string());
            *outcome = Some(written.map(|()| taken));
        }
    }
}

/// The result of a screenshot; `None` until it is taken.
pub type Outcome = Arc<Mutex<Option<Result<Taken, String>>>>;

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

    /// Sets the outcome to an error, whatever it was, and closes the window. No screenshot follows.
    pub fn fail(&mut self, ctx: &egui::Context, message: String) {
        self.is_requested = true;
        *self.options.outcome() = Some(Err(message));
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Requests the screenshot when it is due, and closes the window once the file is written.
    pub fn step(&mut self, ctx: &egui::Context, is_settled: bool, first_picture: Option<Duration>) {
        if self.is_requested {
            if self.options.outcome().is_some() {
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            return;
        }
        let is_time = match self.options.due {
            Due::After(after) => self.since.elapsed() >= after,
            Due::Converged => is_settled,
            Due::FirstPicture => first_picture.is_some(),
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
            options.finish(size, &pixels, Taken { first_picture });
            ctx_then.request_repaint();
        });
        ctx.request_repaint();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_the_outcome_although_the_screenshot_is_due() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("window.png");
        let options = ScreenshotOptions {
            output: Output::create(&path).expect("writable"),
            due: Due::After(Duration::ZERO),
            outcome: Outcome::default(),
        };
        let ctx = egui::Context::default();
        let mut screenshot = Screenshot::new(options.clone());
        screenshot.fail(&ctx, "no such file".to_owned());
        let mut asks_for_picture = false;
        for _ in 0..3 {
            let mut output = ctx.run_pass(egui::RawInput::default(), |ctx| {
                screenshot.step(ctx, true, None);
            });
            output.textures_delta.clear();
            let mut commands = output.viewport_output.values().flat_map(|of| &of.commands);
            asks_for_picture |=
                commands.any(|command| matches!(command, egui::ViewportCommand::Screenshot(_)));
        }
        assert!(!asks_for_picture);
        // A picture that was asked for before the error.
        let taken = Taken {
            first_picture: None,
        };
        options.finish(UVec2::ONE, &[[0; 4]], taken);
        assert_eq!(*options.outcome(), Some(Err("no such file".to_owned())));
        assert!(!path.exists());
    }
}

//! The dialog for pictures of any size: they are rendered in the background and saved beside the open file.

use super::App;
use super::picture_order::{Format, Order, OrderState, OrderedOverlay};
use super::pictures::free_path;
use crate::number_field::number_field;
use crate::task::{Task, TaskPanicked};
use egui::ProgressBar;
use glam::{UVec2, Vec3};
use hitscope_core::camera::MAX_SIDE;
use hitscope_core::obj::shown;
use hitscope_core::plan::{MAX_SAMPLES, Plan};
use hitscope_core::render::Job;
use hitscope_lab::commands::require_picture_memory;
use hitscope_lab::progress::{seconds_text, time_left};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// The options of the picture, and the one that is being rendered.
pub(super) struct PictureDialog {
    is_open: bool,
    /// Whether the dialog was shown before; the first time, it has the samples of the window.
    was_shown: bool,
    size: UVec2,
    samples: u32,
    has_overlay: bool,
    is_transparent: bool,
    format: Format,
    rendering: Option<Rendering>,
}

impl Default for PictureDialog {
    fn default() -> Self {
        Self {
            is_open: false,
            was_shown: false,
            size: UVec2::new(1920, 1080),
            samples: 64,
            has_overlay: true,
            is_transparent: false,
            format: Format::Png,
            rendering: None,
        }
    }
}

/// A picture that is being rendered.
struct Rendering {
    state: Arc<OrderState>,
    /// `None` if it was cancelled.
    task: Task<Result<Option<PathBuf>, String>>,
}

impl Drop for Rendering {
    fn drop(&mut self) {
        self.state.cancel();
    }
}

/// What the user clicks in the dialog.
#[derive(PartialEq, Eq)]
enum Choice {
    Render,
    Cancel,
    UseWindowSize,
}

impl PictureDialog {
    /// Closes the dialog. Returns whether it was open.
    pub fn dismiss(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Time since rendering began; `None` if the dialog is open or no picture is being rendered.
    pub fn hidden_elapsed(&self) -> Option<Duration> {
        let rendering = self.rendering.as_ref().filter(|_| !self.is_open)?;
        Some(rendering.task.elapsed())
    }

    /// Stops rendering.
    pub fn cancel(&mut self) {
        self.rendering = None;
    }

    fn dialog_ui(&mut self, ctx: &egui::Context, compares: bool) -> Option<Choice> {
        let mut is_open = self.is_open;
        let shown = egui::Window::new("Render a picture")
            .open(&mut is_open)
            .collapsible(false)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(ctx.content_rect().center())
            .resizable(false)
            .show(ctx, |ui| match &self.rendering {
                Some(rendering) => {
                    ui.ctx().request_repaint_after(Duration::from_millis(100));
                    let (part, elapsed) = (rendering.state.part(), rendering.task.elapsed());
                    let bar = ProgressBar::new(part).text(progress_text(part, elapsed));
                    ui.add(bar.desired_width(240.0));
                    ui.button("Cancel").clicked().then_some(Choice::Cancel)
                }
                None => self.options_ui(ui, compares),
            });
        self.is_open = is_open;
        shown.and_then(|shown| shown.inner).flatten()
    }

    /// Shows the options; `compares` tells whether the view compares kernels.
    fn options_ui(&mut self, ui: &mut egui::Ui, compares: bool) -> Option<Choice> {
        let mut choice = None;
        ui.horizontal(|ui| {
            for (name, side) in [("Width", &mut self.size.x), ("Height", &mut self.size.y)] {
                let label = ui.label(name);
                let value = number_field(side).range(1..=MAX_SIDE);
                ui.add(value).labelled_by(label.id);
            }
            let button = ui.button("Size of the window's picture");
            if button.clicked() {
                choice = Some(Choice::UseWindowSize);
            }
        });
        ui.horizontal(|ui| {
            let label = ui.label("Samples");
            let samples = number_field(&mut self.samples).range(1..=MAX_SAMPLES);
            ui.add(samples).labelled_by(label.id);
        });
        ui.horizontal(|ui| {
            ui.radio_value(&mut self.format, Format::Png, "PNG")
                .on_hover_text("As on the screen, 8 bits per channel");
            ui.radio_value(&mut self.format, Format::Exr, "EXR")
                .on_hover_text("Linear radiance, without exposure or overlay");
        });
        let lines = egui::Checkbox::new(&mut self.has_overlay, "Include overlay");
        ui.add_enabled(self.format == Format::Png, lines);
        let background = egui::Checkbox::new(&mut self.is_transparent, "Transparent background");
        ui.add_enabled(!compares, background)
            .on_hover_text("Alpha is the fraction of a pixel's samples that hit something")
            .on_disabled_hover_text("Views that compare kernels have no transparent background");
        let render = ui.button("Render");
        let render = render.on_hover_text("Renders the picture and saves it beside the open file");
        if render.clicked() {
            choice = Some(Choice::Render);
        }
        choice
    }
}

/// The rendered part and the time left, such as `12.3 %, 5m 20s left`.
fn progress_text(part: f32, elapsed: Duration) -> String {
    let percent = format!("{:.1} %", (1000.0 * part).floor() / 10.0);
    match time_left(part.into(), elapsed) {
        Some(left) => format!("{percent}, {} left", seconds_text(left)),
        None => percent,
    }
}

impl App {
    /// Shows the dialog, or closes it.
    pub(crate) fn toggle_picture_dialog(&mut self) {
        let dialog = &mut self.pictures.dialog;
        dialog.is_open ^= true;
        if !std::mem::replace(&mut dialog.was_shown, true) {
            dialog.samples = self.seen.settings.samples;
        }
    }

    /// Shows the dialog if it is open.
    pub(super) fn picture_dialog_ui(&mut self, ctx: &egui::Context, frame: &eframe::Frame) {
        match self.pictures.dialog.dialog_ui(ctx, self.compares_kernels()) {
            None => (),
            Some(Choice::UseWindowSize) => self.pictures.dialog.size = self.shown.resolution,
            Some(Choice::Cancel) => self.pictures.dialog.cancel(),
            Some(Choice::Render) => self.render_picture(ctx, frame),
        }
    }

    /// Whether the view compares kernels.
    fn compares_kernels(&self) -> bool {
        self.seen.settings.second_kernel().is_some()
    }

    fn render_picture(&mut self, ctx: &egui::Context, frame: &eframe::Frame) {
        let dialog = &self.pictures.dialog;
        let (size, samples, format) = (dialog.size, dialog.samples, dialog.format);
        let limit = self.open.load_options.max_memory;
        let fits = match format {
            Format::Png => Ok(()),
            Format::Exr => require_picture_memory(size, limit),
        };
        if let Err(message) = fits {
            return self.error(message);
        }
        let has_lines = dialog.has_overlay && format == Format::Png;
        let is_transparent = dialog.is_transparent && !self.compares_kernels();
        let mut request = self.wanted(ctx, size);
        if is_transparent {
            request.context.background = Vec3::ZERO;
            request.context.options.has_transparent_background = true;
        }
        let (scene, camera) = (Arc::clone(&request.context.scene), request.context.camera);
        let enlarged = size.y as f32 / self.shown.resolution.y.max(1) as f32;
        let scale = ctx.pixels_per_point() * enlarged;
        let overlay = frame.wgpu_render_state().filter(|_| has_lines).map(|gpu| {
            let input = self.overlay_input(&scene, camera, scale);
            let overlays = self.seen.settings.overlays.clone();
            OrderedOverlay {
                input,
                overlays,
                device: gpu.device.clone(),
                queue: gpu.queue.clone(),
            }
        });
        let extension = match format {
            Format::Png => "png",
            Format::Exr => "exr",
        };
        let open = self.open.document.path.as_deref();
        let order = Order {
            job: Job {
                context: request.context,
                integrator: request.integrator,
                plan: Plan::new(size, 1, samples.next_power_of_two()),
            },
            display: self.seen.settings.display(),
            overlay,
            format,
            path: free_path(open.unwrap_or(Path::new("hitscope")), extension),
            strip_bytes: self.pictures.strip_bytes,
        };
        let state = Arc::new(OrderState::default());
        let shared = Arc::clone(&state);
        let task = Task::spawn("render", ctx, move || order.carry_out(&shared));
        self.pictures.dialog.rendering = Some(Rendering { state, task });
    }

    /// The part of the dialog's picture that is traced, from 0 to 1; `None` if none is being rendered.
    pub fn rendered_part(&self) -> Option<f32> {
        let rendering = self.pictures.dialog.rendering.as_ref()?;
        Some(rendering.state.part())
    }

    /// Tells when the picture is saved.
    pub(super) fn poll_rendering(&mut self) {
        let rendering = self.pictures.dialog.rendering.as_ref();
        let result = match rendering.map(|rendering| rendering.task.poll()) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(result))) => result,
            Some(Err(broken @ TaskPanicked)) => Err(broken.to_string()),
        };
        self.pictures.dialog.rendering = None;
        match result {
            Ok(Some(path)) => self.tell(format!("Saved {}", shown(&path))),
            Ok(None) => (),
            Err(error) => self.error(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimate_of_the_time_left_assumes_constant_speed() {
        let text = |part, secs| progress_text(part, Duration::from_secs(secs));
        assert_eq!(text(0.0, 60), "0.0 %");
        assert_eq!(text(0.5, 0), "50.0 %");
        assert_eq!(text(0.5, 30), "50.0 %, 30s left");
        assert_eq!(text(0.25, 100), "25.0 %, 5m left");
        assert_eq!(text(0.999, 1000), "99.9 %, 2s left");
    }
}

//! Opening files: the system's dialog, a typed path, and the thread that loads.

use crate::document::Document;
use crate::settings::Settings;
use crate::task::{Task, TaskPanicked};
use hitscope_core::obj::{LoadError, LoadOptions};
use hitscope_core::progress::Progress;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A dialog that ends without a file in less time than this was never shown.
const TOO_QUICK: Duration = Duration::from_millis(200);

/// The way from Ctrl+O to a path.
#[derive(Default)]
pub struct OpenDialog {
    native: Option<(Instant, Task<Option<PathBuf>>)>,
    /// The field that stands in for the system's dialog.
    field: Option<PathField>,
}

struct PathField {
    path: String,
    why: String,
    is_new: bool,
}

impl OpenDialog {
    /// Shows the system's dialog, unless it is there already.
    pub fn open(&mut self, ctx: &egui::Context, frame: &eframe::Frame, folder: Option<&Path>) {
        if self.native.is_some() {
            return;
        }
        let mut dialog = rfd::AsyncFileDialog::new()
            .set_title("Open a mesh")
            .add_filter("Wavefront OBJ", &["obj", "OBJ", "obj.gz", "gz"])
            .add_filter("All files", &["*"])
            .set_parent(frame);
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        // The future is made here, as macOS demands, and waited for elsewhere.
        let choice = dialog.pick_file();
        let wait = move || pollster::block_on(choice).map(|file| file.path().to_owned());
        self.native = Some((Instant::now(), Task::spawn("dialog", ctx, wait)));
    }

    /// The path that was chosen or typed, once it is.
    pub fn poll(&mut self) -> Option<PathBuf> {
        let (since, task) = self.native.as_ref()?;
        let choice = match task.poll() {
            Ok(None) => return None,
            Ok(Some(choice)) => choice,
            Err(TaskPanicked) => None,
        };
        let was_quick = since.elapsed() < TOO_QUICK;
        self.native = None;
        if choice.is_none() && was_quick {
            self.field = Some(PathField {
                path: String::new(),
                why: if cfg!(target_os = "linux") {
                    "This system has no file dialog: install xdg-desktop-portal or zenity to get one. \
                     Until then type a path, or drop a file on the window."
                        .to_owned()
                } else {
                    "The system's file dialog couldn't be shown. Type a path, or drop a file on the window."
                        .to_owned()
                },
                is_new: true,
            });
        }
        choice
    }

    /// Closes the field for a typed path; whether it was there.
    pub fn dismiss(&mut self) -> bool {
        self.field.take().is_some()
    }

    /// The field for a typed path, if it is needed; the path once it is entered.
    pub fn field_ui(&mut self, ctx: &egui::Context) -> Option<PathBuf> {
        let field = self.field.as_mut()?;
        let mut is_open = true;
        let mut is_entered = false;
        egui::Window::new("Open a mesh")
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_width(360.0)
            .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .show(ctx, |ui| {
                ui.label(&field.why);
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    let label = ui.label("Path");
                    let edit = egui::TextEdit::singleline(&mut field.path)
                        .hint_text("/path/to/mesh.obj")
                        .desired_width(ui.available_width() - 60.0);
                    let edit = ui.add(edit).labelled_by(label.id);
                    if std::mem::take(&mut field.is_new) {
                        edit.request_focus();
                    }
                    let is_enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
                    is_entered = ui.button("Load").clicked() || (edit.lost_focus() && is_enter);
                });
            });
        let path = field.path.trim().to_owned();
        if is_entered && !path.is_empty() {
            self.field = None;
            return Some(PathBuf::from(path));
        }
        if !is_open {
            self.field = None;
        }
        None
    }
}

/// A file on its way to the screen.
pub struct Loading {
    /// The file.
    pub path: PathBuf,
    progress: Progress,
    task: Task<Result<Document, LoadError>>,
}

impl Loading {
    /// Starts the thread that loads.
    pub fn start(
        path: PathBuf,
        load_options: LoadOptions,
        settings: &Settings,
        ctx: &egui::Context,
    ) -> Self {
        let progress = Progress::default();
        let (kernel, shared, file) = (settings.kernel(), progress.clone(), path.clone());
        let options = settings.scene_options();
        let load = move || Document::load(&file, kernel, load_options, options, &shared);
        Self {
            path,
            progress,
            task: Task::spawn("load", ctx, load),
        }
    }

    /// The document or what is wrong with the file, once it is known.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked.
    pub fn poll(&self) -> Result<Option<Result<Document, LoadError>>, TaskPanicked> {
        self.task.poll()
    }

    /// Asks the thread to stop.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// Phase, bytes, and a button that cancels; whether it was pressed.
    #[must_use]
    pub fn progress_ui(&self, ui: &mut egui::Ui) -> bool {
        const MB: f64 = 1e6;
        let (read, total) = self.progress.bytes();
        let phase = self.progress.phase().label();
        let text = format!(
            "{phase}  {:.1} of {:.1} MB",
            read as f64 / MB,
            total as f64 / MB
        );
        // The bar moves although no event comes.
        ui.ctx().request_repaint_after(Duration::from_millis(50));
        let row = ui.horizontal(|ui| {
            let part = read as f32 / total.max(1) as f32;
            ui.add(egui::ProgressBar::new(part).desired_width(260.0).text(text));
            ui.button("Cancel").clicked()
        });
        row.inner
    }
}

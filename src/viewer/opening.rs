//! Opening files: the system's dialog, the path field, and the loading thread.

use crate::document::Document;
use crate::panels::progress::progress_ui;
use crate::settings::Settings;
use crate::task::{Task, TaskPanicked};
use hitscope_core::obj::{LoadError, LoadOptions, shown};
use hitscope_core::progress::Progress;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A dialog that ends without a file in less than this time was never shown.
const TOO_QUICK: Duration = Duration::from_millis(200);

/// The system's file dialog, or the path field that replaces it.
#[derive(Default)]
pub struct OpenDialog {
    native: Option<Task<Choice>>,
    /// Replaces the system's dialog.
    field: Option<PathField>,
}

/// The result of the system's dialog.
struct Choice {
    path: Option<PathBuf>,
    /// Whether the dialog may have been on the screen. rfd returns the same result for a cancelled dialog and for
    /// a missing one.
    was_shown: bool,
}

struct PathField {
    path: String,
    reason: &'static str,
    is_new: bool,
}

impl PathField {
    fn because(reason: &'static str) -> Self {
        Self {
            path: String::new(),
            reason,
            is_new: true,
        }
    }
}

impl OpenDialog {
    /// Shows the system's dialog, or the path field if the dialog is already open and perhaps hidden.
    pub fn open(&mut self, ctx: &egui::Context, frame: &eframe::Frame, folder: Option<&Path>) {
        if self.native.is_some() {
            self.field.get_or_insert_with(|| {
                PathField::because(
                    "The system's file dialog is open. You can also type a path here.",
                )
            });
            return;
        }
        let mut dialog = rfd::AsyncFileDialog::new()
            .set_title("Open a mesh")
            .add_filter(
                "Meshes and scenes",
                &["obj", "OBJ", "obj.gz", "gz", "xml", "XML"],
            )
            .add_filter("All files", &["*"])
            .set_parent(frame);
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        // Created on this thread, as macOS requires, and awaited on another.
        let choice = dialog.pick_file();
        let wait = move || {
            let start = Instant::now();
            let path = pollster::block_on(choice).map(|file| file.path().to_owned());
            Choice {
                path,
                was_shown: start.elapsed() >= TOO_QUICK && has_dialog(),
            }
        };
        self.native = Some(Task::spawn("dialog", ctx, wait));
    }

    /// Returns the path chosen in the system's dialog, once.
    pub fn poll(&mut self) -> Option<PathBuf> {
        let choice = match self.native.as_ref()?.poll() {
            Ok(None) => return None,
            Ok(Some(choice)) => choice,
            Err(TaskPanicked) => Choice {
                path: None,
                was_shown: false,
            },
        };
        self.native = None;
        if choice.path.is_some() {
            self.field = None;
        } else if !choice.was_shown {
            self.field = Some(PathField::because(if cfg!(target_os = "linux") {
                "This system has no file dialog; xdg-desktop-portal or zenity provides one. \
                 Type a path or drop a file on the window."
            } else {
                "The system's file dialog couldn't be shown. Type a path or drop a file on the window."
            }));
        }
        choice.path
    }

    /// Closes the path field. Returns whether it was open.
    pub fn dismiss(&mut self) -> bool {
        self.field.take().is_some()
    }

    /// Shows the path field if it is open. Returns the path once it is entered.
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
                ui.label(field.reason);
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

/// Whether rfd can show a file dialog on this system. Only Linux may lack one.
fn has_dialog() -> bool {
    !cfg!(target_os = "linux") || has_linux_dialog(&|name| std::env::var_os(name))
}

/// Whether there is a portal that the session bus can start, or zenity.
fn has_linux_dialog(variable: &dyn Fn(&str) -> Option<std::ffi::OsString>) -> bool {
    const PORTAL: &str = "dbus-1/services/org.freedesktop.portal.Desktop.service";
    let any_holds = |folders: &OsStr, file: &str| {
        std::env::split_paths(folders).any(|folder| folder.join(file).is_file())
    };
    let holds = |name: &str, default: &str, file: &str| {
        let folders = variable(name).filter(|folders| !folders.is_empty());
        any_holds(&folders.unwrap_or(default.into()), file)
    };
    // A sandboxed program uses the portal of the host system.
    let is_sandboxed = variable("SNAP").is_some() || Path::new("/.flatpak-info").exists();
    is_sandboxed
        || holds("PATH", "", "zenity")
        || holds("XDG_DATA_DIRS", "/usr/local/share:/usr/share", PORTAL)
        || holds("XDG_DATA_HOME", "", PORTAL)
}

/// A file that is being loaded.
pub struct Loading {
    /// The file.
    pub path: PathBuf,
    progress: Progress,
    task: Task<Result<Document, LoadError>>,
}

impl Loading {
    /// Starts the loading thread.
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

    /// The document or the load error, once loading has finished.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked.
    pub fn poll(&self) -> Result<Option<Result<Document, LoadError>>, TaskPanicked> {
        self.task.poll()
    }

    /// The file's name for messages.
    pub fn name(&self) -> String {
        shown(Path::new(self.path.file_name().unwrap_or_default()))
    }

    /// Signals the thread to stop.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// Shows the phase, the bytes read and a cancel button. Returns whether it was clicked.
    #[must_use]
    pub fn progress_ui(&self, ui: &mut egui::Ui) -> bool {
        let row = ui.horizontal(|ui| {
            progress_ui(ui, &self.progress);
            ui.button("Cancel").clicked()
        });
        row.inner
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    #[test]
    fn a_file_dialog_requires_zenity_or_a_portal() {
        let folder = tempfile::tempdir().expect("a folder");
        let has = |name: &'static str, value: &Path| {
            let value: OsString = value.into();
            // Independent of this machine's environment.
            let empty =
                |name: &str| matches!(name, "PATH" | "XDG_DATA_DIRS").then(|| "none".into());
            has_linux_dialog(&move |asked: &str| {
                if asked == name {
                    Some(value.clone())
                } else {
                    empty(asked)
                }
            })
        };
        let (bin, share) = (folder.path().join("bin"), folder.path().join("share"));
        for (name, path) in [
            ("PATH", &bin),
            ("XDG_DATA_DIRS", &share),
            ("XDG_DATA_HOME", &share),
        ] {
            assert!(!has(name, path), "{name}");
        }
        let services = share.join("dbus-1/services");
        std::fs::create_dir_all(&services).expect("made");
        std::fs::create_dir(&bin).expect("made");
        std::fs::write(bin.join("zenity"), "").expect("written");
        let portal = services.join("org.freedesktop.portal.Desktop.service");
        std::fs::write(portal, "").expect("written");
        for (name, path) in [
            ("PATH", &bin),
            ("XDG_DATA_DIRS", &share),
            ("XDG_DATA_HOME", &share),
        ] {
            assert!(has(name, path), "{name}");
        }
        assert!(has("SNAP", &bin));
    }
}

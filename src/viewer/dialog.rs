//! The system's dialogs for opening and saving files, and the path field that replaces them.

use crate::task::{Task, TaskPanicked};
use crate::text_field::{select_all, text_field};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::time::{Duration, Instant};

/// A dialog that ends without a file in less than this time was never shown.
const TOO_QUICK: Duration = Duration::from_millis(200);

/// The title, example and filters of a file dialog.
#[derive(Debug)]
pub struct DialogSpec {
    /// The title.
    pub title: &'static str,
    /// An example of a path.
    pub example: &'static str,
    /// Whether it chooses a file to write.
    pub is_saving: bool,
    /// Kinds of files, each with its extensions.
    pub filters: &'static [(&'static str, &'static [&'static str])],
}

/// The system's file dialog, or the path field that replaces it.
pub struct FileDialog {
    spec: &'static DialogSpec,
    /// The path that the user may want.
    suggested: Option<PathBuf>,
    native: Option<Task<Choice>>,
    /// Replaces the system's dialog.
    field: Option<PathField>,
    /// The path that was entered last.
    entered: Option<PathBuf>,
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
    fn because(reason: &'static str, suggested: Option<&Path>) -> Self {
        Self {
            path: suggested.map_or_else(String::new, |path| path.to_string_lossy().into_owned()),
            reason,
            is_new: true,
        }
    }
}

impl FileDialog {
    /// A dialog that isn't shown yet.
    pub fn new(spec: &'static DialogSpec) -> Self {
        Self {
            spec,
            suggested: None,
            native: None,
            field: None,
            entered: None,
        }
    }

    /// The initial path of the path field: one that was entered for saving but wasn't written, the suggested path, or else
    /// the last one entered.
    fn first_path(&self) -> Option<PathBuf> {
        let unwritten = self
            .entered
            .as_ref()
            .filter(|path| self.spec.is_saving && !path.exists());
        unwritten
            .or(self.suggested.as_ref())
            .or(self.entered.as_ref())
            .cloned()
    }

    /// Shows the system's dialog, or the path field if the dialog is already open and perhaps hidden. The dialog starts
    /// in the folder of the suggested path; one for saving also suggests its name.
    pub fn open(&mut self, ctx: &egui::Context, frame: &eframe::Frame, suggested: Option<&Path>) {
        let is_saving = self.spec.is_saving;
        self.suggested = suggested.filter(|_| is_saving).map(Path::to_owned);
        if self.native.is_some() {
            let first = self.first_path();
            self.field.get_or_insert_with(|| {
                let reason = "The system's file dialog is open. You can also type a path here.";
                PathField::because(reason, first.as_deref())
            });
            return;
        }
        let mut dialog = rfd::AsyncFileDialog::new()
            .set_title(self.spec.title)
            .set_parent(frame);
        for (name, extensions) in self.spec.filters {
            dialog = dialog.add_filter(*name, extensions);
        }
        if let Some(folder) = suggested.and_then(Path::parent) {
            dialog = dialog.set_directory(folder);
        }
        if let Some(name) = self.suggested.as_deref().and_then(Path::file_name) {
            dialog = dialog.set_file_name(name.to_string_lossy());
        }
        // Created on this thread, as macOS requires, and awaited on another.
        type Chosen = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;
        let choice: Chosen = if is_saving {
            Box::pin(dialog.save_file())
        } else {
            Box::pin(dialog.pick_file())
        };
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
            let reason = if cfg!(target_os = "linux") {
                "This system has no file dialog; xdg-desktop-portal or zenity provides one. Type a path."
            } else {
                "The system's file dialog couldn't be shown. Type a path."
            };
            self.field = Some(PathField::because(reason, self.first_path().as_deref()));
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
        let spec = self.spec;
        egui::Window::new(spec.title)
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
                    let edit = text_field(&mut field.path)
                        .hint_text(spec.example)
                        .desired_width((ui.available_width() - 80.0).max(1.0));
                    let edit = ui.add(edit).labelled_by(label.id);
                    if std::mem::take(&mut field.is_new) {
                        edit.request_focus();
                        select_all(ui.ctx(), edit.id, &field.path);
                    }
                    let is_enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
                    // A file is replaced only by a click on a button that says so.
                    let replaces = spec.is_saving && Path::new(field.path.trim()).exists();
                    let button = match (spec.is_saving, replaces) {
                        (false, _) => "Load",
                        (true, true) => "Replace",
                        (true, false) => "Save",
                    };
                    let is_confirmed = edit.lost_focus() && is_enter && !replaces;
                    is_entered = ui.button(button).clicked() || is_confirmed;
                });
            });
        let path = field.path.trim().to_owned();
        if is_entered && !path.is_empty() {
            self.field = None;
            self.entered = Some(PathBuf::from(&path));
            return self.entered.clone();
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

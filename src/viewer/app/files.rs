//! Loading files, showing the result, reloading changed files, finding the files beside them, and saving scene files.

use super::App;
use crate::about::NAME;
use crate::document::Document;
use crate::folder::{self, Direction};
use crate::log::Kind;
use crate::opening::Loading;
use crate::saving::Saving;
use crate::session::is_session;
use crate::task::{Task, TaskPanicked};
use crate::watch::Watch;
use hitscope_core::obj::{LoadError, shown};
use hitscope_lab::commands::print_warnings;
use std::io;
use std::path::{Path, PathBuf};

/// The search for the next or the previous file of the folder.
#[derive(Default)]
pub(crate) struct Neighbours {
    search: Option<Task<io::Result<Option<PathBuf>>>>,
    /// The file that was found last, unless a file was opened since.
    last: Option<PathBuf>,
}

impl App {
    /// Loads the open file again.
    pub(crate) fn reload(&mut self, ctx: &egui::Context) {
        if let Some(path) = self.open.document.path.clone() {
            self.load(path, ctx);
        }
    }

    /// Opens the next or the previous file of the folder, once it is found. The search begins at the file that was
    /// found last, so that one that can't be loaded is left behind.
    pub(crate) fn open_neighbour(&mut self, direction: Direction, ctx: &egui::Context) {
        let last = self.open.neighbours.last.as_ref();
        let Some(file) = last.or(self.open.document.path.as_ref()).cloned() else {
            return;
        };
        let search = move || folder::neighbour(&file, direction);
        self.open.neighbours.search = Some(Task::spawn("neighbour", ctx, search));
    }

    pub(super) fn poll_neighbours(&mut self, ctx: &egui::Context) {
        let result = match self.open.neighbours.search.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(result))) => result.map_err(|error| format!("the folder: {error}")),
            Some(Err(broken @ TaskPanicked)) => Err(broken.to_string()),
        };
        self.open.neighbours.search = None;
        match result {
            Ok(Some(path)) => {
                self.open.neighbours.last = Some(path.clone());
                self.load(path, ctx);
            }
            Ok(None) => self.refuse("The folder has no other mesh or scene file"),
            Err(error) => self.error(error),
        }
    }

    /// Loads a file, or opens a session. The open file stays until it is loaded.
    pub(crate) fn load(&mut self, path: PathBuf, ctx: &egui::Context) {
        self.cancel_loading();
        self.feedback.notice = None;
        if is_session(&path) {
            self.read_session(path, ctx);
            return;
        }
        self.open.loading = Some(Loading::start(
            path,
            self.open.load_options,
            self.seen.settings.kernel(),
            self.preferences.scene_options(),
            self.seen.settings.offset(),
            ctx,
        ));
    }

    /// Applies the offset of the settings to the scene: loads the open file again, or creates the built-in scene again.
    pub(super) fn use_offset(&mut self, ctx: &egui::Context) {
        let wanted = self.seen.settings.offset();
        let document = &self.open.document;
        let is_busy = self.open.loading.is_some() || ctx.egui_is_using_pointer();
        if document.offset == wanted || document.is_blank || is_busy {
            return;
        }
        match document.path.clone() {
            Some(path) => self.load(path, ctx),
            None => {
                let mut document = Document::embedded(self.seen.settings.kernel());
                document.move_by(wanted);
                self.show(document, ctx);
            }
        }
    }

    /// Cancels loading without waiting for its thread.
    pub(super) fn cancel_loading(&mut self) {
        (self.open.session, self.open.loading_session) = (None, None);
        if let Some(loading) = self.open.loading.take() {
            loading.cancel();
        }
    }

    /// Shows a document that has been loaded. If the file can't be loaded, the old document stays.
    pub(super) fn poll_loading(&mut self, ctx: &egui::Context) {
        let Some(loading) = &self.open.loading else {
            return;
        };
        let result = match loading.poll() {
            Ok(None) => return,
            // Cancelled by the user.
            Ok(Some(Err(LoadError::Cancelled { .. }))) => {
                (self.open.loading, self.open.loading_session) = (None, None);
                self.open.document.offset = self.seen.settings.offset();
                return;
            }
            Ok(Some(result)) => result.map_err(|error| error.to_string()),
            Err(broken) => Err(format!("{}: {broken}", loading.path.display())),
        };
        let path = loading.path.clone();
        self.open.loading = None;
        let session = self.open.loading_session.take();
        match result {
            Ok(document) => {
                self.show(document, ctx);
                if let Some(session) = session {
                    self.use_session(&session, ctx);
                }
            }
            Err(mut message) => {
                // Loading isn't tried again until the settings change.
                self.open.document.offset = self.seen.settings.offset();
                if !path.exists() && self.preferences.recent.remove(&path) {
                    message += " (it is no longer listed under Open recent)";
                }
                if session.is_some() {
                    let session = shown(&self.open.session_path);
                    message += &format!(
                        ". The session {session} needs this file: put it back, or write its new place to “file” in the session"
                    );
                }
                if let Some(screenshot) = &mut self.screenshot {
                    screenshot.fail(ctx, message.clone());
                }
                self.error(message);
            }
        }
    }

    pub(super) fn show(&mut self, document: Document, ctx: &egui::Context) {
        let is_same_file = self.open.document.path == document.path;
        let shift = self.open.document.origin() - document.origin();
        let old = std::mem::replace(&mut self.open.document, document);
        if let Some(closed) = self.compared.keep_earlier(old, is_same_file) {
            self.open.retired.add(closed);
        }
        if let Some(path) = &self.open.document.path {
            self.preferences.recent.add(path);
        }
        self.open.neighbours.last = None;
        self.open.watch = None;
        self.forget_shown_part(is_same_file);
        self.prepare(ctx);
        self.open.document.improve(ctx);
        if is_same_file {
            self.history.absorb();
        } else {
            self.history.clear();
        }
        self.picked.face_lookup = None;
        self.picked.forget_flaw();
        self.open.trade = None;
        if is_same_file {
            self.seen
                .turntable
                .set_scene(self.open.document.loaded.scene.bounds_with_elements());
            // Keep the camera's place in the file's coordinates.
            self.seen.turntable.pivot += shift;
            self.picked.clicks.shift(shift);
            self.picked.inspecting.picks.shift(shift);
            self.pick_again(shift, ctx);
        } else {
            self.picked.clear_pick();
            self.picked.inspecting.picks.clear();
            self.use_first_view();
        }
        // The next frame drops the old scene's picture without waiting for the first rays in the new scene.
        ctx.request_repaint();
        self.show_title(ctx);
        let warnings = &self.open.document.loaded.report.warnings;
        if let (true, Some(path)) = (self.screenshot.is_some(), &self.open.document.path) {
            print_warnings(path, &self.open.document.loaded);
        }
        if let Some(first) = warnings.first() {
            let more = match warnings.len() - 1 {
                0 => String::new(),
                n => format!(" (and {n} more; see the Mesh tab)"),
            };
            let text = format!("{}: {first}{more}", self.open.document.name());
            self.warn(&text);
        }
        self.note_warnings();
        if self.open.document.ignores_offset {
            self.tell("Only the coordinates of triangle meshes can be moved by an offset");
        }
    }

    /// Shows the file's name in the window's title; the program's name alone if no file is open.
    pub(super) fn show_title(&self, ctx: &egui::Context) {
        let title = match self.open.document.path {
            Some(_) => format!("{} – {NAME}", self.open.document.name()),
            None => NAME.to_owned(),
        };
        ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
    }

    /// Adds the document's warnings to the log, except the first one, which is shown as a notice.
    fn note_warnings(&mut self) {
        /// Limit on the number of warnings; the Mesh tab lists all.
        const MOST: usize = 100;
        let document = &self.open.document;
        let (name, warnings) = (document.name(), &document.loaded.report.warnings);
        let others = warnings.iter().skip(1).take(MOST);
        let texts: Vec<String> = others.map(|warning| format!("{name}: {warning}")).collect();
        for text in texts {
            self.note(Kind::Warning, &text);
        }
    }

    /// Writes what is open, with the current camera, to a scene file.
    pub(super) fn save_as(&mut self, path: &Path, ctx: &egui::Context) {
        let camera = self.seen.turntable.camera(self.shown.resolution);
        match Saving::start(&self.open.document, &camera, path, ctx) {
            Ok(saving) => self.open.saving = Some(saving),
            Err(error) => self.error(error),
        }
    }

    /// Shows a message once a file is saved.
    pub(super) fn poll_saving(&mut self) {
        let Some(result) = self.open.saving.as_ref().and_then(Saving::poll) else {
            return;
        };
        let result = result.map(shown);
        self.open.saving = None;
        match result {
            Ok(path) => self.tell(format!("Saved {path}")),
            Err(error) => self.error(error),
        }
    }

    /// Reloads the file if it has changed and auto-reload is on.
    pub(super) fn poll_watch(&mut self, ctx: &egui::Context) {
        let Some(path) = self
            .open
            .document
            .path
            .clone()
            .filter(|_| self.preferences.watches)
        else {
            self.open.watch = None;
            return;
        };
        if self.open.watch.is_none() {
            let named = &self.open.document.loaded.report.files;
            match Watch::of(&path, named, self.open.document.began, ctx) {
                Ok(watch) => self.open.watch = Some(watch),
                Err(error) => {
                    self.preferences.watches = false;
                    self.error(format!("{} can't be watched: {error}", path.display()));
                    return;
                }
            }
        }
        if self.open.watch.as_ref().is_some_and(Watch::poll) {
            self.load(path, ctx);
        }
    }
}

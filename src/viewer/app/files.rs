//! Loading files, showing the result, reloading changed files, and saving scene files.

use super::{App, Notice, NoticeKind};
use crate::document::Document;
use crate::opening::Loading;
use crate::saving::Saving;
use crate::watch::Watch;
use hitscope_core::obj::{LoadError, shown};
use hitscope_lab::commands::print_warnings;
use std::path::{Path, PathBuf};

impl App {
    pub(super) fn load(&mut self, path: PathBuf, ctx: &egui::Context) {
        self.cancel_loading();
        self.notice = None;
        self.loading = Some(Loading::start(path, self.load_options, &self.settings, ctx));
    }

    /// Cancels loading without waiting for its thread.
    pub(super) fn cancel_loading(&mut self) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
    }

    /// Shows a document that has been loaded. If the file can't be loaded, the old document stays.
    pub(super) fn poll_loading(&mut self, ctx: &egui::Context) {
        if let Some(path) = self.open_dialog.poll() {
            self.load(path, ctx);
        }
        if let Some(path) = self.environment_dialog.poll() {
            self.set_environment(&path);
        }
        let Some(loading) = &self.loading else { return };
        let result = match loading.poll() {
            Ok(None) => return,
            // Cancelled by the user.
            Ok(Some(Err(LoadError::Cancelled { .. }))) => {
                self.loading = None;
                return;
            }
            Ok(Some(result)) => result.map_err(|error| error.to_string()),
            Err(broken) => Err(format!("{}: {broken}", loading.path.display())),
        };
        self.loading = None;
        match result {
            Ok(document) => self.show(document, ctx),
            Err(message) => {
                if let Some(screenshot) = &self.screenshot {
                    screenshot.fail(ctx, message.clone());
                }
                self.error(message);
            }
        }
    }

    fn show(&mut self, document: Document, ctx: &egui::Context) {
        let is_same_file = self.document.path == document.path;
        let origin = |document: &Document| document.loaded.scene.mesh().origin();
        let shift = origin(&self.document) - origin(&document);
        self.document = document;
        self.watch = None;
        self.document.use_crease(self.settings.crease());
        let pick = self.pick.take();
        (self.picking, self.face_lookup, self.flaw) = (None, None, None);
        self.clicks.pending = None;
        self.trade = None;
        if is_same_file {
            self.turntable
                .set_scene(self.document.loaded.scene.bounds_with_elements());
            // Keep the camera's place in the file's coordinates.
            self.turntable.pivot += shift;
            if let Some(mut pick) = pick {
                pick.camera = pick.camera.moved(shift);
                self.inspect_again(&pick, ctx);
            }
        } else {
            self.use_first_view();
        }
        // The next frame drops the old scene's picture without waiting for the first rays in the new scene.
        ctx.request_repaint();
        let title = format!("{} – hitscope", self.document.name());
        ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
        let warnings = &self.document.loaded.report.warnings;
        if let (true, Some(path)) = (self.screenshot.is_some(), &self.document.path) {
            print_warnings(path, &self.document.loaded);
        }
        if let Some(first) = warnings.first() {
            let more = match warnings.len() - 1 {
                0 => String::new(),
                n => format!(" (and {n} more; see the Mesh tab)"),
            };
            self.notice = Some(Notice {
                text: format!("{}: {first}{more}", self.document.name()),
                kind: NoticeKind::Warning,
            });
        }
    }

    /// Writes what is open, with the current camera, to a scene file.
    pub(super) fn save_as(&mut self, path: &Path, ctx: &egui::Context) {
        let camera = self.turntable.camera(self.resolution);
        match Saving::start(&self.document, &camera, path, ctx) {
            Ok(saving) => self.saving = Some(saving),
            Err(error) => self.error(error),
        }
    }

    /// Starts to save to the chosen path, and tells when it is done.
    pub(super) fn poll_saving(&mut self, ctx: &egui::Context) {
        if let Some(path) = self.save_dialog.poll() {
            self.save_as(&path, ctx);
        }
        let Some(result) = self.saving.as_ref().and_then(Saving::poll) else {
            return;
        };
        let result = result.map(shown);
        self.saving = None;
        match result {
            Ok(text) => {
                let kind = NoticeKind::Saved;
                self.notice = Some(Notice { text, kind });
            }
            Err(error) => self.error(error),
        }
    }

    /// Reloads the file if it has changed and auto-reload is on.
    pub(super) fn poll_watch(&mut self, ctx: &egui::Context) {
        let Some(path) = self.document.path.clone().filter(|_| self.settings.watches) else {
            self.watch = None;
            return;
        };
        if self.watch.is_none() {
            let named = &self.document.loaded.report.files;
            match Watch::of(&path, named, self.document.began, ctx) {
                Ok(watch) => self.watch = Some(watch),
                Err(error) => {
                    self.settings.watches = false;
                    self.error(format!("{} can't be watched: {error}", path.display()));
                    return;
                }
            }
        }
        if self.watch.as_ref().is_some_and(Watch::poll) {
            self.load(path, ctx);
        }
    }
}

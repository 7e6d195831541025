//! Loading files, showing the result, and reloading changed files.

use super::{App, Notice};
use crate::document::Document;
use crate::opening::Loading;
use crate::watch::Watch;
use hitscope_core::camera::Turntable;
use hitscope_core::obj::LoadError;
use hitscope_lab::commands::print_warnings;
use std::path::PathBuf;

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
            self.use_default_view();
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
                is_error: false,
            });
        }
    }

    /// Looks at the scene from the default direction. Keeps the settings that don't depend on the mesh: up
    /// axis, projection and field of view.
    pub(super) fn use_default_view(&mut self) {
        let bounds = self.document.loaded.scene.bounds_with_elements();
        let mut turntable = Turntable::framing(bounds, self.resolution);
        turntable.fov_y_radians = self.turntable.fov_y_radians;
        turntable.is_orthographic = self.turntable.is_orthographic;
        turntable.up_axis = self.turntable.up_axis;
        self.turntable = turntable;
        self.is_unframed = true;
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

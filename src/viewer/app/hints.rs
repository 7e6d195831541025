//! The message in the middle of an empty picture: loading progress, how to open a file, or how to frame the
//! mesh.

use super::App;
use crate::command::{Commands, keys::keys_of};
use std::sync::Arc;

impl App {
    /// Whether the picture shows nothing of the mesh.
    pub fn shows_nothing(&self) -> bool {
        self.shown.shows_nothing
    }

    /// Updates `shows_nothing`. While the camera moves, the previous value stays until it is known to be wrong.
    pub(super) fn check_view(&mut self) {
        let Some(posted) = self.traced.tracer.posted() else {
            return;
        };
        let scene = &posted.context.scene;
        let is_shown = Arc::ptr_eq(scene, &self.open.document.loaded.scene);
        // Lines and points are drawn by the overlay; rays don't hit them.
        if self.open.document.is_blank || !is_shown || scene.mesh().has_lines_or_points() {
            self.shown.shows_nothing = false;
        } else if let Some(shows_surface) = self.traced.tracer.shows_surface() {
            self.shown.shows_nothing = !shows_surface;
        }
    }

    pub(super) fn hints_ui(&mut self, ctx: &egui::Context, commands: &Commands) {
        let is_loading = self.open.document.is_blank && self.open.loading.is_some();
        if !self.open.document.is_blank && !self.shows_nothing() {
            return;
        }
        let mut is_cancelled = false;
        egui::Area::new(egui::Id::unique("hint"))
            .pivot(egui::Align2::CENTER_CENTER)
            .fixed_pos(self.shown.canvas_rect.center())
            .show(ctx, |ui| {
                ui.set_max_width((self.shown.canvas_rect.width() - 40.0).clamp(120.0, 420.0));
                egui::Frame::popup(ui.style()).show(ui, |ui| match &self.open.loading {
                    Some(loading) if is_loading => {
                        ui.label(format!("Loading {}", loading.name()));
                        is_cancelled = loading.progress_ui(ui);
                    }
                    _ if self.open.document.is_blank => {
                        let key = keys_of("open", ctx);
                        ui.label(format!("No file is open. Drop a file here or press {key}."));
                    }
                    _ => {
                        let has_others = self.open.document.loaded.scene.has_other_shapes();
                        ui.label(if has_others {
                            "No surface is visible."
                        } else {
                            "The mesh isn't visible."
                        });
                        commands.button_ui(ui, "frame");
                        if commands.named("show-everything").is_enabled() {
                            commands.button_ui(ui, "show-everything");
                        }
                    }
                });
            });
        if is_cancelled {
            self.cancel_loading();
        }
    }
}

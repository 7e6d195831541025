//! The message in the middle of an empty picture: loading progress, how to open a file, or how to frame the
//! mesh.

use super::App;
use crate::bindings::Action;
use glam::UVec2;
use hitscope_core::Film;
use hitscope_core::render::plan::Plan;
use std::path::Path;
use std::sync::Arc;

impl App {
    /// Whether the picture shows nothing of the mesh.
    pub fn shows_nothing(&self) -> bool {
        self.shows_nothing
    }

    /// Updates `shows_nothing`: a pixel that shows the mesh clears it at once; it is set only when every pixel has
    /// its own ray. Until then, as while the camera moves, the previous value stays.
    pub(super) fn check_view(&mut self) {
        let (film, Some(posted)) = (self.tracer.film(), self.tracer.posted()) else {
            return;
        };
        let context = &posted.context;
        // Lines and points are drawn by the overlay; the film doesn't contain them.
        let is_shown = Arc::ptr_eq(&context.scene, &self.document.loaded.scene);
        if self.document.is_blank || !is_shown || context.scene.mesh().has_elements() {
            self.shows_nothing = false;
            return;
        }
        let background = Film::new(Plan::new(UVec2::ONE, 1, 1), context.background);
        let (above, below) = film.pixels().split_at(film.pixels().len() / 2);
        // Starts in the middle, where a mesh is found soonest.
        let mut pixels = below.iter().chain(above);
        if pixels.any(|pixel| *pixel != background.pixels()[0]) {
            self.shows_nothing = false;
        } else if film.samples() > 0 {
            self.shows_nothing = true;
        }
    }

    pub(super) fn hints_ui(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        let is_loading = self.document.is_blank && self.loading.is_some();
        if !self.document.is_blank && !self.shows_nothing() {
            return;
        }
        let mut is_cancelled = false;
        egui::Area::new(egui::Id::unique("hint"))
            .pivot(egui::Align2::CENTER_CENTER)
            .fixed_pos(self.canvas_rect.center())
            .show(ctx, |ui| {
                ui.set_max_width((self.canvas_rect.width() - 40.0).clamp(120.0, 420.0));
                egui::Frame::popup(ui.style()).show(ui, |ui| match &self.loading {
                    Some(loading) if is_loading => {
                        let name = loading.path.file_name().unwrap_or_default();
                        ui.label(format!("Loading {}", Path::new(name).display()));
                        is_cancelled = loading.progress_ui(ui);
                    }
                    _ if self.document.is_blank => {
                        ui.label("No file is open. Drop a file here or press Ctrl+O.");
                    }
                    _ => {
                        ui.label("The mesh isn't visible.");
                        if ui.button("Frame the mesh (Home)").clicked() {
                            actions.push(Action::Frame);
                        }
                    }
                });
            });
        if is_cancelled {
            self.cancel_loading();
        }
    }
}

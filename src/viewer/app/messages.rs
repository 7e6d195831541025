//! The windows over the picture: path fields, messages and help.

use super::light::is_environment;
use super::{App, NoticeKind};
use crate::bindings::{Action, KEYS, POINTER, SYSTEM};
use egui::{Align, Layout, RichText};

impl App {
    /// Shows the windows over the picture.
    pub(super) fn windows_ui(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if let Some(path) = self.open_dialog.field_ui(ctx) {
            self.load(path, ctx);
        }
        if let Some(path) = self.save_dialog.field_ui(ctx) {
            self.save_as(&path, ctx);
        }
        if let Some(path) = self.environment_dialog.field_ui(ctx) {
            self.set_environment(&path);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.first().cloned());
        if let Some(file) = dropped {
            let path = file.path();
            if is_environment(path) {
                self.set_environment(path);
            } else {
                self.load(path.to_owned(), ctx);
            }
        }
        self.drop_hint_ui(ctx);
        self.notices_ui(ctx);
        self.help_ui(ctx, actions);
    }

    fn drop_hint_ui(&self, ctx: &egui::Context) {
        if ctx.input(|input| input.raw.hovered_files.is_empty()) {
            return;
        }
        egui::Area::new(egui::Id::unique("drop"))
            .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| ui.heading("Drop to open"));
            });
    }

    /// Shows the loading progress and the notice.
    fn notices_ui(&mut self, ctx: &egui::Context) {
        // Without an open document, `hints_ui` shows the progress.
        let loading = self.loading.as_ref().filter(|_| !self.document.is_blank);
        if loading.is_none() && self.notice.is_none() {
            return;
        }
        let (mut is_closed, mut is_cancelled) = (false, false);
        egui::Area::new(egui::Id::unique("notices"))
            .fixed_pos(self.canvas_rect.min + egui::vec2(10.0, 10.0))
            .show(ctx, |ui| {
                // Don't overlap the side panel.
                ui.set_max_width((self.canvas_rect.width() - 40.0).clamp(80.0, 560.0));
                if let Some(loading) = loading {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.label(format!("Loading {}", loading.name()));
                        is_cancelled = loading.progress_ui(ui);
                    });
                }
                if let Some(notice) = &self.notice {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        let visuals = ui.visuals();
                        let (title, colour) = match notice.kind {
                            NoticeKind::Error => ("Error", visuals.error_fg_color),
                            NoticeKind::Warning => ("Warning", visuals.warn_fg_color),
                            NoticeKind::Saved => ("Saved", visuals.strong_text_color()),
                        };
                        ui.horizontal(|ui| {
                            ui.label(RichText::new(title).color(colour).strong());
                            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                                is_closed = ui.small_button("Close").clicked();
                            });
                        });
                        ui.label(&notice.text);
                    });
                }
            });
        if is_closed {
            self.notice = None;
        }
        if is_cancelled {
            self.cancel_loading();
        }
    }

    fn help_ui(&self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if !self.shows_help {
            return;
        }
        let response = egui::Modal::new(egui::Id::unique("help")).show(ctx, |ui| {
            ui.heading("Keyboard and mouse");
            ui.add_space(4.0);
            let size = ui.ctx().content_rect().size() - egui::vec2(60.0, 120.0);
            let height = size.y;
            egui::ScrollArea::both()
                .max_width(size.x)
                .max_height(height)
                .min_scrolled_height(height)
                .show(ui, |ui| {
                    let row = |ui: &mut egui::Ui, keys: &str, about: &str| {
                        ui.label(RichText::new(keys).strong());
                        ui.label(about);
                        ui.end_row();
                    };
                    egui::Grid::new("keys")
                        .num_columns(2)
                        .spacing([16.0, 3.0])
                        .show(ui, |ui| {
                            for (pointer, about) in POINTER {
                                row(ui, pointer, about);
                            }
                            for binding in KEYS {
                                row(ui, &binding.key_text(ctx), binding.about);
                            }
                            for (keys, about) in SYSTEM {
                                row(ui, keys, about);
                            }
                        });
                });
            ui.add_space(6.0);
            ui.button("Close").clicked()
        });
        if response.inner || response.backdrop_response.clicked() {
            actions.push(Action::ToggleHelp);
        }
    }
}

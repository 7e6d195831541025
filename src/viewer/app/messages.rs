//! What is shown over the picture: path fields, messages, sheets and the command palette.

use super::App;
use super::environment::is_environment;
use super::feedback::NoticeKind;
use super::work::work_ui;
use crate::command::{Commands, help_sheet};
use crate::log::LogAction;
use egui::{Align, Layout, RichText};
use hitscope_core::picture::PictureFile;

/// A sheet over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sheet {
    /// All keys, and the uses of the mouse.
    Help,
    /// The version, and facts about the machine.
    About,
    /// All messages since the start.
    Log,
}

impl App {
    /// Shows a sheet, or closes it if it is shown.
    pub(crate) fn toggle_sheet(&mut self, sheet: Sheet) {
        self.shown.sheet = (self.shown.sheet != Some(sheet)).then_some(sheet);
    }

    /// Closes the topmost window or message, cancels loading, ends magnification, clears the marked flaw, or clears the
    /// pick: the first of these that applies.
    pub(crate) fn dismiss(&mut self) {
        let is_box_closed = self.shown.palette.dismiss() || self.picked.inspecting.go_to.dismiss();
        if is_box_closed || self.shown.sheet.take().is_some() {
            return;
        }
        if let Some(loading) = &self.open.loading {
            loading.cancel();
            return;
        }
        let is_closed = self.open.dialogs.dismiss()
            || self.pictures.dialog.dismiss()
            || self.feedback.notice.take().is_some()
            || self.shown.magnifier.leave();
        if !is_closed && self.picked.flaw.take().is_none() {
            self.picked.clear_pick();
            self.picked.inspecting.picks.clear_unpinned();
        }
    }

    /// Shows what is over the picture.
    pub(super) fn windows_ui(&mut self, ctx: &egui::Context, commands: &Commands) {
        self.path_fields_ui(ctx);
        self.go_to_ui(ctx);
        let dropped = ctx.input(|input| input.raw.dropped_files.first().cloned());
        if let Some(file) = dropped {
            let path = file.path();
            if is_environment(path) {
                self.open_environment(path, ctx);
            } else if PictureFile::is_name_of_one(path) {
                self.compare_with_picture(path.to_owned());
            } else {
                self.load(path.to_owned(), ctx);
            }
        }
        self.drop_hint_ui(ctx);
        self.check_notice();
        self.notices_ui(ctx);
        self.feedback.toasts.toasts_ui(ctx, self.shown.canvas_rect);
        self.sheet_ui(ctx);
        self.shown.palette.palette_ui(ctx, commands);
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

    /// Shows the loading progress, long-running work and the notice.
    fn notices_ui(&mut self, ctx: &egui::Context) {
        // Without an open document, `hints_ui` shows the progress.
        let loading = self
            .open
            .loading
            .as_ref()
            .filter(|_| !self.open.document.is_blank);
        let running = self.long_work(ctx);
        if loading.is_none() && self.feedback.notice.is_none() && running.is_empty() {
            return;
        }
        let (mut is_closed, mut is_cancelled, mut cancelled) = (false, false, None);
        egui::Area::new(egui::Id::unique("notices"))
            .fixed_pos(self.shown.canvas_rect.min + egui::vec2(10.0, 10.0))
            .show(ctx, |ui| {
                // Don't overlap the side panel.
                ui.set_max_width((self.shown.canvas_rect.width() - 40.0).clamp(80.0, 560.0));
                if let Some(loading) = loading {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.label(format!("Loading {}", loading.name()));
                        is_cancelled = loading.progress_ui(ui);
                    });
                }
                cancelled = work_ui(ui, &running);
                if let Some(notice) = &self.feedback.notice {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        let visuals = ui.visuals();
                        let (title, colour) = match notice.kind {
                            NoticeKind::Error => ("Error", visuals.error_fg_color),
                            NoticeKind::Warning => ("Warning", visuals.warn_fg_color),
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
            self.feedback.notice = None;
        }
        if is_cancelled {
            self.cancel_loading();
        }
        if let Some(work) = cancelled {
            self.cancel_work(work);
        }
    }

    /// Shows the log. Returns whether the user closes it or follows a link.
    fn log_ui(&mut self, ctx: &egui::Context) -> bool {
        let document = self.open.document.path.as_deref();
        match self.feedback.log.log_ui(ctx, document) {
            None => return false,
            Some(LogAction::Close) => (),
            Some(LogAction::Follow(target)) => self.follow(target, ctx),
        }
        true
    }

    fn sheet_ui(&mut self, ctx: &egui::Context) {
        let is_closed = match self.shown.sheet {
            None => return,
            Some(Sheet::Help) => help_sheet::help_ui(ctx, &self.preferences.navigation),
            Some(Sheet::Log) => self.log_ui(ctx),
            Some(Sheet::About) => self.shown.about.about_ui(ctx),
        };
        if is_closed {
            self.shown.sheet = None;
        }
    }
}

//! The help sheet: all keys, and the uses of the mouse.

use super::keys::key_text;
use super::{Menu, all};
use crate::bindings::NavigationSettings;
use egui::{Grid, Modal, RichText, ScrollArea, vec2};

/// The greatest width of the sheet in points; long texts wrap.
const WIDEST: f32 = 820.0;

/// Shows the sheet over the window. Returns whether the user closes it.
pub fn help_ui(ctx: &egui::Context, navigation: &NavigationSettings) -> bool {
    let response = Modal::new(egui::Id::unique("help")).show(ctx, |ui| {
        ui.heading("Keyboard and mouse");
        ui.add_space(4.0);
        let size = ui.ctx().content_rect().size() - vec2(60.0, 120.0);
        ui.set_width(size.x.clamp(1.0, WIDEST));
        ScrollArea::vertical()
            .auto_shrink([false, true])
            .max_height(size.y)
            .min_scrolled_height(size.y)
            .show(ui, |ui| {
                mouse_ui(ui, navigation);
                keys_ui(ui);
            });
        ui.add_space(6.0);
        ui.button("Close").clicked()
    });
    response.inner || response.backdrop_response.clicked()
}

/// A table in which long texts wrap: no column is wider than `part` of the available width.
fn grid(ui: &egui::Ui, id: &str, columns: usize, part: f32) -> Grid {
    Grid::new(id)
        .num_columns(columns)
        .spacing([16.0, 3.0])
        .max_col_width(part * ui.available_width())
}

fn mouse_ui(ui: &mut egui::Ui, navigation: &NavigationSettings) {
    grid(ui, "mouse", 2, 0.6).show(ui, |ui| {
        heading_ui(ui, "Mouse");
        for (pointer, about) in navigation.help() {
            ui.label(RichText::new(pointer).strong());
            ui.label(about);
            ui.end_row();
        }
    });
}

fn keys_ui(ui: &mut egui::Ui) {
    grid(ui, "keys", 3, 0.5).show(ui, |ui| {
        for menu in Menu::ALL {
            heading_ui(ui, menu.title());
            let of_menu = all().filter(|command| command.place.menu == menu);
            for command in of_menu.filter(|command| !command.keys.is_empty()) {
                let keys = key_text(command.keys, ui.ctx());
                ui.label(RichText::new(keys).strong());
                ui.label(command.title);
                ui.label(RichText::new(command.tooltip).weak());
                ui.end_row();
            }
        }
    });
}

fn heading_ui(ui: &mut egui::Ui, title: &str) {
    ui.label(RichText::new(title).weak());
    ui.end_row();
}

//! The help sheet: all keys, and the uses of the mouse.

use super::keys::key_text;
use super::{Menu, all};
use egui::{Grid, Modal, RichText, ScrollArea, vec2};

/// Pointer bindings in the picture.
pub static POINTER: &[(&str, &str)] = &[
    ("Drag", "Orbit"),
    ("Shift+drag, middle drag or right drag", "Pan"),
    (
        "Ctrl+drag",
        "Rotate the environment, if it is a picture and the view shows its light",
    ),
    ("Scroll or pinch", "Zoom to the cursor"),
    ("Click", "Inspect the pixel"),
    ("Ctrl+click", "Inspect the pixel and keep the other picks"),
    ("Double-click", "Set the pivot"),
    (
        "Drop a file",
        "Open it, or light the scene by a picture in HDR or EXR",
    ),
];

/// Shows the sheet over the window. Returns whether the user closes it.
pub fn help_ui(ctx: &egui::Context) -> bool {
    let response = Modal::new(egui::Id::unique("help")).show(ctx, |ui| {
        ui.heading("Keyboard and mouse");
        ui.add_space(4.0);
        let size = ui.ctx().content_rect().size() - vec2(60.0, 120.0);
        ScrollArea::both()
            .max_width(size.x)
            .max_height(size.y)
            .min_scrolled_height(size.y)
            .show(ui, rows_ui);
        ui.add_space(6.0);
        ui.button("Close").clicked()
    });
    response.inner || response.backdrop_response.clicked()
}

fn rows_ui(ui: &mut egui::Ui) {
    let grid = Grid::new("keys").num_columns(3).spacing([16.0, 3.0]);
    grid.show(ui, |ui| {
        heading_ui(ui, "Mouse");
        for (pointer, about) in POINTER {
            ui.label(RichText::new(*pointer).strong());
            ui.label(*about);
            ui.end_row();
        }
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

//! The tabs of the side panel.

pub mod inspect;
pub mod mesh;
pub mod trade;
pub mod view;

use egui::RichText;
use std::fmt::Display;

/// Height of a line of values, in points: lower than a button's, so that more fits.
const ROW_HEIGHT: f32 = 14.0;

/// A name, and a value that can be selected and copied.
fn row_ui(ui: &mut egui::Ui, name: &str, value: impl ToString) -> egui::Response {
    ui.label(name);
    let value = RichText::new(value.to_string()).monospace().size(11.5);
    let response = ui.add(egui::Label::new(value).wrap());
    ui.end_row();
    response
}

/// Rows of [`row_ui`] under a heading.
fn section_ui(ui: &mut egui::Ui, title: &str, rows: impl FnOnce(&mut egui::Ui)) {
    ui.add_space(2.0);
    ui.label(RichText::new(title).strong());
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = ROW_HEIGHT;
        egui::Grid::new(title)
            .num_columns(2)
            .spacing([10.0, 2.0])
            .show(ui, rows);
    });
    ui.add_space(4.0);
}

/// Three numbers, each on a line of its own.
fn lines(v: [impl Display; 3]) -> String {
    v.map(|x| x.to_string()).join("\n")
}

//! The tabs of the side panel.

mod clip;
mod colours;
pub mod compare;
mod eye;
mod flaws;
pub mod inspect;
pub mod labels;
pub mod light;
pub mod mesh;
mod overlay;
pub mod parts;
pub mod path;
pub mod picks;
pub mod progress;
pub mod quality;
mod table;
pub mod trade;
pub mod view;

use crate::numbers::number;
use egui::RichText;
use hitscope_core::group::kernel_named;
use std::fmt::{Display, LowerExp};

/// Width of the column of names, in points. It is fixed so that rows are aligned in the first frame.
const NAME_WIDTH: f32 = 104.0;

/// Shows a name and a value that can be selected and copied.
fn row_ui(ui: &mut egui::Ui, name: &str, value: impl ToString) {
    ui.horizontal_top(|ui| {
        let width = NAME_WIDTH - ui.spacing().item_spacing.x;
        ui.vertical(|ui| {
            ui.set_width(width);
            ui.add(egui::Label::new(name).wrap());
        });
        let value = RichText::new(value.to_string()).monospace().size(11.5);
        ui.add(egui::Label::new(value).wrap());
    });
}

/// Shows rows of [`row_ui`] under a heading.
fn section_ui(ui: &mut egui::Ui, title: &str, rows: impl FnOnce(&mut egui::Ui)) {
    ui.add_space(2.0);
    ui.label(RichText::new(title).strong());
    rows_ui(ui, rows);
}

/// Shows rows of [`row_ui`] close to each other.
fn rows_ui(ui: &mut egui::Ui, rows: impl FnOnce(&mut egui::Ui)) {
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.spacing_mut().item_spacing.y = 2.0;
        rows(ui);
    });
    ui.add_space(4.0);
}

/// The name of a kernel in the window: its tier if it has one, else its name. `--kernel` takes both.
pub fn kernel_name(name: &'static str) -> &'static str {
    kernel_named(name).map_or(name, |kernel| kernel.info.short_name())
}

/// Three numbers, one per line.
fn lines<T: Into<f64> + Display + LowerExp + Copy>(v: [T; 3]) -> String {
    v.map(number).join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn values_are_in_one_column_however_long_their_names_are() {
        let rows = |ui: &mut egui::Ui| {
            for (name, value) in [
                ("t", "1"),
                ("a name that is much too long for its column", "2"),
            ] {
                row_ui(ui, name, value);
            }
        };
        let harness = Harness::new_ui(rows);
        let left = |value| harness.get_by_label(value).rect().min.x;
        assert!((left("1") - left("2")).abs() < 0.5);
    }
}

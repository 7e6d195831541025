//! The section *Paths* of the *Inspect* tab: the path of one sample of the picked pixel.

use super::table::table_ui;
use super::{row_ui, rows_ui};
use crate::number_field::number_field;
use crate::numbers::significant;
use egui::RichText;
use hitscope_lab::inspection::{PathReport, VertexReport, light_text};

/// The path of a sample.
pub struct PathView<'p> {
    /// The path, once it has been followed.
    pub path: Option<&'p PathReport>,
    /// The selected sample.
    pub sample: u32,
    /// The last sample that can be selected.
    pub last: u32,
}

/// Room in points below the table for a scroll bar.
const BELOW_TABLE: f32 = 16.0;

/// Shows a path and a choice of samples. Returns the sample that the user selects.
pub fn path_ui(ui: &mut egui::Ui, view: &PathView<'_>) -> Option<u32> {
    let mut selected = view.sample;
    ui.add_space(2.0);
    ui.label(RichText::new("Paths").strong())
        .on_hover_text("The path of one sample, drawn over the picture with its rays to lights");
    ui.horizontal(|ui| {
        let name = ui.label("Sample");
        let step = number_field(&mut selected).range(0..=view.last);
        ui.add(step).labelled_by(name.id);
        let (first, last) = (view.sample == 0, view.sample == view.last);
        if ui
            .add_enabled(!first, egui::Button::new("Previous"))
            .clicked()
        {
            selected = view.sample - 1;
        }
        if ui.add_enabled(!last, egui::Button::new("Next")).clicked() {
            selected = view.sample + 1;
        }
        ui.label(RichText::new(format!("of 0 to {}", view.last)).weak());
    });
    if let Some(path) = view.path {
        rows_ui(ui, |ui| {
            row_ui(ui, "colour", light_text(path.radiance));
            row_ui(ui, "environment", light_text(path.from_afar));
            row_ui(ui, "end", path.end);
        });
        if !path.vertices.is_empty() {
            table_of_vertices_ui(ui, path);
        }
    }
    (selected != view.sample).then_some(selected)
}

/// Shows the vertices in a table, and notes about them. The first columns fit into the panel's default width.
fn table_of_vertices_ui(ui: &mut egui::Ui, path: &PathReport) {
    let vertices = || (1..).zip(&path.vertices);
    ui.label("Light that each surface adds to the colour, and the throughput of the path from there on (linear RGB)");
    egui::ScrollArea::horizontal()
        .id_salt("path table")
        .show(ui, |ui| {
            let row = |(number, vertex): (usize, &VertexReport)| {
                let primitive = format!("{} {}", vertex.shape, vertex.primitive);
                let light = [vertex.direct, vertex.emission, vertex.throughput];
                let [direct, emission, throughput] = light.map(light_text);
                let t = significant(f64::from(vertex.t), 5);
                [
                    number.to_string(),
                    t,
                    primitive,
                    direct,
                    emission,
                    throughput,
                ]
            };
            let columns = ["", "t", "primitive", "from lights", "emitted", "throughput"];
            table_ui(ui, columns, vertices().map(row));
            for (number, vertex) in vertices() {
                let notes = vertex.notes();
                if !notes.is_empty() {
                    let text = RichText::new(format!("{number}: {notes}")).weak();
                    ui.add(egui::Label::new(text).extend());
                }
            }
            // Otherwise the scroll bars cover the last line.
            ui.add_space(BELOW_TABLE);
        });
}

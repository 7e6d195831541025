//! The flaws of the mesh: a button for each kind, and a list of the flaws of the marked kind.

use super::mesh::on_one_line;
use crate::app::flaws::ShownFlaw;
use crate::flaw_place::{self, FlawPlace};
use egui::RichText;
use hitscope_core::counts::grouped;
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::{FLAWS, Health};

/// Shows the flaws. Returns the flaw that the user chooses to show, or that none is to be shown.
pub fn flaws_ui(
    ui: &mut egui::Ui,
    loaded: &LoadedScene,
    health: &Health,
    marked: Option<&FlawPlace>,
) -> Option<ShownFlaw> {
    let chosen = kinds_ui(ui, health, marked);
    let shown = marked.and_then(|place| list_ui(ui, loaded, health, place));
    chosen.or(shown)
}

/// Shows a button for each kind with the number of flaws.
fn kinds_ui(ui: &mut egui::Ui, health: &Health, marked: Option<&FlawPlace>) -> Option<ShownFlaw> {
    let mut shown = None;
    ui.horizontal_wrapped(|ui| {
        for info in &FLAWS {
            let is_marked = marked.is_some_and(|place| place.flaw == info.flaw);
            let count = health.places(info.flaw).count();
            let count_text = count.map_or("?".to_owned(), grouped);
            let text = format!("{}  {count_text}", info.title);
            let hint = match count {
                None => format!("{}\nNot checked: too many border edges.", info.about),
                Some(0) => info.about.to_owned(),
                Some(_) => format!("{}\nClick to show them.", info.about),
            };
            let is_there = count.is_some_and(|count| count > 0);
            let button = egui::Button::new(text).selected(is_marked);
            let response = ui.add_enabled(is_there, button);
            if response
                .on_hover_text(&hint)
                .on_disabled_hover_text(hint)
                .clicked()
            {
                shown = Some((!is_marked).then_some((info.flaw, 0)));
            }
        }
    });
    shown
}

/// Shows the flaws of the marked kind with their coordinates, and buttons for the next and the previous one.
fn list_ui(
    ui: &mut egui::Ui,
    loaded: &LoadedScene,
    health: &Health,
    place: &FlawPlace,
) -> Option<ShownFlaw> {
    /// Number of visible rows of the list.
    const ROWS: f32 = 6.0;
    let count = health.places(place.flaw).count().unwrap_or(0);
    let mesh = loaded.scene.mesh();
    let mut chosen = None;
    ui.horizontal(|ui| {
        if ui.button("Previous").clicked() {
            chosen = Some((place.index + count - 1) % count.max(1));
        }
        if ui.button("Next").clicked() {
            chosen = Some((place.index + 1) % count.max(1));
        }
        let number = grouped(place.index + 1);
        ui.label(format!("{number} of {}", grouped(count)));
        let line = place
            .face
            .map(|face| loaded.report.face_lines.line(face as usize));
        if let Some(line) = line.filter(|&line| line > 0) {
            ui.label(format!("line {line}"));
        }
    });
    let text = |index: usize| {
        let point = flaw_place::point(mesh, health, place.flaw, index);
        let point = point.map_or_else(String::new, |p| {
            on_one_line(mesh.vertex_in_file(p.as_vec3()))
        });
        RichText::new(format!("{}: {point}", grouped(index + 1)))
            .monospace()
            .size(10.5)
    };
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.spacing_mut().button_padding.y = 0.0;
        ui.spacing_mut().item_spacing.y = 1.0;
        let height = ui.text_style_height(&egui::TextStyle::Button);
        egui::ScrollArea::both()
            .id_salt("flaws")
            .max_height(ROWS * (height + 1.0))
            .auto_shrink([false, true])
            .show_rows(ui, height, count, |ui, rows| {
                for index in rows {
                    let button = egui::Button::selectable(index == place.index, text(index));
                    let button = button.wrap_mode(egui::TextWrapMode::Extend);
                    let button = button.min_size(egui::vec2(0.0, height));
                    if ui.add(button).clicked() {
                        chosen = Some(index);
                    }
                }
            });
    });
    chosen.map(|index| Some((place.flaw, index)))
}

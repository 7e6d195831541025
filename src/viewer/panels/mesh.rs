//! What is in the file.

use super::{lines, row_ui, section_ui};
use crate::app::grouped;
use crate::bindings::Action;
use crate::document::Document;
use crate::settings::Settings;
use egui::RichText;
use hitscope_core::mesh::{FLAWS, Flaw, Health};
use hitscope_core::scene::LoadedScene;

/// Counts, place, memory, health, warnings.
pub fn mesh_ui(
    ui: &mut egui::Ui,
    document: &mut Document,
    settings: &mut Settings,
    flaw: Option<Flaw>,
    actions: &mut Vec<Action>,
) {
    let findings = document.findings(ui.ctx());
    let loaded = &document.loaded;
    let scene = &loaded.scene;
    let mesh = scene.mesh();
    let path = document
        .path
        .as_ref()
        .map(|path| path.display().to_string());
    ui.label(RichText::new(document.name()).strong());
    if let Some(path) = path {
        ui.label(RichText::new(path).weak().size(11.0));
    }
    section_ui(ui, "Counts", |ui| {
        row_ui(ui, "vertices", grouped(loaded.vertex_count));
        row_ui(ui, "triangles", grouped(mesh.triangles.len()));
        row_ui(ui, "polygons", grouped(mesh.face_count));
        row_ui(ui, "materials", mesh.named_material_count());
        row_ui(ui, "groups", mesh.named_group_count());
    });
    if let Some(requirement) = findings.as_ref().map(|findings| &findings.requirement) {
        section_ui(ui, "Required kernel", |ui| {
            row_ui(ui, "tier", requirement.tier);
        });
        for reason in &requirement.reasons {
            ui.label(RichText::new(format!("{reason}.")).weak().size(11.5));
        }
    }
    place_ui(ui, loaded);
    cost_ui(ui, document);
    if packing_ui(ui, document, settings) {
        actions.push(Action::Reload);
    }
    let watch = egui::Checkbox::new(&mut settings.watches, "Load again when the file changes");
    ui.add_enabled(document.path.is_some(), watch)
        .on_hover_text(
            "Also when its materials or textures do. The camera and the picked pixel stay.",
        );
    let mesh = document.loaded.scene.mesh();
    section_ui(ui, "Health", |ui| {
        row_ui(
            ui,
            "zero area",
            format!("{} dropped", mesh.dropped.zero_area),
        );
        row_ui(
            ui,
            "not finite",
            format!("{} dropped", mesh.dropped.non_finite),
        );
        row_ui(
            ui,
            "bad index",
            format!("{} dropped", mesh.dropped.bad_index),
        );
    });
    if let Some(findings) = findings {
        actions.extend(flaws_ui(ui, &findings.health, flaw));
    }
    if !document.loaded.warnings.is_empty() {
        ui.label(RichText::new("Warnings").strong());
        for warning in &document.loaded.warnings {
            ui.label(warning.to_string());
        }
    }
}

/// Each kind of flaw with how many there are; a click marks and shows them, or ends that.
fn flaws_ui(ui: &mut egui::Ui, health: &Health, marked: Option<Flaw>) -> Option<Action> {
    let mut action = None;
    for info in &FLAWS {
        let is_marked = marked == Some(info.flaw);
        let count = health.places(info.flaw).count();
        ui.horizontal(|ui| {
            let count_text = count.map_or("?".to_owned(), grouped);
            let text = format!("{}  {count_text}", info.title);
            let is_there = count.is_some_and(|count| count > 0);
            let button = egui::Button::selectable(is_marked, text);
            let hint = match count {
                None => format!("{}\nNobody looked: the border is too long.", info.about),
                Some(0) => info.about.to_owned(),
                Some(_) => format!("{}\nA click shows them.", info.about),
            };
            let response = ui.add_enabled(is_there, button);
            if response
                .on_hover_text(&hint)
                .on_disabled_hover_text(hint)
                .clicked()
            {
                action = Some(Action::ShowFlaw((!is_marked).then_some(info.flaw)));
            }
        });
    }
    action
}

fn place_ui(ui: &mut egui::Ui, loaded: &LoadedScene) {
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    section_ui(ui, "Place", |ui| {
        let bounds = scene.bounds();
        let corner = |p: glam::Vec3| mesh.vertex_in_file(p).to_array();
        row_ui(ui, "lowest", lines(corner(bounds.min)));
        row_ui(ui, "highest", lines(corner(bounds.max)));
        row_ui(ui, "origin", lines(mesh.origin.to_array()));
        row_ui(
            ui,
            "rounded by",
            format!("{:.1e} at most", loaded.max_rounding),
        );
    });
}

/// Speed or memory; whether the choice changed.
fn packing_ui(ui: &mut egui::Ui, document: &Document, settings: &mut Settings) -> bool {
    let hint = "Tree and triangles take a third less memory, rays more time. Loads the file again.";
    let checkbox = egui::Checkbox::new(&mut settings.is_compact, "Compact triangles");
    // The built-in scene is made once, and small.
    let response = ui.add_enabled(document.path.is_some(), checkbox);
    response.on_hover_text(hint).changed()
}

fn cost_ui(ui: &mut egui::Ui, document: &Document) {
    let loaded = &document.loaded;
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    section_ui(ui, "Time and memory", |ui| {
        let ms = |time: std::time::Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
        row_ui(ui, "load", ms(loaded.load_time));
        row_ui(ui, "tree", ms(scene.build_time()));
        let kb = |bytes: usize| format!("{:.0} kB", bytes as f64 / 1e3);
        for (part, bytes) in mesh.bytes() {
            row_ui(ui, part, kb(bytes));
        }
        row_ui(ui, "tree", kb(scene.bvh().bytes()));
        row_ui(ui, "packed", kb(document.intersector().bytes()));
    });
}

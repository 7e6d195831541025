//! What is in the file.

use super::{lines, row_ui, section_ui};
use crate::app::grouped;
use crate::bindings::Action;
use crate::document::Document;
use crate::settings::Settings;
use egui::RichText;
use hitscope_core::mesh::SLIVER_ASPECT;
use hitscope_core::scene::LoadedScene;

/// Counts, place, memory, health, warnings.
pub fn mesh_ui(
    ui: &mut egui::Ui,
    document: &mut Document,
    settings: &mut Settings,
    actions: &mut Vec<Action>,
) {
    let findings = document.findings(ui.ctx());
    let health = findings.as_ref().map(|findings| findings.health);
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
        if let Some(health) = health {
            row_ui(ui, "open edges", grouped(health.open_edges));
            row_ui(ui, "non-manifold", grouped(health.non_manifold_edges));
            row_ui(ui, "flipped", grouped(health.flipped_edges));
            row_ui(ui, "slivers", grouped(health.slivers)).on_hover_text(format!(
                "Triangles longer than {SLIVER_ASPECT} times their height"
            ));
        }
    });
    if !document.loaded.warnings.is_empty() {
        ui.label(RichText::new("Warnings").strong());
        for warning in &document.loaded.warnings {
            ui.label(warning.to_string());
        }
    }
}

fn place_ui(ui: &mut egui::Ui, loaded: &LoadedScene) {
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    section_ui(ui, "Place", |ui| {
        let bounds = scene.bounds();
        let corner = |p: glam::Vec3| mesh.in_file(p.as_dvec3()).to_array();
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

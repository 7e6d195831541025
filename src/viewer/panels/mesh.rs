//! What is in the file.

use super::{lines, row_ui, section_ui};
use crate::app::grouped;
use crate::bindings::Action;
use crate::document::{Document, MeshReport};
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
        if mesh.has_elements() {
            row_ui(ui, "lines", grouped(mesh.lines.len()));
            row_ui(ui, "points", grouped(mesh.points.len()));
        }
    });
    if !loaded.warnings.is_empty() {
        ui.label(RichText::new("Warnings").strong());
        for warning in &loaded.warnings {
            ui.label(RichText::new(warning.to_string()).color(ui.visuals().warn_fg_color));
        }
        ui.add_space(4.0);
    }
    section_ui(ui, "Health", |ui| {
        let dropped = [
            ("zero area", mesh.dropped.zero_area),
            ("not finite", mesh.dropped.non_finite),
            ("bad index", mesh.dropped.bad_index),
        ];
        for (reason, count) in dropped {
            row_ui(ui, reason, format!("{} dropped", grouped(count)));
        }
    });
    if let Some(findings) = &findings {
        actions.extend(flaws_ui(ui, &findings.health, flaw));
        section_ui(ui, "Required kernel", |ui| {
            row_ui(ui, "tier", findings.requirement.tier);
        });
        for reason in &findings.requirement.reasons {
            ui.label(RichText::new(format!("{reason}.")).weak().size(11.5));
        }
    }
    let watch = egui::Checkbox::new(&mut settings.watches, "Load again when the file changes");
    ui.add_enabled(document.path.is_some(), watch)
        .on_hover_text(
            "Also when its materials or textures do. The camera and the picked pixel stay.",
        );
    if packing_ui(ui, document, settings) {
        actions.push(Action::Reload);
    }
    place_ui(ui, loaded);
    cost_ui(ui, document, findings.as_deref());
}

/// Each kind of flaw with how many there are; a click marks and shows them, or ends that.
fn flaws_ui(ui: &mut egui::Ui, health: &Health, marked: Option<Flaw>) -> Option<Action> {
    let mut action = None;
    ui.horizontal_wrapped(|ui| {
        for info in &FLAWS {
            let is_marked = marked == Some(info.flaw);
            let count = health.places(info.flaw).count();
            let count_text = count.map_or("?".to_owned(), grouped);
            let text = format!("{}  {count_text}", info.title);
            let hint = match count {
                None => format!("{}\nNobody looked: the border is too long.", info.about),
                Some(0) => info.about.to_owned(),
                Some(_) => format!("{}\nA click shows them.", info.about),
            };
            let is_there = count.is_some_and(|count| count > 0);
            let button = egui::Button::new(text).selected(is_marked);
            let response = ui.add_enabled(is_there, button);
            if response
                .on_hover_text(&hint)
                .on_disabled_hover_text(hint)
                .clicked()
            {
                action = Some(Action::ShowFlaw((!is_marked).then_some(info.flaw)));
            }
        }
    });
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

fn cost_ui(ui: &mut egui::Ui, document: &Document, findings: Option<&MeshReport>) {
    let loaded = &document.loaded;
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    let kb = |bytes: usize| format!("{} kB", grouped(bytes.div_ceil(1000)));
    section_ui(ui, "Time", |ui| {
        let ms = |time: std::time::Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
        row_ui(ui, "load", ms(loaded.load_time));
        row_ui(ui, "tree", ms(scene.build_time()));
    });
    section_ui(ui, "In memory", |ui| {
        let parts = mesh.bytes().into_iter();
        for (part, bytes) in parts.filter(|(_, bytes)| *bytes > 0) {
            row_ui(ui, part, kb(bytes));
        }
        row_ui(ui, "tree", kb(scene.bvh().bytes()));
        row_ui(ui, "packed triangles", kb(document.intersector().bytes()));
    });
    if let Some(findings) = findings {
        section_ui(ui, "The surface would take", |ui| {
            for (way, bytes) in findings.bytes_as {
                row_ui(ui, &format!("as {way}"), kb(bytes));
            }
        });
    }
}

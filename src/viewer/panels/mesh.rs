//! The Mesh tab: contents, warnings, flaws and memory of the open file.

use super::flaws::flaws_ui;
use super::{lines, row_ui, section_ui};
use crate::app::flaws::ShownFlaw;
use crate::command::Commands;
use crate::document::{Document, MeshReport};
use crate::flaw_place::FlawPlace;
use crate::numbers::{duration, number, significant};
use egui::RichText;
use hitscope_core::counts::{counted, grouped};
use hitscope_core::loading::LoadedScene;

/// Shows the tab; `flaw` is the selected flaw. Returns the flaw that the user chooses to show, or that none is to be
/// shown.
pub fn mesh_ui(
    ui: &mut egui::Ui,
    document: &mut Document,
    flaw: Option<&FlawPlace>,
    commands: &Commands,
) -> Option<ShownFlaw> {
    let mut shown = None;
    let findings = document.findings(ui.ctx());
    let loaded = &document.loaded;
    let path = document.path.as_ref();
    let path = path.map(|path| path.display().to_string());
    ui.label(RichText::new(document.name()).strong());
    if let Some(path) = path {
        ui.label(RichText::new(path).weak().size(11.0));
    }
    contents_ui(ui, loaded);
    shapes_ui(ui, loaded);
    if !loaded.report.warnings.is_empty() {
        ui.label(RichText::new("Warnings").strong());
        for warning in &loaded.report.warnings {
            ui.label(RichText::new(warning.to_string()).color(ui.visuals().warn_fg_color));
        }
        ui.add_space(4.0);
    }
    let dropped = loaded.report.dropped;
    section_ui(ui, "Dropped", |ui| {
        row_ui(ui, "zero area", counted(dropped.zero_area, "triangle"));
        row_ui(ui, "non-finite", counted(dropped.non_finite, "triangle"));
        row_ui(ui, "invalid index", counted(dropped.bad_index, "face"));
    });
    ui.label(RichText::new("Flaws").strong());
    match &findings {
        Some(findings) => {
            shown = flaws_ui(ui, loaded, &findings.health, flaw);
            ui.add_space(4.0);
            section_ui(ui, "Required kernel", |ui| {
                row_ui(ui, "tier", findings.requirement.tier);
            });
            for reason in &findings.requirement.reasons {
                ui.label(RichText::new(reason).weak().size(11.5));
            }
        }
        None if document.has_failed_check() => {
            ui.label("The check failed; see the terminal for details.");
        }
        None => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label("Checking…");
            });
        }
    }
    options_ui(ui, commands);
    place_ui(ui, &document.loaded);
    cost_ui(ui, document, findings.as_deref());
    shown
}

fn contents_ui(ui: &mut egui::Ui, loaded: &LoadedScene) {
    let mesh = loaded.scene.mesh();
    section_ui(ui, "Contents", |ui| {
        row_ui(ui, "vertices", grouped(loaded.report.vertex_count));
        row_ui(ui, "triangles", grouped(mesh.triangles().len()));
        row_ui(ui, "polygons", grouped(mesh.face_count()));
        row_ui(ui, "named materials", grouped(mesh.named_material_count()));
        row_ui(ui, "groups", grouped(mesh.named_group_count()));
        if mesh.has_lines_or_points() {
            row_ui(ui, "lines", grouped(mesh.attributes().lines.len()));
            row_ui(ui, "points", grouped(mesh.attributes().points.len()));
        }
    });
}

/// Shows the groups of primitives, one per shape.
fn shapes_ui(ui: &mut egui::Ui, loaded: &LoadedScene) {
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    section_ui(ui, "Shapes", |ui| {
        for group in scene.groups() {
            let (shape, bounds) = (group.shape(), group.bounds());
            let corner = |p: glam::Vec3| on_one_line(mesh.vertex_in_file(p));
            let place = if bounds.is_empty() {
                "no bounds".to_owned()
            } else {
                format!("{}\n{}", corner(bounds.min), corner(bounds.max))
            };
            let tree = if group.is_bounded() {
                let kb = group.bvh().bytes().div_ceil(1000);
                let time = duration(group.build_time());
                format!("tree {} kB in {time}", grouped(kb))
            } else {
                "no tree".to_owned()
            };
            let count = grouped(group.count());
            row_ui(ui, shape.plural, format!("{count}\n{tree}\n{place}"));
        }
    });
}

/// Shows the options for loading the file.
fn options_ui(ui: &mut egui::Ui, commands: &Commands) {
    ui.add_space(6.0);
    ui.label(RichText::new("Loading").strong());
    commands.check_box_ui(ui, "auto-reload");
    commands.check_box_ui(ui, "compact");
    ui.add_space(4.0);
}

fn place_ui(ui: &mut egui::Ui, loaded: &LoadedScene) {
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    section_ui(ui, "Bounds", |ui| {
        let bounds = scene.bounds_with_elements();
        let corner = |p: glam::Vec3| mesh.vertex_in_file(p).to_array();
        row_ui(ui, "minimum", lines(corner(bounds.min)));
        row_ui(ui, "maximum", lines(corner(bounds.max)));
        row_ui(ui, "origin", lines(mesh.origin().to_array()));
        let rounding = significant(loaded.report.max_rounding, 2);
        row_ui(ui, "rounded by", format!("at most {rounding}"));
    });
}

fn cost_ui(ui: &mut egui::Ui, document: &Document, findings: Option<&MeshReport>) {
    let loaded = &document.loaded;
    let (scene, mesh) = (&loaded.scene, loaded.scene.mesh());
    let kb = |bytes: usize| format!("{} kB", grouped(bytes.div_ceil(1000)));
    section_ui(ui, "Time", |ui| {
        row_ui(ui, "load", duration(loaded.report.duration));
        row_ui(ui, "tree", duration(scene.build_time()));
    });
    section_ui(ui, "Memory", |ui| {
        let parts = mesh.bytes().into_iter();
        for (part, bytes) in parts.filter(|(_, bytes)| *bytes > 0) {
            row_ui(ui, part, kb(bytes));
        }
        row_ui(ui, "tree", kb(scene.tree_bytes()));
        row_ui(ui, "packed primitives", kb(document.intersector().bytes()));
    });
    if let Some(findings) = findings {
        section_ui(ui, "Memory of the surface by format", |ui| {
            for (way, bytes) in findings.bytes_as {
                row_ui(ui, &format!("as {way}"), kb(bytes));
            }
        });
    }
}

/// Coordinates on one line.
pub(super) fn on_one_line(p: glam::DVec3) -> String {
    p.to_array().map(number).join(", ")
}

//! The picked pixel: what its ray hit, and what every kernel says of it.

use super::{row_ui, section_ui};
use egui::RichText;
use hitscope_lab::inspection::{ExactReport, HitReport, Inspection, KernelRow};
use std::fmt::Display;

/// What is known of the clicked pixel, or how to get to know something.
pub fn inspect_ui(ui: &mut egui::Ui, inspection: Option<&Inspection>) {
    let Some(inspection) = inspection else {
        ui.label("Click a pixel to see what its ray hits.");
        return;
    };
    ui.horizontal(|ui| {
        let [x, y] = inspection.pixel;
        ui.label(RichText::new(format!("Pixel {x}, {y}")).strong());
        if ui.button("Copy as JSON").clicked() {
            let json = serde_json::to_string_pretty(inspection);
            ui.ctx()
                .copy_text(json.expect("an inspection is plain data"));
        }
    });
    match &inspection.hit {
        Some(hit) => hit_ui(ui, inspection, hit),
        None => _ = ui.label(format!("{}: no hit", inspection.kernel)),
    }
    if let Some(exact) = &inspection.exact {
        exact_ui(ui, exact);
    }
    kernels_ui(ui, &inspection.kernels);
    section_ui(ui, "Cost", |ui| {
        row_ui(ui, "boxes", inspection.cost.boxes);
        row_ui(ui, "triangles", inspection.cost.triangles);
    });
    section_ui(ui, "Ray", |ui| {
        row_ui(ui, "origin", lines(inspection.ray.origin));
        row_ui(ui, "direction", lines(inspection.ray.direction));
    });
}

fn hit_ui(ui: &mut egui::Ui, inspection: &Inspection, hit: &HitReport) {
    section_ui(ui, &format!("Hit ({})", inspection.kernel), |ui| {
        row_ui(ui, "t", hit.t);
        for (name, weight) in ["l1 (A)", "l2 (B)", "l3 (C)"]
            .into_iter()
            .zip(hit.barycentric)
        {
            row_ui(ui, name, weight);
        }
        row_ui(ui, "triangle", hit.triangle);
        row_ui(ui, "polygon", hit.face);
        row_ui(ui, "material", or_dash(&hit.material));
        row_ui(ui, "group", or_dash(&hit.group));
        row_ui(ui, "position", lines(hit.position));
    });
    section_ui(ui, "Normals", |ui| {
        row_ui(ui, "geometric", lines(hit.geometric_normal));
        row_ui(ui, "shading", lines(hit.shading_normal));
    });
    section_ui(ui, "Triangle", |ui| {
        for (name, vertex) in ["A", "B", "C"].into_iter().zip(hit.vertices) {
            row_ui(ui, name, lines(vertex));
        }
    });
}

fn exact_ui(ui: &mut egui::Ui, exact: &ExactReport) {
    section_ui(ui, "Exactly", |ui| {
        row_ui(ui, "t", exact.t);
        for (name, weight) in ["l1 (A)", "l2 (B)", "l3 (C)"]
            .into_iter()
            .zip(exact.barycentric)
        {
            row_ui(ui, name, weight);
        }
        row_ui(ui, "triangle", exact.triangle);
        if exact.is_on_boundary {
            row_ui(ui, "place", "on the boundary");
        }
        if !exact.also.is_empty() {
            row_ui(ui, "also", format!("{:?}", exact.also));
        }
    });
}

/// One column a kernel, so that their numbers stand side by side.
fn kernels_ui(ui: &mut egui::Ui, kernels: &[KernelRow]) {
    ui.label(RichText::new("Kernels").strong());
    egui::ScrollArea::horizontal().show(ui, |ui| {
        egui::Grid::new("kernels")
            .spacing([10.0, 2.0])
            .striped(true)
            .show(ui, |ui| {
                ui.label("");
                for kernel in kernels {
                    ui.label(RichText::new(kernel.name).size(11.5));
                }
                ui.end_row();
                let mut row = |name: &str, value: &dyn Fn(&KernelRow) -> Option<String>| {
                    ui.label(name);
                    for kernel in kernels {
                        let text = value(kernel).unwrap_or("–".to_owned());
                        ui.label(RichText::new(text).monospace().size(11.5));
                    }
                    ui.end_row();
                };
                row("t", &|k| {
                    Some(k.t.map_or("miss".to_owned(), |t| t.to_string()))
                });
                row("off by", &|k| k.t_error_ulps.map(|e| format!("{e:.3} ulp")));
                for i in 0..3 {
                    let name = ["l1", "l2", "l3"][i];
                    row(name, &|k| k.barycentric.map(|b| b[i].to_string()));
                }
                row("off by", &|k| {
                    k.barycentric_error.map(|e| format!("{e:.1e}"))
                });
                row("triangle", &|k| k.triangle.map(|t| t.to_string()));
            });
    });
    ui.add_space(4.0);
}

/// Three numbers, each on a line of its own.
fn lines(v: [impl Display; 3]) -> String {
    v.map(|x| x.to_string()).join("\n")
}

fn or_dash(name: &str) -> &str {
    if name.is_empty() { "–" } else { name }
}

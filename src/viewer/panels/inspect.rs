//! The picked pixel: what its ray hit, and what every kernel says of it.

use super::{ROW_HEIGHT, row_ui, section_ui};
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
        Some(hit) => hit_ui(ui, inspection.kernel, hit),
        None => _ = ui.label(format!("{}: no hit", inspection.kernel)),
    }
    kernels_ui(ui, inspection.exact.as_ref(), &inspection.kernels);
    if let Some(hit) = &inspection.hit {
        surface_ui(ui, hit);
    }
    section_ui(ui, "Cost and ray", |ui| {
        let cost = inspection.cost;
        row_ui(
            ui,
            "tested",
            format!("{} boxes\n{} triangles", cost.boxes, cost.triangles),
        );
        row_ui(ui, "origin", lines(inspection.ray.origin));
        row_ui(ui, "direction", lines(inspection.ray.direction));
    });
}

fn hit_ui(ui: &mut egui::Ui, kernel: &str, hit: &HitReport) {
    section_ui(ui, &format!("Hit ({kernel})"), |ui| {
        row_ui(ui, "t", hit.t);
        row_ui(ui, "l1, l2, l3", lines(hit.barycentric));
        row_ui(ui, "triangle", hit.triangle);
        row_ui(ui, "polygon", hit.face);
        row_ui(ui, "material", or_dash(&hit.material));
        row_ui(ui, "group", or_dash(&hit.group));
        row_ui(ui, "position", lines(hit.position));
    });
}

fn surface_ui(ui: &mut egui::Ui, hit: &HitReport) {
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

/// One column a kernel beside the exact answer, so that their numbers can be compared.
fn kernels_ui(ui: &mut egui::Ui, exact: Option<&ExactReport>, kernels: &[KernelRow]) {
    ui.label(RichText::new("Kernels against exact arithmetic").strong());
    let small =
        |text: String| egui::Label::new(RichText::new(text).monospace().size(11.0)).extend();
    egui::ScrollArea::horizontal()
        .id_salt("kernels")
        .show(ui, |ui| {
            ui.spacing_mut().interact_size.y = ROW_HEIGHT;
            egui::Grid::new("kernels")
                .spacing([10.0, 2.0])
                .striped(true)
                .show(ui, |ui| {
                    ui.label("");
                    ui.label(RichText::new("exact").size(11.5));
                    for kernel in kernels {
                        ui.label(RichText::new(kernel.name).size(11.5));
                    }
                    ui.end_row();
                    let mut row =
                        |name: &str,
                         exact: Option<String>,
                         value: &dyn Fn(&KernelRow) -> Option<String>| {
                            ui.label(name);
                            for text in [exact].into_iter().chain(kernels.iter().map(value)) {
                                ui.add(small(text.unwrap_or("–".to_owned())));
                            }
                            ui.end_row();
                        };
                    let miss = || Some("miss".to_owned());
                    row(
                        "t",
                        exact.map_or_else(miss, |e| Some(format!("{:.12}", e.t))),
                        &|k| k.t.map_or_else(miss, |t| Some(t.to_string())),
                    );
                    row("off by", None, &|k| {
                        k.t_error_ulps.map(|e| format!("{e:.3} ulp"))
                    });
                    for i in 0..3 {
                        let weight = exact.map(|e| format!("{:.12}", e.barycentric[i]));
                        row(["l1", "l2", "l3"][i], weight, &|k| {
                            k.barycentric.map(|b| b[i].to_string())
                        });
                    }
                    row("off by", None, &|k| {
                        k.barycentric_error.map(|e| format!("{e:.1e}"))
                    });
                    row("triangle", exact.map(triangles), &|k| {
                        k.triangle.map(|t| t.to_string())
                    });
                    row("place", exact.map(place), &|_| None);
                });
        });
    ui.add_space(4.0);
}

/// The nearest triangle, and those at exactly the same distance.
fn triangles(exact: &ExactReport) -> String {
    let also = exact.also.iter().map(|t| format!(" {t}"));
    std::iter::once(exact.triangle.to_string())
        .chain(also)
        .collect()
}

fn place(exact: &ExactReport) -> String {
    let place = if exact.is_on_boundary {
        "boundary"
    } else {
        "inside"
    };
    place.to_owned()
}

/// Three numbers, each on a line of its own.
fn lines(v: [impl Display; 3]) -> String {
    v.map(|x| x.to_string()).join("\n")
}

fn or_dash(name: &str) -> &str {
    if name.is_empty() { "–" } else { name }
}

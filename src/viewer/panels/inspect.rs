//! The picked pixel: what its ray hit, and what every kernel says of it.

use super::{ROW_HEIGHT, lines, row_ui, section_ui};
use egui::RichText;
use hitscope_lab::inspection::{ExactReport, HitReport, Inspection, KernelRow};

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

/// One row a kernel below the exact answer, so that their numbers can be compared.
fn kernels_ui(ui: &mut egui::Ui, exact: Option<&ExactReport>, kernels: &[KernelRow]) {
    const COLUMNS: [&str; 8] = [
        "",
        "t",
        "off by",
        "weights off",
        "triangle",
        "l1",
        "l2",
        "l3",
    ];
    ui.label(RichText::new("Kernels against exact arithmetic").strong());
    egui::ScrollArea::horizontal()
        .id_salt("kernels")
        .show(ui, |ui| {
            ui.spacing_mut().interact_size.y = ROW_HEIGHT;
            egui::Grid::new("kernels")
                .spacing([10.0, 2.0])
                .striped(true)
                .show(ui, |ui| {
                    for column in COLUMNS {
                        ui.label(RichText::new(column).size(11.5));
                    }
                    ui.end_row();
                    cells_ui(ui, exact_cells(exact));
                    for kernel in kernels {
                        cells_ui(ui, kernel_cells(kernel));
                    }
                });
        });
    if let Some(exact) = exact {
        let also = exact
            .also
            .iter()
            .map(|t| format!(", and at the same t triangle {t}"));
        let place = if exact.is_on_boundary {
            "on the boundary"
        } else {
            "inside"
        };
        let text = format!(
            "The exact hit is {place} of its triangle{}.",
            also.collect::<String>()
        );
        ui.label(RichText::new(text).weak().size(11.5));
    }
    ui.add_space(4.0);
}

fn cells_ui(ui: &mut egui::Ui, cells: [Option<String>; 8]) {
    for cell in cells {
        let text = cell.unwrap_or("–".to_owned());
        let text = RichText::new(text).monospace().size(11.0);
        ui.add(egui::Label::new(text).extend());
    }
    ui.end_row();
}

fn exact_cells(exact: Option<&ExactReport>) -> [Option<String>; 8] {
    let weight = |k: usize| exact.map(|e| format!("{:.10}", e.barycentric[k]));
    [
        Some("exact".to_owned()),
        Some(exact.map_or("miss".to_owned(), |e| significant(e.t))),
        None,
        None,
        exact.map(|e| e.triangle.to_string()),
        weight(0),
        weight(1),
        weight(2),
    ]
}

fn kernel_cells(kernel: &KernelRow) -> [Option<String>; 8] {
    let weight = |k: usize| kernel.barycentric.map(|b| b[k].to_string());
    [
        Some(kernel.name.to_owned()),
        Some(kernel.t.map_or("miss".to_owned(), |t| t.to_string())),
        kernel.t_error_ulps.map(|e| format!("{e:.2} ulp")),
        kernel.barycentric_error.map(|e| format!("{e:.1e}")),
        kernel.triangle.map(|t| t.to_string()),
        weight(0),
        weight(1),
        weight(2),
    ]
}

/// With eleven significant digits: two more than f32 ever needs.
fn significant(x: f64) -> String {
    let before_point = x.abs().log10().floor().clamp(-20.0, 10.0) as i32;
    format!("{x:.*}", (10 - before_point).max(0) as usize)
}

fn or_dash(name: &str) -> &str {
    if name.is_empty() { "–" } else { name }
}

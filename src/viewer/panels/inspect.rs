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
            ui.ctx().copy_text(inspection.to_json());
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

/// One row a kernel below the exact answer, so that their numbers can be compared: distances first,
/// then weights, which would not fit beside them.
fn kernels_ui(ui: &mut egui::Ui, exact: Option<&ExactReport>, kernels: &[KernelRow]) {
    ui.label(RichText::new("Kernels against exact arithmetic").strong());
    egui::ScrollArea::horizontal()
        .id_salt("kernels")
        .show(ui, |ui| {
            ui.spacing_mut().interact_size.y = ROW_HEIGHT;
            let columns = ["", "t", "ulps off", "l off", "triangle"];
            table_ui(
                ui,
                columns,
                exact_distance(exact),
                kernels.iter().map(kernel_distance),
            );
            // Nothing hit: no weights.
            if exact.is_none() && kernels.iter().all(|kernel| !kernel.hit) {
                return;
            }
            ui.add_space(4.0);
            let columns = ["", "l1", "l2", "l3"];
            table_ui(
                ui,
                columns,
                exact_weights(exact),
                kernels.iter().map(kernel_weights),
            );
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
        fractions_ui(ui, exact);
    }
    ui.add_space(4.0);
}

/// The exact numbers themselves: of up to some hundred digits.
fn fractions_ui(ui: &mut egui::Ui, exact: &ExactReport) {
    egui::CollapsingHeader::new("As fractions")
        .id_salt("fractions")
        .show(ui, |ui| {
            let [l1, l2, l3] = &exact.barycentric_fractions;
            for (name, fraction) in [("t", &exact.t_fraction), ("l1", l1), ("l2", l2), ("l3", l3)] {
                let text = RichText::new(format!("{name} = {fraction}"))
                    .monospace()
                    .size(10.5);
                ui.add(egui::Label::new(text).wrap());
            }
        });
}

fn table_ui<const N: usize>(
    ui: &mut egui::Ui,
    columns: [&str; N],
    exact: [String; N],
    kernels: impl Iterator<Item = [String; N]>,
) {
    egui::Grid::new(columns)
        .spacing([8.0, 2.0])
        .striped(true)
        .show(ui, |ui| {
            for column in columns {
                ui.label(RichText::new(column).size(11.5));
            }
            ui.end_row();
            for cells in std::iter::once(exact).chain(kernels) {
                for cell in cells {
                    let text = RichText::new(cell).monospace().size(10.5);
                    ui.add(egui::Label::new(text).extend());
                }
                ui.end_row();
            }
        });
}

fn exact_distance(exact: Option<&ExactReport>) -> [String; 5] {
    [
        "oracle".to_owned(),
        exact.map_or("miss".to_owned(), |e| significant(e.t)),
        dash(),
        dash(),
        exact.map_or_else(dash, |e| e.triangle.to_string()),
    ]
}

fn kernel_distance(kernel: &KernelRow) -> [String; 5] {
    [
        kernel.name.to_owned(),
        kernel.t.map_or("miss".to_owned(), |t| t.to_string()),
        kernel.t_error_ulps.map_or_else(dash, |e| format!("{e:.2}")),
        kernel
            .barycentric_error
            .map_or_else(dash, |e| format!("{e:.1e}")),
        kernel.triangle.map_or_else(dash, |t| t.to_string()),
    ]
}

fn exact_weights(exact: Option<&ExactReport>) -> [String; 4] {
    let weight = |k: usize| exact.map_or_else(dash, |e| format!("{:.9}", e.barycentric[k]));
    ["oracle".to_owned(), weight(0), weight(1), weight(2)]
}

fn kernel_weights(kernel: &KernelRow) -> [String; 4] {
    let weight = |k: usize| {
        kernel
            .barycentric
            .map_or_else(dash, |b| format!("{:.9}", b[k]))
    };
    [kernel.name.to_owned(), weight(0), weight(1), weight(2)]
}

fn dash() -> String {
    "–".to_owned()
}

/// With eleven significant digits: two more than f32 ever needs.
fn significant(x: f64) -> String {
    let before_point = x.abs().log10().floor().clamp(-20.0, 10.0) as i32;
    format!("{x:.*}", (10 - before_point).max(0) as usize)
}

fn or_dash(name: &str) -> &str {
    if name.is_empty() { "–" } else { name }
}

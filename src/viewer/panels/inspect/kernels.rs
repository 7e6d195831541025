//! The section of the Inspect tab that compares the answers of all kernels with the exact answer.

use super::also;
use crate::numbers::{number, significant};
use crate::panels::kernel_name;
use crate::panels::table::{dash, table_ui};
use egui::{CollapsingHeader, RichText};
use hitscope_lab::inspection::{ExactReport, ExactTriangle, Inspection, KernelRow};

/// Shows the exact answer, a summary of all kernels, and each kernel's answer.
pub(super) fn kernels_ui(ui: &mut egui::Ui, inspection: &Inspection) {
    let (exact, kernels) = (inspection.exact.as_ref(), &inspection.kernels[..]);
    ui.label(RichText::new("Kernels compared with exact arithmetic").strong());
    ui.label(summary(exact, kernels));
    if let Some(exact) = exact {
        let also = match also(&exact.also).as_str() {
            "" => String::new(),
            also => format!("{also} (at the same t)"),
        };
        let place = match &exact.fractions {
            Some(triangle) if triangle.is_on_boundary => "on the boundary of triangle",
            Some(_) => "inside triangle",
            None => "on primitive",
        };
        let text = format!("The exact hit is {place} {}{also}.", exact.primitive);
        ui.label(RichText::new(text).weak());
    }
    CollapsingHeader::new("All kernels")
        .id_salt("kernels")
        .show_unindented(ui, |ui| kernel_tables_ui(ui, exact, kernels));
    if let Some(triangle) = exact.and_then(|exact| exact.fractions.as_ref()) {
        fractions_ui(ui, triangle);
    }
    ui.add_space(4.0);
}

/// The number of kernels that agree with exact arithmetic, and the largest error of t.
fn summary(exact: Option<&ExactReport>, kernels: &[KernelRow]) -> String {
    let is_right = |kernel: &&KernelRow| kernel.triangle == exact.map(|exact| exact.primitive);
    let right = kernels.iter().filter(is_right).count();
    let decision = if exact.is_some() {
        "find the exact primitive"
    } else {
        "miss, as exact arithmetic does"
    };
    let errors = kernels.iter().filter_map(|kernel| kernel.t_error_ulps);
    let worst = errors.reduce(f64::max).map_or_else(String::new, |ulps| {
        format!("; largest error of t: {} ulps", significant(ulps, 3))
    });
    let count = kernels.len();
    if right == count {
        format!("All {count} kernels {decision}{worst}.")
    } else {
        format!("{right} of {count} kernels {decision}{worst}.")
    }
}

/// Shows all answers in tables that are narrow enough for the panel's default width.
fn kernel_tables_ui(ui: &mut egui::Ui, exact: Option<&ExactReport>, kernels: &[KernelRow]) {
    egui::ScrollArea::horizontal()
        .id_salt("kernel tables")
        .show(ui, |ui| {
            ui.label("Distance, with its error in f32 ulps");
            let columns = ["", "t", "error", "primitive"];
            let rows = kernels.iter().map(kernel_distance);
            table_ui(
                ui,
                columns,
                std::iter::once(exact_distance(exact)).chain(rows),
            );
            // Only hits of triangles have barycentric coordinates.
            let has_none = |kernel: &KernelRow| kernel.barycentric.is_none();
            if exact.is_none_or(|exact| exact.fractions.is_none()) && kernels.iter().all(has_none) {
                return;
            }
            ui.add_space(4.0);
            ui.label("Barycentric coordinates, with the largest error");
            let columns = ["", "l1", "l2", "l3", "error"];
            let rows = kernels.iter().map(kernel_barycentric);
            table_ui(
                ui,
                columns,
                std::iter::once(exact_barycentric(exact)).chain(rows),
            );
        });
}

/// Shows the exact numbers as fractions of up to some hundred digits.
fn fractions_ui(ui: &mut egui::Ui, exact: &ExactTriangle) {
    CollapsingHeader::new("As fractions")
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

fn exact_distance(exact: Option<&ExactReport>) -> [String; 4] {
    [
        EXACT.to_owned(),
        // Two digits more than an f32 needs.
        exact.map_or("miss".to_owned(), |exact| significant(exact.t, 11)),
        dash(),
        exact.map_or_else(dash, |exact| exact.primitive.to_string()),
    ]
}

fn kernel_distance(kernel: &KernelRow) -> [String; 4] {
    [
        kernel_name(kernel.name).to_owned(),
        kernel.t.map_or("miss".to_owned(), number),
        rounded_error(kernel.t_error_ulps),
        kernel.triangle.map_or_else(dash, |t| t.to_string()),
    ]
}

fn exact_barycentric(exact: Option<&ExactReport>) -> [String; 5] {
    let [l1, l2, l3] =
        coordinates(exact.and_then(|exact| Some(exact.fractions.as_ref()?.barycentric)));
    [EXACT.to_owned(), l1, l2, l3, dash()]
}

fn kernel_barycentric(kernel: &KernelRow) -> [String; 5] {
    let [l1, l2, l3] = coordinates(kernel.barycentric.map(|l| l.map(f64::from)));
    let name = kernel_name(kernel.name).to_owned();
    [name, l1, l2, l3, rounded_error(kernel.barycentric_error)]
}

/// The row of the exact numbers.
const EXACT: &str = "exact answer";

/// Barycentric coordinates with the digits that fit; *Copy as JSON* has them all.
fn coordinates(barycentric: Option<[f64; 3]>) -> [String; 3] {
    barycentric.map_or_else(
        || std::array::from_fn(|_| dash()),
        |l| l.map(|l| significant(l, 7)),
    )
}

fn rounded_error(error: Option<f64>) -> String {
    error.map_or_else(dash, |error| significant(error, 2))
}

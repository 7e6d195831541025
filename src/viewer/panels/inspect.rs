//! The Inspect tab: the hit of the picked pixel's ray and the answers of all kernels.

mod kernels;

use super::{lines, row_ui, rows_ui, section_ui};
use crate::command::{Commands, keys::keys_of};
use crate::face_lookup::FaceInFile;
use crate::number_field::number_slider;
use crate::numbers::{number, significant};
use egui::{CollapsingHeader, RichText};
use hitscope_core::counts::{counted, counted_as};
use hitscope_lab::inspection::{
    CrossingReport, HitReport, Inspection, OperandName, ParameterReport, ParameterValue,
    Parameters, SolidReport, TriangleReport,
};
use kernels::kernels_ui;

/// The contents of the tab for a pick.
pub struct PickView<'p> {
    /// The ray, its hit and the kernels' answers.
    pub inspection: &'p Inspection,
    /// The marked crossing, counted from 0.
    pub crossing: Option<usize>,
    /// Name of the kernel, as shown in menus.
    pub kernel: &'p str,
    /// The face in the file, once it has been read.
    pub face: Option<&'p FaceInFile>,
    /// Whether the face is being read.
    pub is_reading_face: bool,
    /// Whether the triangle has texture coordinates.
    pub has_uv: bool,
    /// Colour of the hit point, if the file has colours.
    pub colour: Option<[f32; 3]>,
}

/// Shows a pick, or how to pick a pixel; `is_busy` while a pixel is being inspected. Returns the crossing that the user
/// selects.
pub fn inspect_ui(
    ui: &mut egui::Ui,
    pick: Option<PickView<'_>>,
    is_busy: bool,
    commands: &Commands,
) -> Option<usize> {
    let Some(pick) = pick else {
        if is_busy {
            ui.spinner();
        } else {
            ui.label("Click a pixel to inspect its ray.");
        }
        return None;
    };
    let inspection = pick.inspection;
    title_ui(ui, inspection, is_busy, commands);
    match &inspection.hit {
        Some(hit) => {
            hit_ui(ui, &pick, hit);
            match &hit.triangle {
                Some(triangle) => triangle_ui(ui, &pick, triangle),
                None => shape_ui(ui, hit),
            }
            formula_ui(ui, hit);
        }
        None => _ = ui.label(format!("No hit ({})", pick.kernel)),
    }
    let selected = crossings_ui(ui, &inspection.crossings, pick.crossing);
    kernels_ui(ui, inspection);
    if let Some(hit) = &inspection.hit {
        section_ui(ui, "Normals", |ui| {
            row_ui(ui, "geometric", lines(hit.geometric_normal));
            row_ui(ui, "shading", lines(hit.shading_normal));
        });
    }
    section_ui(ui, "Ray", |ui| {
        let cost = inspection.cost;
        let boxes = counted_as(cost.boxes as usize, "box", "boxes");
        let primitives = counted(cost.triangles as usize, "primitive");
        row_ui(ui, "tested", format!("{boxes}\n{primitives}"));
        row_ui(ui, "origin", lines(inspection.ray.origin));
        row_ui(ui, "direction", lines(inspection.ray.direction));
    });
    selected
}

fn title_ui(ui: &mut egui::Ui, inspection: &Inspection, is_busy: bool, commands: &Commands) {
    ui.horizontal(|ui| {
        let [x, y] = inspection.pixel;
        ui.label(RichText::new(format!("Pixel {x}, {y}")).strong());
        commands.button_ui(ui, "copy-pick");
        if is_busy {
            ui.spinner();
        }
    });
}

fn hit_ui(ui: &mut egui::Ui, pick: &PickView<'_>, hit: &HitReport) {
    section_ui(ui, &format!("Hit ({})", pick.kernel), |ui| {
        row_ui(ui, "t", number(hit.t));
        row_ui(ui, "position", lines(hit.position));
        row_ui(ui, "side", hit.side);
        if let Some(triangle) = &hit.triangle {
            row_ui(ui, "barycentric", lines(triangle.barycentric));
            match pick.face.and_then(|face| face.uv(triangle.barycentric)) {
                Some(uv) => row_ui(ui, "uv", uv.map(|x| significant(x, 7)).join("\n")),
                // Keeps the rows below in place.
                None if pick.has_uv && pick.is_reading_face => row_ui(ui, "uv", "…\n"),
                None => {}
            }
        }
        if let Some(uv) = hit.surface_uv {
            row_ui(ui, "u, v", uv.map(|x| significant(x, 7)).join("\n"));
        }
        if let Some(colour) = pick.colour {
            let text = colour.map(|channel| significant(channel.into(), 3));
            row_ui(ui, "vertex colour", text.join(", "));
        }
        row_ui(ui, "material", or_dash(&hit.material));
        row_ui(ui, "group", or_dash(&hit.group));
    });
}

/// Shows a shape other than a triangle; of a solid, the operand that is hit and the tree of operations.
fn shape_ui(ui: &mut egui::Ui, hit: &HitReport) {
    section_ui(ui, "Shape", |ui| {
        row_ui(ui, "shape", hit.shape);
        row_ui(ui, "primitive", format!("{} (0-based)", hit.primitive));
        parameters_ui(ui, hit.parameters.as_ref());
        if let Some(SolidReport { operand, .. }) = &hit.solid {
            let OperandName { index, shape } = operand.name;
            row_ui(ui, "operand", format!("{index} (0-based), {shape}"));
            let normal = if operand.is_subtracted {
                "reversed: the operand is subtracted"
            } else {
                "as the operand's"
            };
            row_ui(ui, "normal", normal);
            parameters_ui(ui, Some(&operand.parameters));
        }
    });
    if let Some(solid) = &hit.solid {
        ui.label(RichText::new("Solid").strong())
            .on_hover_text("The operations, and the intervals of t inside each part");
        rows_ui(ui, |ui| {
            solid.lines.iter().for_each(|line| tree_line_ui(ui, line));
        });
    }
}

/// Shows a line of a tree. Where it wraps, it keeps its indent.
fn tree_line_ui(ui: &mut egui::Ui, line: &str) {
    /// Width of a character relative to the size of the monospaced font.
    const ADVANCE: f32 = 0.6;
    const SIZE: f32 = 10.5;
    let text = line.trim_start();
    let indent = (line.len() - text.len()) as f32;
    ui.horizontal_top(|ui| {
        ui.add_space(ADVANCE * SIZE * indent);
        let text = RichText::new(text).monospace().size(SIZE);
        ui.add(egui::Label::new(text).wrap());
    });
}

/// The name of a parameter with its symbol, unless it ends with that.
fn parameter_label(name: &str, symbol: &str) -> String {
    let words = name.replace('_', " ");
    if words.split(' ').next_back() == Some(symbol) {
        words
    } else {
        format!("{words} {symbol}")
    }
}

fn parameters_ui(ui: &mut egui::Ui, parameters: Option<&Parameters>) {
    for parameter in parameters.iter().flat_map(|parameters| &parameters.0) {
        let ParameterReport { name, symbol, .. } = parameter;
        let name = parameter_label(name, symbol);
        let value = match parameter.value {
            ParameterValue::Point(p) => lines(p),
            ParameterValue::Vector(v) => lines(v),
            ParameterValue::Number(x) => number(x),
            ParameterValue::Flag(_) => parameter.value.to_string(),
        };
        row_ui(ui, &name, value);
    }
}

/// Shows the derivation of t.
fn formula_ui(ui: &mut egui::Ui, hit: &HitReport) {
    CollapsingHeader::new("Formula")
        .id_salt("formula")
        .show_unindented(ui, |ui| {
            let text = hit.formula.join("\n");
            let copy = ui.small_button("Copy formula");
            if copy.on_hover_text("Copy these lines as text").clicked() {
                ui.ctx().copy_text(text.clone());
            }
            let text = RichText::new(text).monospace().size(10.5);
            ui.add(egui::Label::new(text).wrap());
        });
    ui.add_space(4.0);
}

/// Shows the marked crossing of the ray, and a slider over all of them. Returns the crossing that the user selects.
fn crossings_ui(
    ui: &mut egui::Ui,
    crossings: &[CrossingReport],
    marked: Option<usize>,
) -> Option<usize> {
    let marked = marked?;
    let crossing = crossings.get(marked)?;
    let count = crossings.len();
    let mut selected = marked;
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        let name = ui.label(RichText::new("Crossings").strong());
        if count > 1 {
            let slider = number_slider(&mut selected, 0..=count - 1).show_value(false);
            ui.add(slider).labelled_by(name.id);
            // At the slider it would cover the rows below while the user drags.
            name.on_hover_text(format!(
                "The slider moves the mark along the ray ({} and {})",
                keys_of("previous-crossing", ui.ctx()),
                keys_of("next-crossing", ui.ctx())
            ));
        }
    });
    rows_ui(ui, |ui| {
        row_ui(ui, "number", format!("{} of {count}", marked + 1));
        row_ui(ui, "t", number(crossing.t));
        let CrossingReport {
            shape,
            primitive,
            side,
            ..
        } = crossing;
        let also = also(&crossing.also);
        row_ui(
            ui,
            "primitive",
            format!("{shape} {primitive}, {side}{also}"),
        );
        if let Some(OperandName { index, shape }) = crossing.operand {
            row_ui(ui, "operand", format!("{index}, {shape}"));
        }
        row_ui(ui, "position", lines(crossing.position));
    });
    (selected != marked).then_some(selected)
}

/// Shows the triangle and its face in the file.
fn triangle_ui(ui: &mut egui::Ui, pick: &PickView<'_>, hit: &TriangleReport) {
    section_ui(ui, "Triangle", |ui| {
        row_ui(ui, "triangle", format!("{} (0-based)", hit.index));
        row_ui(ui, "face", format!("{} (0-based)", hit.face));
        if let Some(line) = hit.line {
            row_ui(ui, "line", line);
        }
        match pick.face {
            Some(FaceInFile::Found { statement, .. }) => row_ui(ui, "statement", statement),
            Some(FaceInFile::Unknown(why)) => row_ui(ui, "statement", why),
            None if pick.is_reading_face => row_ui(ui, "statement", "…"),
            None => {}
        }
        for (k, (name, vertex)) in ["A", "B", "C"].into_iter().zip(hit.vertices).enumerate() {
            let index = pick.face.and_then(|face| face.vertex(k));
            let name = index.map_or(name.to_owned(), |index| format!("{name} = v {index}"));
            row_ui(ui, &name, lines(vertex));
        }
    });
}

/// The text about the other primitives that a ray hits at the same t. It names only the first ones, because a bad mesh
/// may have a million of them.
fn also(primitives: &[u32]) -> String {
    const MOST: usize = 8;
    let (first, rest) = primitives.split_at(primitives.len().min(MOST));
    let names = first.iter().map(|primitive| format!(", also {primitive}"));
    let mut text: String = names.collect();
    if !rest.is_empty() {
        text += &format!(" and {} more", rest.len());
    }
    text
}

fn or_dash(name: &str) -> &str {
    if name.is_empty() { "–" } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_primitives_at_the_same_place_the_first_are_named() {
        assert_eq!(also(&[]), "");
        assert_eq!(also(&[3, 7]), ", also 3, also 7");
        let many: Vec<u32> = (0..1000).collect();
        assert!(also(&many).ends_with(", also 7 and 992 more"));
    }

    #[test]
    fn a_symbol_is_not_repeated() {
        let labels = [("axis_u", "u"), ("a", "a"), ("half_size", "s")];
        let labels = labels.map(|(name, symbol)| parameter_label(name, symbol));
        assert_eq!(labels, ["axis u", "a", "half size s"]);
    }
}

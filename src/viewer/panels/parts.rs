//! The Parts tab: groups, materials or shapes of the scene, each with a check box that shows and hides it.

use crate::command::Commands;
use crate::parts::{Grouping, PartList, Parts};
use egui::{Align, Checkbox, Color32, Layout, RichText, ScrollArea, Sense, TextEdit, vec2};
use hitscope_core::counts::counted;

/// Height of the lowest list in points.
const MIN_HEIGHT: f32 = 120.0;

/// Shows the tab; `picked` is the part of the picked primitive.
pub fn parts_ui(
    ui: &mut egui::Ui,
    parts: &mut Parts,
    list: &PartList,
    picked: Option<usize>,
    commands: &Commands,
) {
    ui.horizontal(|ui| {
        ui.label("By");
        for grouping in Grouping::ALL {
            let is_chosen = parts.grouping == grouping;
            if ui.selectable_label(is_chosen, grouping.title()).clicked() {
                parts.group_by(grouping);
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for name in ["show-all-parts", "invert-parts", "hide-part", "only-part"] {
            commands.small_button_ui(ui, name);
        }
    });
    ui.add(TextEdit::singleline(&mut parts.filter).hint_text("Search"))
        .accessible_name("Search for a part");
    let filter = parts.filter.to_lowercase();
    let is_listed = |number: &usize| list.parts[*number].name.to_lowercase().contains(&filter);
    let listed: Vec<usize> = (0..list.parts.len()).filter(is_listed).collect();
    ui.label(RichText::new(counted(listed.len(), "part")).weak());
    // With a margin, so that the tab itself doesn't scroll.
    let height = ui.clip_rect().bottom() - ui.cursor().top() - 2.0 * ui.spacing().item_spacing.y;
    let row_height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("parts")
        .max_height(height.max(MIN_HEIGHT))
        .auto_shrink([false, true])
        .show_rows(ui, row_height, listed.len(), |ui, rows| {
            for &number in &listed[rows] {
                row_ui(ui, parts, list, number, picked == Some(number));
            }
        });
}

fn row_ui(ui: &mut egui::Ui, parts: &mut Parts, list: &PartList, number: usize, is_picked: bool) {
    let part = &list.parts[number];
    ui.horizontal(|ui| {
        let state = parts.is_shown(number);
        let mut is_shown = state.unwrap_or_default();
        let name = RichText::new(&part.name);
        let name = if is_picked { name.strong() } else { name };
        let check_box = Checkbox::new(&mut is_shown, name).indeterminate(state.is_none());
        let response = ui
            .add(check_box)
            .on_hover_text("Shows or hides the part; with Alt, shows it alone");
        if response.clicked() && ui.input(|input| input.modifiers.alt) {
            parts.show_only(number);
        } else if response.changed() {
            parts.show(number, is_shown);
        }
        if let Some([r, g, b]) = part.colour {
            let (rect, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            let stroke = ui.visuals().widgets.noninteractive.bg_stroke;
            let colour = Color32::from_rgb(r, g, b);
            ui.painter()
                .rect(rect, 2.0, colour, stroke, egui::StrokeKind::Inside);
        }
        if is_picked {
            ui.label(RichText::new("picked").weak());
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let only = ui.small_button("Only");
            let only = only.accessible_name(format!("Show only {}", part.name));
            if only.on_hover_text("Shows the part alone").clicked() {
                parts.show_only(number);
            }
            ui.label(RichText::new(part.count.to_string()).weak())
                .on_hover_text("The number of its triangles or other shapes");
        });
    });
}

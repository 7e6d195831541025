//! The Parts tab: groups, materials or shapes of the scene, each with an eye button and a colour.

use super::eye::eye_ui;
use crate::command::Commands;
use crate::parts::{Grouping, Part, PartList, Parts};
use crate::text_field::text_field;
use egui::{Align, Layout, RichText, ScrollArea};
use hitscope_core::counts::counted;

/// Height of the lowest list in points.
const MIN_HEIGHT: f32 = 120.0;
/// sRGB of the colour button of a part without a custom colour or a single material colour.
const VARIOUS: [u8; 3] = [160; 3];

/// Shows the tab; `picked` is the picked primitive.
pub fn parts_ui(ui: &mut egui::Ui, parts: &mut Parts, picked: Option<u32>, commands: &Commands) {
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
    ui.add(text_field(&mut parts.filter).hint_text("Search"))
        .accessible_name("Search for a part");
    let Some(list) = parts.list() else {
        let text = if parts.has_failed() {
            "The parts can't be listed; see the terminal for details."
        } else {
            "Listing the parts…"
        };
        ui.label(RichText::new(text).weak());
        return;
    };
    let picked = picked.map(|primitive| list.part_of(primitive));
    let matches = parts.matching(ui.ctx());
    ui.label(RichText::new(counted(matches.count(), "part")).weak());
    // With a margin, so that the tab itself doesn't scroll.
    let height = ui.clip_rect().bottom() - ui.cursor().top() - 2.0 * ui.spacing().item_spacing.y;
    let row_height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("parts")
        .max_height(height.max(MIN_HEIGHT))
        .auto_shrink([false, true])
        .show_rows(ui, row_height, matches.count(), |ui, rows| {
            for number in rows.map(|row| matches.part(row)) {
                row_ui(ui, parts, &list, number, picked == Some(number));
            }
        });
}

fn row_ui(ui: &mut egui::Ui, parts: &mut Parts, list: &PartList, number: usize, is_picked: bool) {
    let part = &list.parts[number];
    let name = part.key.name.as_str();
    ui.push_id(number, |ui| {
        ui.horizontal(|ui| {
            let state = parts.is_shown(number);
            let eye = eye_ui(ui, state, &format!("Show {name}"))
                .on_hover_text("Click shows or hides the part; Alt+click shows only this part");
            if eye.clicked() && ui.input(|input| input.modifiers.alt) {
                parts.show_only(number);
            } else if eye.clicked() {
                parts.show(number, state != Some(true));
            }
            colour_ui(ui, parts, part, number);
            let text = RichText::new(name);
            ui.label(if is_picked { text.strong() } else { text });
            if is_picked {
                ui.label(RichText::new("picked").weak());
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let only = ui.small_button("Only");
                let only = only.accessible_name(format!("Show only {name}"));
                if only.on_hover_text("Shows only this part").clicked() {
                    parts.show_only(number);
                }
                ui.label(RichText::new(part.count.to_string()).weak())
                    .on_hover_text("Number of triangles or other shapes");
            });
        });
    });
}

/// The colour button of a part.
fn colour_ui(ui: &mut egui::Ui, parts: &mut Parts, part: &Part, number: usize) {
    let name = part.key.name.as_str();
    let own = parts.own_colour(number);
    let shown = own.or(part.colour).unwrap_or(VARIOUS);
    let mut srgb = shown;
    let button = ui
        .color_edit_button_srgb(&mut srgb)
        .accessible_name(format!("Colour of {name}"))
        .on_hover_text("Sets a custom colour of the part in the view Shaded");
    // The picker also reports changes by rounding.
    if button.changed() && srgb != shown {
        parts.colour(number, Some(srgb));
    }
    if own.is_some() {
        let reset = ui.small_button("Reset");
        let reset = reset.accessible_name(format!("Reset the colour of {name}"));
        let reset = reset.on_hover_text("Removes the custom colour");
        if reset.clicked() {
            parts.colour(number, None);
        }
    }
}

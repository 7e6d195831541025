//! The section *Overlay* of the Display tab: a row of controls per overlay that has a switch.

use crate::command::Commands;
use crate::number_field::{finite, number_field};
use crate::overlay::spec::{OptionKind, OverlayOption};
use crate::overlay::state::{OPACITIES, WIDTHS_PX};
use crate::overlay::{OverlaySpec, OverlayState, Overlays, switches};
use egui::{DragValue, Response, RichText};

/// Shows the section.
pub fn overlay_ui(ui: &mut egui::Ui, overlays: &mut Overlays, commands: &Commands) {
    ui.label(RichText::new("Overlay").strong());
    let grid = egui::Grid::new("overlays").num_columns(4);
    grid.show(ui, |ui| {
        for overlay in switches() {
            row_ui(ui, overlay, overlays.state_mut(overlay), commands);
            ui.end_row();
        }
    });
}

fn row_ui(ui: &mut egui::Ui, overlay: &OverlaySpec, state: &mut OverlayState, commands: &Commands) {
    if let Some(switch) = commands.overlay(overlay) {
        commands.switch_ui(ui, switch);
    }
    let named = |response: Response, what: &str| named(response, overlay, what);
    if overlay.has_colour() {
        named(colour_ui(ui, state), "colour and opacity");
    } else {
        named(opacity_ui(ui, &mut state.opacity), "opacity");
    }
    let width = number_field(&mut state.width_px)
        .range(WIDTHS_PX)
        .speed(0.02)
        .max_decimals(1)
        .suffix(" px");
    named(ui.add(width), "width");
    ui.horizontal(|ui| {
        for option in overlay.options {
            option_ui(ui, overlay, option, state);
        }
    });
}

/// Gives a control of an overlay a name for assistive technology and a tooltip.
fn named(response: Response, overlay: &OverlaySpec, what: &str) {
    let name = format!("{}: {what}", overlay.title);
    let id = response.id;
    let response = response.on_hover_text(&name);
    response
        .ctx
        .accesskit_node_builder(id, |node| node.set_label(name));
}

fn colour_ui(ui: &mut egui::Ui, state: &mut OverlayState) -> Response {
    let [r, g, b] = state.colour;
    let mut colour = [r, g, b, (255.0 * state.opacity).round() as u8];
    let response = ui.color_edit_button_srgba_unmultiplied(&mut colour);
    if response.changed() {
        let [r, g, b, alpha] = colour;
        state.opacity = f32::from(alpha) / 255.0;
        // The colour of a transparent pixel is lost.
        if alpha > 0 {
            state.colour = [r, g, b];
        }
    }
    response
}

fn opacity_ui(ui: &mut egui::Ui, opacity: &mut f32) -> Response {
    let range = OPACITIES;
    ui.add(percent(opacity).range(range).speed(0.005))
}

fn option_ui(
    ui: &mut egui::Ui,
    overlay: &OverlaySpec,
    option: &OverlayOption,
    state: &mut OverlayState,
) {
    match &option.kind {
        OptionKind::Switch => {
            let mut is_set = state.is_set(option);
            if ui.checkbox(&mut is_set, option.title).changed() {
                state.set(option, f32::from(u8::from(is_set)));
            }
        }
        OptionKind::Fraction(range) => {
            let mut value = state.value(option);
            // A drag across the picture changes a small value little.
            let speed = f64::from(0.02 * value.max(*range.start()));
            let control = percent(&mut value)
                .range(range.clone())
                .speed(speed)
                .prefix(format!("{} ", option.title));
            let response = ui.add(control);
            if response.changed() {
                state.set(option, value);
            }
            named(response, overlay, option.title);
        }
    }
}

/// A number that is shown in percent.
fn percent(value: &mut f32) -> DragValue<'_> {
    number_field(value)
        .custom_formatter(|part, _| format!("{:.1} %", 100.0 * part))
        .custom_parser(|text| {
            let percent = finite::<f32>(text.trim_end_matches(['%', ' ']))?;
            Some(percent / 100.0)
        })
}

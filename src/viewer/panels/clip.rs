//! The section *Clip* of the Display tab.

use crate::clip_choice::{ClipChoice, ClipShape, Extent};
use crate::command::Commands;
use crate::number_field::{number_field, number_slider};
use egui::{RichText, SliderClamping};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Shows the section, for a scene with this box around it. If new numbers give no clip, the old ones stay.
pub fn clip_ui(ui: &mut egui::Ui, clip: &mut ClipChoice, extent: &Extent, commands: &Commands) {
    ui.label(RichText::new("Clip").strong());
    ui.horizontal_wrapped(|ui| {
        for name in ["clip-plane", "clip-box"] {
            commands.button_ui(ui, name);
        }
        commands.small_button_ui(ui, "clip-at-pick");
    });
    let size = (extent.max - extent.min).max_element();
    let before = clip.clone();
    match clip.shape {
        ClipShape::None => {}
        ClipShape::Plane => plane_ui(ui, clip, extent, size, commands),
        ClipShape::Box => box_ui(ui, clip, size, commands),
    }
    if clip.clip().is_err() {
        *clip = before;
    }
}

fn plane_ui(
    ui: &mut egui::Ui,
    clip: &mut ClipChoice,
    extent: &Extent,
    size: f64,
    commands: &Commands,
) {
    ui.horizontal_wrapped(|ui| {
        for name in ["clip-x", "clip-y", "clip-z", "clip-view", "clip-flip"] {
            commands.small_button_ui(ui, name);
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label("Offset");
        let offsets = clip.offsets(extent);
        // A number that is typed into the field may lie outside of the scene.
        let slider = number_slider(&mut clip.offset, offsets)
            .clamping(SliderClamping::Never)
            .show_value(false);
        ui.add(slider).labelled_by(label.id).on_hover_text(
            "Normal times position of the plane's points, in the file's coordinates",
        );
        ui.add(number_field(&mut clip.offset).speed(0.002 * size))
            .accessible_name("Exact offset");
    });
    ui.horizontal(|ui| {
        ui.label("Normal");
        let mut normal = clip.normal;
        for (axis, name) in AXES.into_iter().enumerate() {
            let number = number_field(&mut normal[axis])
                .speed(0.01)
                // A number that is being typed may begin with zero.
                .update_while_editing(false);
            ui.add(number).accessible_name(format!("Normal: {name}"));
        }
        if normal != clip.normal {
            clip.turn(normal, extent);
        }
    });
}

fn box_ui(ui: &mut egui::Ui, clip: &mut ClipChoice, size: f64, commands: &Commands) {
    let Some(cell) = &mut clip.cell else { return };
    let mut edited = *cell;
    egui::Grid::new("clip box").num_columns(4).show(ui, |ui| {
        for (title, corner) in [("From", &mut edited.min), ("To", &mut edited.max)] {
            ui.label(title);
            for (axis, name) in AXES.into_iter().enumerate() {
                let number = number_field(&mut corner[axis])
                    .speed(0.002 * size)
                    // The box may be empty while a number is being typed.
                    .update_while_editing(false)
                    .prefix(format!("{name} "));
                ui.add(number).accessible_name(format!("{title}: {name}"));
            }
            ui.end_row();
        }
    });
    *cell = edited;
    commands.small_button_ui(ui, "clip-fit");
}

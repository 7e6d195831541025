//! The section *Clip* of the Display tab.

use crate::clip_choice::{ClipChoice, ClipShape, Extent};
use crate::command::Commands;
use egui::{DragValue, RichText, Slider, SliderClamping};
use glam::DVec3;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Shows the section, for a scene with this box around it.
pub fn clip_ui(ui: &mut egui::Ui, clip: &mut ClipChoice, extent: &Extent, commands: &Commands) {
    ui.label(RichText::new("Clip").strong());
    ui.horizontal_wrapped(|ui| {
        for name in ["clip-plane", "clip-box"] {
            commands.button_ui(ui, name);
        }
        commands.small_button_ui(ui, "clip-at-pick");
    });
    let size = (extent.max - extent.min).max_element();
    match clip.shape {
        ClipShape::None => {}
        ClipShape::Plane => plane_ui(ui, clip, extent, size, commands),
        ClipShape::Box => box_ui(ui, clip, size, commands),
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
        // A number that is typed in may lie outside of the scene.
        let offsets = clip.offsets(extent);
        let slider = Slider::new(&mut clip.offset, offsets)
            .clamping(SliderClamping::Never)
            .max_decimals(6)
            .step_by(0.0);
        ui.add(slider).labelled_by(label.id).on_hover_text(
            "Normal times position of the plane's points, in the file's coordinates",
        );
        ui.add(DragValue::new(&mut clip.offset).speed(0.002 * size))
            .accessible_name("Exact offset");
    });
    ui.horizontal(|ui| {
        ui.label("Normal");
        let mut normal = clip.normal;
        for (axis, name) in AXES.into_iter().enumerate() {
            let number = DragValue::new(&mut normal[axis]).speed(0.01);
            ui.add(number).accessible_name(format!("Normal: {name}"));
        }
        if normal != clip.normal && normal != DVec3::ZERO {
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
                let number = DragValue::new(&mut corner[axis])
                    .speed(0.002 * size)
                    .prefix(format!("{name} "));
                ui.add(number).accessible_name(format!("{title}: {name}"));
            }
            ui.end_row();
        }
    });
    // An edit that would leave nothing of the box is ignored.
    if edited.min.cmplt(edited.max).all() {
        *cell = edited;
    }
    commands.small_button_ui(ui, "clip-fit");
}

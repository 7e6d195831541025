//! The quality levels in the Display tab, with their speed and accuracy in this scene.

use super::row_ui;
use super::trade::mrays_per_s;
use crate::command::{Commands, QUALITIES};
use crate::quality::{MovingResolution, Quality};
use crate::settings::Settings;
use crate::trade::Trade;
use egui::{CollapsingHeader, ComboBox, RichText};
use hitscope_lab::measure::statistics::{rate_text, short};

/// The meaning of the figures.
const FIGURES_ABOUT: &str = "\
The speed is the mean of camera, bounce and random rays, as in the Trade tab.
A number in parentheses bounds the rate with 95 % confidence where no decision was wrong.";

/// Shows the sets. Returns whether the user wants the kernels to be measured.
pub fn quality_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    trade: Option<&Trade>,
    commands: &Commands,
) -> bool {
    let chosen = Quality::of(settings);
    let custom = ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Quality").strong());
        for quality in commands.at(QUALITIES) {
            commands.choice_ui(ui, quality);
        }
        ui.selectable_label(chosen.is_none(), "Custom")
            .on_hover_text(
                "Shows or hides the details. Selected while the settings match none of the levels",
            )
            .clicked()
    });
    let id = ui.scope_id().with("details are open");
    let was_open = ui.data(|data| data.get_temp(id)).unwrap_or(false);
    let details = CollapsingHeader::new("Details")
        .id_salt("quality")
        .open(custom.inner.then_some(!was_open))
        .show(ui, |ui| details_ui(ui, settings));
    ui.data_mut(|data| data.insert_temp(id, details.openness > 0.0));
    match trade.and_then(|trade| figures(settings, trade)) {
        Some(figures) => {
            ui.label(figures).on_hover_text(FIGURES_ABOUT);
            false
        }
        None => ui
            .button("Measure speed and accuracy")
            .on_hover_text("Measures all kernels in this scene and shows them in the Trade tab")
            .clicked(),
    }
}

/// Shows the settings that a level determines.
fn details_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    let depth = settings.depth_limit();
    let depth = depth.map_or("none".to_owned(), |limit| limit.to_string());
    for (name, value) in [
        ("Kernel", settings.kernel().info.short_name().to_owned()),
        ("Samples", settings.samples.to_string()),
        ("Spawn policy", settings.spawn().title.to_owned()),
        ("Depth limit", depth),
    ] {
        row_ui(ui, name, value);
    }
    ui.horizontal(|ui| {
        let label = ui.label("Resolution while moving");
        ComboBox::from_id_salt("moving")
            .selected_text(settings.moving.title())
            .show_ui(ui, |ui| {
                for resolution in MovingResolution::ALL {
                    ui.selectable_value(&mut settings.moving, resolution, resolution.title())
                        .on_hover_text(resolution.words());
                }
            })
            .response
            .labelled_by(label.id);
    });
}

/// The measured speed and accuracy of the kernel.
fn figures(settings: &Settings, trade: &Trade) -> Option<String> {
    let rows = trade.rows();
    let kernel = settings.kernel();
    let row = rows.iter().find(|row| trade.is_used(kernel, row))?;
    let speed = short(mrays_per_s(row, &rows)?);
    let wrong = rate_text(row.wrong_count(), row.n);
    Some(format!(
        "In this scene: {speed} million rays per second on one thread; wrong decisions per million rays: {wrong}"
    ))
}

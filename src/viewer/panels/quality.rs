//! The quality in the Display tab: the sets of settings, with their speed and accuracy in this scene.

use crate::command::{Commands, QUALITIES};
use crate::numbers::significant;
use crate::quality::Quality;
use crate::settings::Settings;
use crate::trade::Trade;
use egui::RichText;

/// Shows the sets. Returns whether the user wants the kernels to be measured.
pub fn quality_ui(
    ui: &mut egui::Ui,
    settings: &Settings,
    trade: Option<&Trade>,
    commands: &Commands,
) -> bool {
    let chosen = Quality::of(settings);
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Quality").strong());
        for quality in commands.at(QUALITIES) {
            commands.choice_ui(ui, quality);
        }
        if chosen.is_none() {
            ui.label("Custom")
                .on_hover_text("The settings match none of these");
        }
    });
    match trade.and_then(|trade| figures(settings, trade)) {
        Some(figures) => {
            ui.label(figures);
            false
        }
        None => ui
            .small_button("Measure speed and accuracy")
            .on_hover_text("Measures all kernels in this scene and shows them in the Trade tab")
            .clicked(),
    }
}

/// The measured speed and accuracy of the kernel.
fn figures(settings: &Settings, trade: &Trade) -> Option<String> {
    let rows = trade.rows();
    let kernel = settings.kernel();
    let row = rows.iter().find(|row| trade.is_used(kernel, row))?;
    let speed = significant(row.speed.mrays_per_s.primary, 3);
    let wrong = significant(row.wrong_per_million, 2);
    Some(format!(
        "Here {speed} Mrays/s on one thread, {wrong} wrong decisions per million rays"
    ))
}

//! The section *Colours* of the Display tab: colour map, scale and legend, tint of back faces, background.

use crate::colour_choice::{Background, ColourChoice};
use crate::command::Commands;
use crate::number_field::number_field;
use crate::settings::Settings;
use egui::{Color32, ComboBox, Rect, RichText, Sense, pos2, vec2};
use hitscope_core::colour::{COLOUR_MAPS, ColourMap, ColourScale, ScaleError};
use hitscope_core::integrator::{Integrator, Setting};
use hitscope_core::tone::Display;

/// Shows the section; `scale` is that of the picture, if it shows numbers.
pub fn colours_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    scale: Option<&Result<ColourScale, ScaleError>>,
    commands: &Commands,
) {
    let view = settings.view();
    let colours = &mut settings.colours;
    ui.label(RichText::new("Colours").strong());
    if view.needs.uses(Setting::Scale) {
        map_ui(ui, colours);
        scale_ui(ui, view, colours, scale, commands);
    }
    if scale.is_some() {
        commands.check_box_ui(ui, "legend");
    }
    if view.needs.uses(Setting::BackFaces) {
        ui.horizontal(|ui| {
            commands.check_box_ui(ui, "tint-back-faces");
            ui.color_edit_button_srgb(&mut colours.tint)
                .accessible_name("Colour of back faces");
        });
    }
    ui.horizontal(|ui| {
        let label = ui.label("Background");
        ComboBox::from_id_salt("background")
            .selected_text(colours.background.title())
            .show_ui(ui, |ui| {
                for background in Background::ALL {
                    let title = background.title();
                    ui.selectable_value(&mut colours.background, background, title);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text("Views that compare kernels always have a dark background. Views of light show the environment, if there is one");
    });
}

fn map_ui(ui: &mut egui::Ui, colours: &mut ColourChoice) {
    const OWN: &str = "Of the view";
    ui.horizontal(|ui| {
        let label = ui.label("Colour map");
        let chosen = colours.map();
        let mut name = chosen.map_or("", |map| map.name);
        ComboBox::from_id_salt("colour map")
            .selected_text(chosen.map_or(OWN, |map| map.title))
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut name, "", OWN);
                for map in COLOUR_MAPS {
                    ui.horizontal(|ui| {
                        swatch_ui(ui, map);
                        ui.selectable_value(&mut name, map.name, map.title)
                            .on_hover_text(map.about);
                    });
                }
            })
            .response
            .labelled_by(label.id);
        if name != colours.map {
            name.clone_into(&mut colours.map);
        }
        if let Some(map) = chosen {
            swatch_ui(ui, map);
        }
    });
}

/// Draws the colours of a map.
fn swatch_ui(ui: &mut egui::Ui, map: &ColourMap) {
    const STEPS: u8 = 24;
    let (rect, _) = ui.allocate_exact_size(vec2(48.0, 12.0), Sense::hover());
    let step = rect.width() / f32::from(STEPS);
    for k in 0..STEPS {
        let part = (f32::from(k) + 0.5) / f32::from(STEPS);
        let [r, g, b, _] = Display::default().encode(map.colour(part));
        let corner = pos2(rect.left() + f32::from(k) * step, rect.top());
        let strip = Rect::from_min_size(corner, vec2(step + 0.5, rect.height()));
        ui.painter()
            .rect_filled(strip, 0.0, Color32::from_rgb(r, g, b));
    }
}

fn scale_ui(
    ui: &mut egui::Ui,
    view: &Integrator,
    colours: &mut ColourChoice,
    scale: Option<&Result<ColourScale, ScaleError>>,
    commands: &Commands,
) {
    let mut choice = colours.scale_of(view);
    let current = scale.and_then(|scale| scale.as_ref().ok());
    ui.horizontal(|ui| {
        let mut is_own = choice.range.is_some();
        ui.checkbox(&mut is_own, "Own range").on_hover_text(
            "If off, the view chooses the numbers with the first and the last colour",
        );
        let of_view = || current.map_or([0.0, 1.0], ColourScale::range);
        choice.range = is_own.then(|| choice.range.unwrap_or_else(of_view));
        if let Some(range) = &mut choice.range {
            let speed = 0.005 * (range[1] - range[0]).abs().max(f64::MIN_POSITIVE);
            for (number, name) in range.iter_mut().zip(["First number", "Last number"]) {
                let number = number_field(number).speed(speed).max_decimals(12);
                ui.add(number).accessible_name(name);
            }
        }
        commands.small_button_ui(ui, "fit-range");
    });
    if let Some(is_current) = current.map(ColourScale::is_logarithmic) {
        let mut is_logarithmic = choice.is_logarithmic.unwrap_or(is_current);
        if ui.checkbox(&mut is_logarithmic, "Logarithmic").changed() {
            choice.is_logarithmic = Some(is_logarithmic);
        }
    }
    if let Some(Err(error)) = scale {
        ui.colored_label(ui.visuals().error_fg_color, error.to_string());
        if ui.button("Reset scale").clicked() {
            choice = Default::default();
        }
    }
    if choice != colours.scale_of(view) {
        *colours.scale_mut(view) = choice;
    }
}

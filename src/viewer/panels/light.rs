//! The options of views that need lights, in the Display tab.

use super::view::legend_ui;
use crate::bindings::Action;
use crate::look::{TONE_CURVES, noise_legend};
use crate::settings::Settings;
use crate::tracer::LEAST_SAMPLES;
use egui::{DragValue, Slider};
use hitscope_core::spawn::SPAWN_POLICIES;
use std::ops::RangeInclusive;

/// Distances of ambient occlusion, in radii of the scene.
pub const AO_DISTANCES: RangeInclusive<f32> = 0.001..=10.0;
/// Limits on the surfaces of a path.
pub const DEPTH_LIMITS: RangeInclusive<u32> = 1..=1000;
/// Factors of the light from far away.
pub const BRIGHTNESSES: RangeInclusive<f32> = 0.0..=100.0;
/// Rotations of the light from far away, in degrees.
pub const ROTATIONS: RangeInclusive<f32> = 0.0..=360.0;
/// Exposures in stops.
pub const EXPOSURES: RangeInclusive<f32> = -10.0..=10.0;
/// Limits on the time of tracing, in seconds.
pub const TIME_LIMITS_S: RangeInclusive<f32> = 1.0..=86_400.0;
/// Limits on the noise, in percent of white.
pub const NOISE_LIMITS: RangeInclusive<f32> = 0.001..=100.0;

/// Shows the options that the chosen view uses; nothing if it needs no lights.
pub(super) fn light_ui(ui: &mut egui::Ui, settings: &mut Settings, actions: &mut Vec<Action>) {
    let needs = settings.view().needs;
    if !needs.lights {
        return;
    }
    if needs.ao_distance {
        ui.horizontal(|ui| {
            let label = ui.label("Distance");
            let slider = Slider::new(&mut settings.ao_distance, AO_DISTANCES)
                .logarithmic(true)
                .suffix(" radii");
            let slider = ui.add(slider).labelled_by(label.id);
            slider.on_hover_text(
                "Surfaces nearer than this occlude, in radii of the scene's bounding sphere",
            );
        });
    }
    if settings.shows_light() {
        environment_ui(ui, settings, actions);
        exposure_ui(ui, settings);
    }
    if needs.depth_limit {
        ui.horizontal(|ui| {
            ui.checkbox(&mut settings.has_depth_limit, "Depth limit")
                .on_hover_text("The most surfaces on a path. If off, paths end at random.");
            let limit = DragValue::new(&mut settings.depth_limit)
                .range(DEPTH_LIMITS)
                .suffix(" surfaces");
            ui.add_enabled(settings.has_depth_limit, limit);
        });
    }
    spawn_ui(ui, settings);
    noise_ui(ui, settings);
}

fn environment_ui(ui: &mut egui::Ui, settings: &mut Settings, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let label = ui.label("Environment");
        ui.color_edit_button_srgb(&mut settings.environment_colour)
            .labelled_by(label.id)
            .on_hover_text("Colour of the light from far away");
        let open = ui.button("Open environment…");
        if open
            .on_hover_text("Light the scene by an HDR or EXR picture; or drop one on the window")
            .clicked()
        {
            actions.push(Action::OpenEnvironment);
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label("Brightness");
        let slider = Slider::new(&mut settings.environment_brightness, BRIGHTNESSES)
            .logarithmic(true)
            .smallest_positive(0.01);
        let slider = ui.add(slider).labelled_by(label.id);
        slider.on_hover_text("Factor of the light from far away");
    });
    ui.horizontal(|ui| {
        let label = ui.label("Rotation");
        let slider = Slider::new(&mut settings.environment_degrees, ROTATIONS)
            .suffix("°")
            .fixed_decimals(0);
        let slider = ui.add(slider).labelled_by(label.id);
        slider.on_hover_text(
            "Rotation of the environment about the up axis, in degrees (Ctrl+drag in the picture)",
        );
    });
}

fn exposure_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let label = ui.label("Exposure");
        let slider = Slider::new(&mut settings.exposure_stops, EXPOSURES)
            .suffix(" stops")
            .fixed_decimals(1);
        let slider = ui.add(slider).labelled_by(label.id);
        slider.on_hover_text("Each stop doubles the brightness of the picture");
    });
    ui.horizontal(|ui| {
        let label = ui.label("Tone curve");
        let chosen = settings.tone_curve();
        egui::ComboBox::from_id_salt("tone curve")
            .selected_text(chosen.title)
            .show_ui(ui, |ui| {
                for curve in TONE_CURVES {
                    let name = curve.name.to_owned();
                    ui.selectable_value(&mut settings.tone_curve, name, curve.title)
                        .on_hover_text(curve.summary);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(chosen.summary);
    });
}

fn spawn_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let label = ui.label("Spawn policy");
        let chosen = settings.spawn();
        egui::ComboBox::from_id_salt("spawn")
            .selected_text(chosen.title)
            .show_ui(ui, |ui| {
                for policy in SPAWN_POLICIES {
                    let name = policy.name.to_owned();
                    ui.selectable_value(&mut settings.spawn, name, policy.title)
                        .on_hover_text(policy.summary);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(chosen.summary);
    });
}

/// Shows the limits that end refinement, and the switch of the noise's picture with its legend.
fn noise_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_time_limit, "Stop after")
            .on_hover_text("Ends refinement after so many seconds of tracing");
        let secs = DragValue::new(&mut settings.time_limit_s)
            .range(TIME_LIMITS_S)
            .suffix(" s");
        ui.add_enabled(settings.has_time_limit, secs);
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_noise_limit, "Stop at noise")
            .on_hover_text(format!(
                "Ends refinement when the mean standard error of the pixels is at most this, in percent of white; \
                 from {LEAST_SAMPLES} samples per pixel on"
            ));
        let percent = DragValue::new(&mut settings.noise_limit_percent)
            .range(NOISE_LIMITS)
            .speed(0.05)
            .max_decimals(3)
            .suffix(" %");
        ui.add_enabled(settings.has_noise_limit, percent);
    });
    ui.checkbox(&mut settings.shows_noise, "Noise")
        .on_hover_text("Shows the standard error of each pixel, in percent of white");
    if settings.shows_noise {
        legend_ui(ui, &noise_legend());
    }
}

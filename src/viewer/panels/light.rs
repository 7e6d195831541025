//! The options of views that need lights, in the Display tab.

use super::view::legend_ui;
use crate::command::Commands;
use crate::look::noise_legend;
use crate::number_field::{number_field, number_slider};
use crate::settings::{EnvironmentSource, Settings};
use crate::tracer::LEAST_SAMPLES;
use egui::SliderClamping;
use hitscope_core::brightness::EXPOSURES;
use hitscope_core::integrator::Setting;
use hitscope_core::spawn::{SPAWN_POLICIES, SpawnPolicy};
use hitscope_core::terminator::TERMINATOR_REPAIRS;
use hitscope_core::tone::TONE_CURVES;
use std::ops::RangeInclusive;

/// Distances of ambient occlusion, in radii of the scene.
pub const AO_DISTANCES: RangeInclusive<f32> = 0.001..=10.0;
/// Offsets of coordinates, in units of the file.
pub const SPAWN_OFFSETS: RangeInclusive<f64> = 0.0..=1e9;
/// Limits on the surfaces of a path.
pub const DEPTH_LIMITS: RangeInclusive<u32> = 1..=1000;
/// Factors of the light from far away.
pub const BRIGHTNESSES: RangeInclusive<f32> = 0.0..=100.0;
/// Rotations of the light from far away, in degrees.
pub const ROTATIONS: RangeInclusive<f32> = 0.0..=360.0;
/// The slider's range of exposures, in stops; the others of [`EXPOSURES`] can be typed.
const DRAGGED_EXPOSURES: RangeInclusive<f32> = -10.0..=10.0;
/// Limits on the time of tracing, in seconds.
pub const TIME_LIMITS_S: RangeInclusive<f32> = 1.0..=86_400.0;
/// Limits on the noise, in percent of the mean luminance.
pub const NOISE_LIMITS: RangeInclusive<f32> = 0.001..=100.0;

/// Shows the options that the chosen view uses; nothing if it needs no lights.
pub(super) fn light_ui(ui: &mut egui::Ui, settings: &mut Settings, commands: &Commands) {
    let needs = settings.view().needs;
    if !needs.lights {
        return;
    }
    if needs.uses(Setting::OcclusionDistance) {
        ui.horizontal(|ui| {
            let label = ui.label("Distance");
            let slider = number_slider(&mut settings.ao_distance, AO_DISTANCES)
                .logarithmic(true)
                .suffix(" radii");
            let slider = ui.add(slider).labelled_by(label.id);
            slider.on_hover_text(
                "Surfaces nearer than this occlude, in radii of the scene's bounding sphere",
            );
        });
    }
    if settings.shows_light() {
        environment_ui(ui, settings, commands);
    }
    if settings.is_exposed() {
        exposure_ui(ui, settings);
    }
    if needs.uses(Setting::Depth) {
        ui.horizontal(|ui| {
            ui.checkbox(&mut settings.has_depth_limit, "Depth limit")
                .on_hover_text("The most surfaces on a path. If off, paths end at random.");
            let limit = number_field(&mut settings.depth_limit)
                .range(DEPTH_LIMITS)
                .suffix(" surfaces");
            ui.add_enabled(settings.has_depth_limit, limit)
                .accessible_name("Most surfaces on a path");
        });
    }
    if needs.uses(Setting::Spawn) {
        let chosen = settings.spawn();
        spawn_ui(ui, "Spawn policy", chosen, &mut settings.spawn);
    }
    if needs.uses(Setting::SecondSpawn) {
        let chosen = settings.second_spawn();
        spawn_ui(ui, "compared with", chosen, &mut settings.second_spawn);
        ui.horizontal(|ui| {
            let label = ui.label("Offset");
            let slider = number_slider(&mut settings.spawn_offset, SPAWN_OFFSETS)
                .logarithmic(true)
                .smallest_positive(1.0)
                .custom_formatter(|x, _| format!("{x:.0}"));
            let slider = ui.add(slider).labelled_by(label.id);
            slider.on_hover_text(
                "Added to the coordinates of scene and camera: the larger they are, the more are 32-bit numbers rounded. Scenes of triangle meshes only",
            );
        });
    }
    if needs.uses(Setting::Terminator) {
        terminator_ui(ui, settings);
    }
    noise_ui(ui, settings, commands);
}

fn environment_ui(ui: &mut egui::Ui, settings: &mut Settings, commands: &Commands) {
    let file = settings.environment_file.as_ref().map(|path| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    });
    let title = |source| match source {
        EnvironmentSource::Scene => "Of the scene",
        EnvironmentSource::Colour => "Colour",
        EnvironmentSource::Studio => "Studio",
        EnvironmentSource::File => file.as_deref().unwrap_or_default(),
    };
    let chosen = settings.environment();
    ui.horizontal(|ui| {
        use EnvironmentSource::{Colour, File, Scene, Studio};
        let label = ui.label("Environment");
        egui::ComboBox::from_id_salt("environment")
            .selected_text(title(chosen))
            .show_ui(ui, |ui| {
                for source in [Scene, Studio, Colour, File] {
                    let is_there = source != File || file.is_some();
                    let is_chosen = source == chosen;
                    if is_there && ui.selectable_label(is_chosen, title(source)).clicked() {
                        settings.keep_environment(source);
                    }
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(
                "Light from far away. That of the scene is white if nothing in the scene emits light.",
            );
        if settings.environment() == Colour {
            ui.color_edit_button_srgb(&mut settings.environment_colour)
                .accessible_name("Colour of the environment");
        }
    });
    commands.button_ui(ui, "open-environment");
    if settings.environment() != EnvironmentSource::Scene {
        ui.horizontal(|ui| {
            let label = ui.label("Brightness");
            let slider = number_slider(&mut settings.environment_brightness, BRIGHTNESSES)
                .logarithmic(true)
                .smallest_positive(0.01);
            let slider = ui.add(slider).labelled_by(label.id);
            slider.on_hover_text("Factor of the light from far away");
        });
    }
    if settings.has_map() {
        ui.horizontal(|ui| {
            let label = ui.label("Rotation");
            let slider = number_slider(&mut settings.environment_degrees, ROTATIONS)
                .suffix("°")
                .fixed_decimals(0);
            let slider = ui.add(slider).labelled_by(label.id);
            slider.on_hover_text(
                "Rotation of the environment about the up axis, in degrees (Ctrl+drag in the picture)",
            );
        });
    }
}

fn exposure_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let label = ui.label("Exposure");
        let slider = number_slider(&mut settings.exposure_stops, DRAGGED_EXPOSURES)
            .clamping(SliderClamping::Never)
            .suffix(" stops")
            .fixed_decimals(1);
        let slider = ui.add(slider).labelled_by(label.id);
        let (least, most) = (EXPOSURES.start(), EXPOSURES.end());
        slider.on_hover_text(format!(
            "Each stop doubles the brightness of the picture. Values from {least} to {most} can be typed"
        ));
        settings.exposure_stops = settings.exposure_stops.clamp(*least, *most);
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
                        .on_hover_text(curve.about);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(chosen.about);
    });
}

fn spawn_ui(ui: &mut egui::Ui, name: &str, chosen: &SpawnPolicy, kept: &mut String) {
    ui.horizontal(|ui| {
        let label = ui.label(name);
        egui::ComboBox::from_id_salt(name)
            .selected_text(chosen.title)
            .show_ui(ui, |ui| {
                for policy in SPAWN_POLICIES {
                    let name = policy.name.to_owned();
                    ui.selectable_value(kept, name, policy.title)
                        .on_hover_text(policy.summary);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(chosen.summary);
    });
}

fn terminator_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let label = ui.label("Terminator repair (not exact)");
        let chosen = settings.terminator();
        egui::ComboBox::from_id_salt("terminator")
            .selected_text(chosen.title)
            .show_ui(ui, |ui| {
                for repair in TERMINATOR_REPAIRS {
                    let name = repair.name.to_owned();
                    ui.selectable_value(&mut settings.terminator, name, repair.title)
                        .on_hover_text(repair.summary);
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text(format!(
                "Hides the hard edge of light on coarse triangles with smooth shading. No repair is exact. {}: {}",
                chosen.title, chosen.summary
            ));
    });
}

/// Shows the limits that end refinement, and the switch of the noise's picture with its legend.
fn noise_ui(ui: &mut egui::Ui, settings: &mut Settings, commands: &Commands) {
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_time_limit, "Stop after")
            .on_hover_text("Ends refinement after this time by the clock, but not before the first pass is done; pauses don't count");
        let secs = number_field(&mut settings.time_limit_s)
            .range(TIME_LIMITS_S)
            .suffix(" s");
        ui.add_enabled(settings.has_time_limit, secs)
            .accessible_name("Time limit");
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_noise_limit, "Stop at noise")
            .on_hover_text(format!(
                "Ends refinement when the mean standard error of the pixels that show a surface is at most this, in percent \
                 of their mean luminance; from {LEAST_SAMPLES} samples per pixel on"
            ));
        let percent = number_field(&mut settings.noise_limit_percent)
            .range(NOISE_LIMITS)
            .speed(0.05)
            .max_decimals(3)
            .suffix(" %");
        ui.add_enabled(settings.has_noise_limit, percent)
            .accessible_name("Noise limit");
    });
    commands.check_box_ui(ui, "noise");
    if settings.shows_noise {
        legend_ui(ui, &noise_legend());
    }
}

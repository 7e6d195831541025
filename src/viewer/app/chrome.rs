//! The tool bar and the status line.

use super::App;
use crate::bindings::Action;
use crate::numbers::significant;
use crate::overlay::wireframe::WIREFRAME;
use crate::panels::view::shown_kernel;
use crate::tracer::{Status, StopReason};
use crate::watch::Watch;
use egui::RichText;
use hitscope_core::Scene;
use hitscope_core::counts::{counted, counted_as};
use hitscope_core::integrator::INTEGRATORS;

impl App {
    pub(super) fn toolbar_ui(&mut self, ui: &mut egui::Ui, actions: &mut Vec<Action>) {
        let frame =
            egui::Frame::side_top_panel(ui.style()).inner_margin(egui::Margin::symmetric(6, 4));
        egui::Panel::top("toolbar").frame(frame).show(ui, |ui| {
            // Wraps to several rows in a narrow window.
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                self.tools_ui(ui, actions);
                self.switches_ui(ui, actions);
                let help = ui
                    .button("Help")
                    .on_hover_text("Keyboard and mouse controls (H)");
                if help.clicked() {
                    actions.push(Action::ToggleHelp);
                }
            });
        });
    }

    fn tools_ui(&mut self, ui: &mut egui::Ui, actions: &mut Vec<Action>) {
        if ui
            .button("Open")
            .on_hover_text("Open a file (Ctrl+O)")
            .clicked()
        {
            actions.push(Action::Open);
        }
        let save = ui.add_enabled(self.document.path.is_some(), egui::Button::new("Save"));
        if save
            .on_hover_text("Save what is open as a scene file, with this camera (Ctrl+Shift+S)")
            .on_disabled_hover_text(
                "Only a document that is in a file can be saved as a scene file",
            )
            .clicked()
        {
            actions.push(Action::Save);
        }
        let frame = match self.document.loaded.view {
            Some(_) => "Show the scene file's view, or the whole scene (Home)",
            None => "Frame the mesh (Home)",
        };
        if ui.button("Frame").on_hover_text(frame).clicked() {
            actions.push(Action::Frame);
        }
        self.view_menu_ui(ui);
    }

    fn view_menu_ui(&mut self, ui: &mut egui::Ui) {
        let view = self.settings.view();
        egui::ComboBox::from_id_salt("view")
            .selected_text(view.title)
            .width(92.0)
            .height(400.0)
            .show_ui(ui, |ui| {
                for choice in INTEGRATORS {
                    let is_chosen = choice.name == view.name;
                    let button = ui.selectable_label(is_chosen, choice.title);
                    if button.on_hover_text(choice.about).clicked() {
                        self.settings.keep_view(choice.name);
                    }
                }
            })
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "View"));
    }

    fn switches_ui(&self, ui: &mut egui::Ui, actions: &mut Vec<Action>) {
        for (label, is_on, action, hint, is_enabled) in self.switches() {
            let button = egui::Button::selectable(is_on, label);
            let response = ui.add_enabled(is_enabled, button);
            if response.on_hover_text(hint).clicked() {
                actions.push(action);
            }
        }
    }

    /// The switches of the tool bar: label, state, action, tooltip, whether it is enabled.
    fn switches(&self) -> [(&'static str, bool, Action, &'static str, bool); 9] {
        let settings = &self.settings;
        [
            (
                "Smooth",
                settings.is_smooth,
                Action::ToggleSmooth,
                "Smooth shading (S)",
                true,
            ),
            (
                "Wireframe",
                settings.overlays.is_on(&WIREFRAME),
                Action::ToggleWireframe,
                "Wireframe (W)",
                true,
            ),
            (
                "Normals",
                settings.shows_normals(),
                Action::ToggleNormals,
                "Normals (N)",
                true,
            ),
            (
                "Noise",
                settings.shows_noise,
                Action::ToggleNoise,
                "Standard error of each pixel, in views with light",
                settings.view().needs.lights,
            ),
            (
                "Orthographic",
                self.turntable.is_orthographic,
                Action::ToggleOrthographic,
                "Orthographic projection (5)",
                true,
            ),
            (
                "Auto-rotation",
                self.is_rotating,
                Action::ToggleRotation,
                "Auto-rotation (T)",
                true,
            ),
            (
                "Auto-reload",
                settings.watches,
                Action::ToggleWatch,
                "Reload the file when it changes (Ctrl+R)",
                self.document.path.is_some(),
            ),
            (
                "Pause",
                self.tracer.is_paused(),
                Action::TogglePause,
                "Pause refinement (P)",
                true,
            ),
            (
                "Panel",
                settings.shows_panel,
                Action::TogglePanel,
                "Side panel (I)",
                true,
            ),
        ]
    }

    pub(super) fn status_ui(&mut self, ui: &mut egui::Ui) {
        let parts = self.status_parts();
        let frame =
            egui::Frame::side_top_panel(ui.style()).inner_margin(egui::Margin::symmetric(6, 2));
        egui::Panel::bottom("status").frame(frame).show(ui, |ui| {
            let text = RichText::new(parts.join("  ·  ")).monospace().size(11.0);
            ui.add(egui::Label::new(text).truncate());
        });
    }

    /// The parts of the status line, most important first: a narrow window truncates it.
    fn status_parts(&self) -> Vec<String> {
        let status = self.tracer.status();
        let scene = &self.document.loaded.scene;
        let ms = |time: std::time::Duration| time.as_secs_f64() * 1e3;
        let tree = if scene.has_best_tree() {
            "tree"
        } else {
            "quick tree"
        };
        // A path has many rays.
        let unit = if self.settings.view().needs.lights {
            "Msamples/s"
        } else {
            "Mrays/s"
        };
        let kernel = shown_kernel(self.document.kernel(), &scene.kernels()).short_name();
        let mut parts = vec![
            format!("{kernel} kernel"),
            primitives(scene),
            self.samples_part(&status),
            format!("pass {} of {}", status.passes, status.pass_count),
            format!("{:.1} {unit}", status.rays_per_s / 1e6),
            format!("{:.1} s", status.lasted.as_secs_f64()),
            format!("{tree} {:.0} ms", ms(scene.build_time())),
        ];
        // Medians and 99th percentiles.
        for (name, times) in [
            ("frame", status.frame_interval),
            ("UI", self.ui_times.median_and_99th()),
        ] {
            if let Some([median, p99]) = times.map(|times| times.map(ms)) {
                parts.push(format!("{name} {median:.0} ms, p99 {p99:.0} ms"));
            }
        }
        if self.tracer.non_finite() > 0 {
            let count = self.tracer.non_finite() as usize;
            parts.insert(2, format!("{} not finite", counted(count, "sample")));
        }
        if self.watch.as_ref().is_some_and(Watch::is_missing) {
            parts.insert(0, "the file is missing".to_owned());
        }
        if self.document.is_blank {
            parts = vec!["no file open".to_owned()];
        }
        parts
    }

    /// Samples and noise, such as `64 of 128 samples, noise 0.8 % (worst 12 %)`.
    fn samples_part(&self, status: &Status) -> String {
        if status.is_preview {
            return "preview".to_owned();
        }
        let all = counted(self.settings.samples as usize, "sample");
        let mut text = format!("{} of {all}", status.samples);
        if let Some(noise) = status.noise {
            let exposure = f64::from(self.settings.exposure());
            let [mean, worst] = [noise.mean, noise.worst].map(|error| percent(exposure * error));
            text += &format!(", noise {mean} (worst {worst})");
        }
        text += match status.stopped {
            Some(StopReason::Time) => ", stopped by time",
            Some(StopReason::Noise) => ", stopped by noise",
            None if self.tracer.is_paused() => ", paused",
            None => "",
        };
        text
    }
}

/// An error relative to white in percent, such as `0.8 %`.
fn percent(error: f64) -> String {
    match 100.0 * error {
        x if x >= 10.0 => format!("{x:.0} %"),
        x if x >= 0.1 => format!("{x:.1} %"),
        x => format!("{} %", significant(x, 1)),
    }
}

/// The primitives of a scene: triangles, or all of them if it has other shapes.
fn primitives(scene: &Scene) -> String {
    match scene.groups() {
        [group] => counted_as(group.count(), group.shape().name, group.shape().plural),
        _ => counted(scene.primitive_count(), "primitive"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_shown_in_percent_with_few_digits() {
        for (error, text) in [
            (0.0, "0 %"),
            (0.000_05, "0.005 %"),
            (0.008, "0.8 %"),
            (0.015, "1.5 %"),
            (0.123, "12 %"),
            (4.0, "400 %"),
        ] {
            assert_eq!(percent(error), text);
        }
    }
}

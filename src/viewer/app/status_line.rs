//! The status line.

use super::App;
use crate::first_picture::shown_time;
use crate::numbers::significant;
use crate::panels::view::shown_kernel;
use crate::theme::panel_frame;
use crate::tracer::{Status, StopReason};
use crate::watch::Watch;
use egui::RichText;
use hitscope_core::Scene;
use hitscope_core::counts::{counted, counted_as};

impl App {
    pub(super) fn status_ui(&mut self, ui: &mut egui::Ui) {
        let parts = self.status_parts();
        let frame = panel_frame(ui.style()).inner_margin(egui::Margin::symmetric(6, 2));
        egui::Panel::bottom("status").frame(frame).show(ui, |ui| {
            let text = RichText::new(parts.join(" · ")).monospace().size(11.0);
            let label = egui::Label::new(text).truncate();
            ui.add(label.show_tooltip_when_elided(false))
                .on_hover_text(parts.join("\n"));
        });
    }

    /// The parts of the status line, most important first. A narrow window truncates the line; its tooltip lists all
    /// parts.
    fn status_parts(&self) -> Vec<String> {
        let status = self.traced.tracer.status();
        let scene = &self.open.document.loaded.scene;
        let ms = |time: std::time::Duration| time.as_secs_f64() * 1e3;
        let tree = if scene.has_best_tree() {
            "tree"
        } else {
            "quick tree"
        };
        // A path has many rays.
        let unit = if self.seen.settings.view().needs.lights {
            "samples/s"
        } else {
            "rays/s"
        };
        let kernel = shown_kernel(self.open.document.kernel(), &scene.kernels()).short_name();
        let mut parts = vec![
            format!("{kernel} kernel"),
            primitives(scene),
            self.samples_part(&status),
            format!("pass {}/{}", status.passes, status.pass_count),
            speed(status.rays_per_s, unit),
            format!("{:.1} s", status.lasted.as_secs_f64()),
            format!("{tree} {:.0} ms", ms(scene.build_time())),
        ];
        parts.extend(self.first_picture().map(shown_time));
        // Medians and 99th percentiles.
        for (name, times) in [
            ("frame", status.frame_interval),
            ("UI", self.shown.ui_times.median_and_99th()),
        ] {
            if let Some([median, p99]) = times.map(|times| times.map(ms)) {
                parts.push(format!("{name} {median:.0} ms, p99 {p99:.0} ms"));
            }
        }
        if self.traced.tracer.non_finite() > 0 {
            let count = self.traced.tracer.non_finite() as usize;
            parts.insert(2, format!("{} not finite", counted(count, "sample")));
        }
        parts.splice(0..0, self.magnified_part());
        if self.open.watch.as_ref().is_some_and(Watch::is_missing) {
            parts.insert(0, "the file is missing".to_owned());
        }
        if self.open.document.is_blank {
            parts = vec!["no file open".to_owned()];
        }
        parts
    }

    /// Samples and noise, such as `64 of 128 samples, noise 0.8 % (worst 12 %)`.
    fn samples_part(&self, status: &Status) -> String {
        if status.is_preview {
            return "preview".to_owned();
        }
        let all = counted(self.seen.settings.samples as usize, "sample");
        let mut text = format!("{} of {all}", status.samples);
        if let Some(noise) = status.noise {
            let [mean, worst] = [noise.mean, noise.worst].map(percent);
            text += &format!(", noise {mean} (worst {worst})");
        }
        text += match status.stopped {
            Some(StopReason::Time) => ", stopped at the time limit",
            Some(StopReason::Noise) => ", stopped at the noise limit",
            None if self.traced.tracer.is_paused() => ", paused",
            None => "",
        };
        text
    }
}

/// Noise in percent, such as `0.8 %`.
fn percent(error: f64) -> String {
    match 100.0 * error {
        x if x >= 10.0 => format!("{x:.0} %"),
        x if x >= 0.1 => format!("{x:.1} %"),
        x => format!("{} %", significant(x, 1)),
    }
}

/// A rate, such as `1.2 Mrays/s` or `350 samples/s`.
fn speed(per_s: f64, unit: &str) -> String {
    match per_s {
        x if x >= 1e5 => format!("{:.1} M{unit}", x / 1e6),
        x if x >= 1e3 => format!("{:.1} k{unit}", x / 1e3),
        x => format!("{x:.0} {unit}"),
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
    fn slow_pictures_have_a_speed_other_than_zero() {
        for (per_s, text) in [
            (1.25e7, "12.5 Mrays/s"),
            (1e5, "0.1 Mrays/s"),
            (4.2e4, "42.0 krays/s"),
            (350.0, "350 rays/s"),
        ] {
            assert_eq!(speed(per_s, "rays/s"), text);
        }
    }

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

//! The progress of loading: the phase and its completed fraction.

use hitscope_core::progress::{Phase, Progress};
use std::time::Duration;

/// Shows a bar for the current phase, or a spinner if its completed fraction is unknown.
pub fn progress_ui(ui: &mut egui::Ui, progress: &Progress) {
    // The bar moves without input events.
    ui.ctx().request_repaint_after(Duration::from_millis(50));
    match progress.part_of_phase() {
        Some(part) => {
            let width = ui.available_width().min(260.0);
            let bar = egui::ProgressBar::new(part).desired_width(width);
            ui.add(bar.text(text(progress)));
        }
        None => {
            ui.spinner();
            ui.label(text(progress));
        }
    }
}

fn text(progress: &Progress) -> String {
    let phase = progress.phase();
    let (number, count) = (phase as usize + 1, Phase::ALL.len());
    let step = format!("{number} of {count}: {}", phase.label());
    let (read, total) = progress.bytes();
    let mb = |bytes: u64| bytes as f64 / 1e6;
    match phase {
        Phase::Reading if total > 0 => {
            format!("{step}, {:.1} of {:.1} MB", mb(read), mb(total))
        }
        _ => step,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_names_the_phase() {
        assert_eq!(text(&Progress::default()), "1 of 3: Reading");
    }
}

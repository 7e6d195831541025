//! The figures of a comparison: differences of the pictures, and distances between the surfaces.

use super::CompareView;
use crate::comparison::{Comparison, MeshDistances, VisibilityDifference};
use crate::numbers::significant;
use crate::panels::{row_ui, section_ui};
use egui::RichText;
use hitscope_lab::picture_comparison::PictureComparison;
use hitscope_lab::surface_comparison::{DistanceFigures, OneSided};

/// Shows the figures of the differences and of the distances.
pub(super) fn figures_ui(ui: &mut egui::Ui, comparison: &Comparison, view: &CompareView<'_>) {
    if let Some([a, b]) = view.sizes {
        ui.label(format!(
            "The sides differ in size: {}×{} and {}×{} pixels",
            a.x, a.y, b.x, b.y
        ));
    }
    if let Some(figures) = view.figures {
        let status = if view.are_figures_final {
            "Figures of both pictures with all their samples"
        } else {
            "So far: the pictures are still being refined"
        };
        ui.label(RichText::new(status).weak());
        picture_ui(ui, &figures.picture);
        if let Some(visibility) = figures.visibility {
            visibility_ui(ui, visibility);
        }
    } else if view.sizes.is_none() {
        ui.label("The figures appear once both sides have pictures.");
    }
    if comparison.source.is_other_scene() {
        match view.distances {
            Some(Ok(distances)) => distances_ui(ui, distances),
            Some(Err(reason)) => _ = ui.label(reason),
            None => {}
        }
    }
}

fn picture_ui(ui: &mut egui::Ui, found: &PictureComparison) {
    let encoding = if found.is_linear {
        "Differences, linear RGB"
    } else {
        "Differences, sRGB from 0 to 1"
    };
    section_ui(ui, encoding, |ui| {
        let [width, height] = found.size;
        let count = found.pixels_over_tolerance;
        let part = significant(found.percent_over_tolerance, 3);
        let all = u64::from(width) * u64::from(height);
        row_ui(ui, "Pixels", format!("{count} of {all} differ ({part} %)"));
        row_ui(ui, "MSE", significant(found.mse, 5));
        row_ui(ui, "RMSE", significant(found.rmse, 5));
        let psnr = found.psnr_db;
        let psnr = psnr.map_or("no difference".to_owned(), |psnr| format!("{psnr:.2} dB"));
        row_ui(ui, "PSNR", psnr);
        if let Some(relative) = found.relative_mse {
            row_ui(ui, "Relative MSE", significant(relative, 5));
        }
        if let Some(worst) = &found.worst {
            let [x, y] = worst.pixel;
            let difference = significant(worst.difference, 4);
            let text = format!("{difference} at {x}, {y} ({})", worst.channel);
            row_ui(ui, "Largest", text);
        }
        if found.non_finite_pixels > 0 {
            row_ui(ui, "Non-finite pixels", found.non_finite_pixels);
        }
    });
}

fn visibility_ui(ui: &mut egui::Ui, found: VisibilityDifference) {
    section_ui(ui, "Visible triangles at pixel centres", |ui| {
        let VisibilityDifference { covered, different } = found;
        row_ui(ui, "Pixels", format!("{different} of {covered} differ"));
    });
}

fn distances_ui(ui: &mut egui::Ui, distances: &MeshDistances) {
    let (there, back) = (&distances.there, &distances.back);
    let both = DistanceFigures::both_ways(there.figures(), back.figures());
    let relative = both.relative_to(distances.diagonal);
    section_ui(ui, "Distances from A to B", |ui| one_sided_ui(ui, there));
    section_ui(ui, "Distances from B to A", |ui| one_sided_ui(ui, back));
    section_ui(ui, "Both ways", |ui| {
        for (name, length, part) in [
            ("Mean", both.mean, relative.mean),
            ("RMS", both.rms, relative.rms),
            ("Largest", both.max, relative.max),
        ] {
            let percent = significant(100.0 * part, 3);
            let text = format!("{} ({percent} % of the diagonal)", significant(length, 5));
            row_ui(ui, name, text);
        }
    });
}

fn one_sided_ui(ui: &mut egui::Ui, side: &OneSided) {
    row_ui(ui, "Mean", significant(side.mean, 5));
    row_ui(ui, "RMS", significant(side.rms, 5));
    row_ui(ui, "99th percentile", significant(side.p99, 5));
    let at = side.worst.position.map(|x| significant(x, 6)).join(", ");
    row_ui(
        ui,
        "Largest",
        format!("{} at {at}", significant(side.max, 5)),
    );
}

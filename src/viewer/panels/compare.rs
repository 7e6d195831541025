//! The tab *Compare*: the sides, the mode and the figures of a comparison.

mod figures;

use crate::command::{COMPARE_MODES, Commands};
use crate::comparison::{Comparison, Figures, GAINS, MeshDistances, Mode, Rasterized, Source};
use crate::number_field::number_slider;
use crate::opening::Loading;
use crate::settings::Settings;
use egui::{ComboBox, RichText};
use figures::figures_ui;
use glam::UVec2;
use hitscope_core::group::ShapeKernels;
use hitscope_core::integrator::{INTEGRATORS, Integrator};

/// Width in points of the narrowest choice; longer texts are cut.
const NARROWEST_COMBO: f32 = 90.0;

/// The contents of the tab besides the choices.
pub struct CompareView<'a> {
    /// The kernels of the scene's shapes.
    pub kernels: Vec<ShapeKernels>,
    /// The names of both sides.
    pub names: [String; 2],
    /// The other file, while it is being loaded.
    pub loading: Option<&'a Loading>,
    /// Whether the reference picture is being loaded.
    pub is_loading_picture: bool,
    /// The shapes that aren't rasterized.
    pub not_drawn: Option<String>,
    /// Whether the earlier version is missing.
    pub lacks_earlier: bool,
    /// Width and height of both sides, if they differ.
    pub sizes: Option<[UVec2; 2]>,
    /// The figures of the differences.
    pub figures: Option<&'a Figures>,
    /// Whether the figures are those of pictures with all samples.
    pub are_figures_final: bool,
    /// The distances between the surfaces.
    pub distances: Option<&'a Result<MeshDistances, String>>,
    /// Why the distance map isn't shown.
    pub map_status: Option<&'static str>,
}

/// Shows the tab. Returns whether the user cancels loading.
#[must_use]
pub fn compare_ui(
    ui: &mut egui::Ui,
    (of_a, comparison): (&mut Settings, &mut Comparison),
    view: &CompareView<'_>,
    commands: &Commands,
) -> bool {
    commands.check_box_ui(ui, "compare");
    if !comparison.is_on {
        ui.label(
            RichText::new("Compares the picture with another one for the same camera.").weak(),
        );
        return false;
    }
    ui.horizontal_wrapped(|ui| {
        for mode in commands.at(COMPARE_MODES) {
            commands.choice_ui(ui, mode);
        }
    });
    mode_ui(ui, comparison, view);
    ui.horizontal_wrapped(|ui| {
        commands.small_button_ui(ui, "compare-switch");
        commands.small_button_ui(ui, "compare-swap");
    });
    ui.separator();
    ui.label(RichText::new(&view.names[0]).strong());
    commands.check_box_ui(ui, "compare-rasterize-a");
    looks_of_a_ui(ui, of_a, comparison, view);
    ui.separator();
    ui.label(RichText::new(&view.names[1]).strong());
    let is_cancelled = source_ui(ui, comparison, view, commands);
    if comparison.source != Source::Picture {
        looks_of_b_ui(ui, of_a, comparison, view);
    }
    if comparison.has_rasterized() {
        rasterized_ui(ui, view);
    }
    ui.separator();
    figures_ui(ui, comparison, view);
    is_cancelled
}

/// Describes rasterized pictures, and lists the shapes that they lack.
fn rasterized_ui(ui: &mut egui::Ui, view: &CompareView<'_>) {
    ui.separator();
    let about = "Rasterized: one sample at the centre of each pixel. Views that trace light are replaced by Shaded.";
    ui.label(RichText::new(about).weak());
    if let Some(shapes) = &view.not_drawn {
        ui.label(format!(
            "Not rasterized, because they aren't triangles: {shapes}"
        ));
    }
}

fn mode_ui(ui: &mut egui::Ui, comparison: &mut Comparison, view: &CompareView<'_>) {
    match comparison.mode {
        Mode::Wipe => {
            ui.horizontal(|ui| {
                let label = ui.label("Divider");
                let slider = number_slider(&mut comparison.divider, 0.0..=1.0).max_decimals(3);
                ui.add(slider).labelled_by(label.id);
            });
        }
        Mode::Difference => {
            ui.horizontal(|ui| {
                let label = ui.label("Gain");
                let slider = number_slider(&mut comparison.gain, GAINS)
                    .logarithmic(true)
                    .max_decimals(1);
                ui.add(slider)
                    .labelled_by(label.id)
                    .on_hover_text("Multiplies the differences");
            });
        }
        Mode::Distance => {
            if let Some(status) = view.map_status {
                ui.label(status);
            }
        }
        Mode::A | Mode::B => {}
    }
}

/// The source of side B, with its file. Returns whether the user cancels loading.
fn source_ui(
    ui: &mut egui::Ui,
    comparison: &mut Comparison,
    view: &CompareView<'_>,
    commands: &Commands,
) -> bool {
    ui.horizontal(|ui| {
        let label = ui.label("Source");
        let combo = ComboBox::from_id_salt("source")
            .selected_text(comparison.source.title())
            .width(ui.available_width().clamp(NARROWEST_COMBO, 180.0))
            .truncate()
            .show_ui(ui, |ui| {
                for source in Source::ALL {
                    let is_chosen = comparison.source == source;
                    let choice = ui.selectable_label(is_chosen, source.title());
                    if choice.on_hover_text(source.about()).clicked() {
                        comparison.source = source;
                    }
                }
            });
        combo.response.labelled_by(label.id);
    });
    match comparison.source {
        Source::Traced | Source::Rasterized => {}
        Source::Mesh => {
            commands.button_ui(ui, "compare-mesh");
            return view.loading.is_some_and(|loading| loading.progress_ui(ui));
        }
        Source::Picture => {
            ui.horizontal(|ui| {
                commands.button_ui(ui, "compare-picture");
                if view.is_loading_picture {
                    ui.spinner();
                }
            });
            ui.label(
                RichText::new("Side A is traced at the size of the reference picture.").weak(),
            );
        }
        Source::Earlier if view.lacks_earlier => {
            ui.label("There is no earlier version: the file hasn't been reloaded.");
        }
        Source::Earlier => {}
    }
    false
}

/// View, kernel and shading of side A.
fn looks_of_a_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    comparison: &Comparison,
    view: &CompareView<'_>,
) {
    let shown = settings.view();
    let mut chosen = Some(shown.name.to_owned());
    choice_ui(
        ui,
        "View of A",
        &mut chosen,
        shown.title,
        None,
        views_for(comparison.is_a_rasterized),
    );
    if let Some(name) = chosen.filter(|name| name != shown.name) {
        settings.keep_view(&name);
    }
    if !comparison.is_a_rasterized {
        kernel_of_a_ui(ui, settings, view);
    }
    let mut chosen = Some(Settings::shading_name(settings.is_smooth).to_owned());
    let used = Settings::shading_name(settings.is_smooth);
    choice_ui(ui, "Shading of A", &mut chosen, used, None, shadings());
    settings.is_smooth = chosen.as_deref() == Some(Settings::shading_name(true));
}

fn kernel_of_a_ui(ui: &mut egui::Ui, settings: &mut Settings, view: &CompareView<'_>) {
    let kernel = settings.kernel().info;
    let mut chosen = Some(kernel.name.to_owned());
    let kernels = kernels(&view.kernels);
    choice_ui(
        ui,
        "Kernel of A",
        &mut chosen,
        kernel.short_name(),
        None,
        kernels,
    );
    if let Some(name) = chosen.filter(|name| name != kernel.name) {
        settings.keep_kernel(&name);
    }
}

/// View, kernel and shading of side B.
fn looks_of_b_ui(
    ui: &mut egui::Ui,
    of_a: &Settings,
    comparison: &mut Comparison,
    view: &CompareView<'_>,
) {
    const AS_A: Option<&str> = Some("same as A");
    let of_b = comparison.settings(of_a);
    let is_rasterized = comparison.source == Source::Rasterized;
    let used = of_b.view().title;
    choice_ui(
        ui,
        "View of B",
        &mut comparison.view,
        used,
        AS_A,
        views_for(is_rasterized),
    );
    if !is_rasterized {
        let used = of_b.kernel().info.short_name();
        let kernels = kernels(&view.kernels);
        choice_ui(
            ui,
            "Kernel of B",
            &mut comparison.kernel,
            used,
            AS_A,
            kernels,
        );
    }
    let mut chosen = comparison
        .is_smooth
        .map(|is| Settings::shading_name(is).to_owned());
    let used = Settings::shading_name(of_b.is_smooth);
    choice_ui(ui, "Shading of B", &mut chosen, used, AS_A, shadings());
    comparison.is_smooth = chosen.map(|chosen| chosen == Settings::shading_name(true));
}

/// The names of choices, with their titles.
type Choices = Vec<(&'static str, String)>;

/// The views of a side.
fn views_for(is_rasterized: bool) -> Choices {
    let choice = |view: &'static Integrator| (view.name, view.title.to_owned());
    if is_rasterized {
        Rasterized::views().map(choice).collect()
    } else {
        INTEGRATORS.iter().copied().map(choice).collect()
    }
}

fn kernels(shapes: &[ShapeKernels]) -> Choices {
    let kernels = shapes.iter().flat_map(|shape| &shape.kernels);
    let choice = kernels.map(|kernel| {
        let title = format!("{} – {}", kernel.short_name(), kernel.title);
        (kernel.name, title)
    });
    choice.collect()
}

fn shadings() -> Choices {
    let names = [false, true].map(Settings::shading_name);
    names.map(|name| (name, name.to_owned())).to_vec()
}

/// Shows a drop-down list of choices. Its first entry is `none`, if there may be no choice.
fn choice_ui(
    ui: &mut egui::Ui,
    title: &str,
    chosen: &mut Option<String>,
    used: &str,
    none: Option<&str>,
    choices: Choices,
) {
    ui.horizontal(|ui| {
        let label = ui.label(title);
        let text = match (&chosen, none) {
            (None, Some(none)) => format!("{none} ({used})"),
            _ => used.to_owned(),
        };
        let combo = ComboBox::from_id_salt(title)
            .selected_text(text)
            .width(ui.available_width().clamp(NARROWEST_COMBO, 170.0))
            .truncate()
            .height(320.0)
            .show_ui(ui, |ui| {
                if let Some(none) = none
                    && ui.selectable_label(chosen.is_none(), none).clicked()
                {
                    *chosen = None;
                }
                for (name, title) in choices {
                    let is_chosen = chosen.as_deref() == Some(name);
                    if ui.selectable_label(is_chosen, title).clicked() {
                        *chosen = Some(name.to_owned());
                    }
                }
            });
        combo.response.labelled_by(label.id);
    });
}

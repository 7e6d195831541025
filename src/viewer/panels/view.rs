//! The Display tab: view with its options, shading, colours, kernel, overlay, clip, camera, theme.

use super::clip::clip_ui;
use super::colours::colours_ui;
use super::light::light_ui;
use super::overlay::overlay_ui;
use crate::clip_choice::Extent;
use crate::command::{Commands, THEMES, VIEWS};
use crate::number_field::{finite, number_field, number_slider};
use crate::settings::Settings;
use egui::RichText;
use hitscope_core::camera::Turntable;
use hitscope_core::colour::{ColourScale, ScaleError};
use hitscope_core::group::ShapeKernels;
use hitscope_core::integrator::{Comparison, Legend};
use hitscope_core::kernel::{KernelChoice, KernelInfo};
use hitscope_core::plan::MAX_SAMPLES;
use hitscope_core::srgb::to_display;

/// What is shown of the scene.
pub struct Shown {
    /// The kernels of the scene's shapes.
    pub shapes: Vec<ShapeKernels>,
    /// The scale of the picture, if it shows numbers.
    pub scale: Option<Result<ColourScale, ScaleError>>,
    /// The box around the scene in the file's coordinates.
    pub extent: Extent,
}

/// Shows the tab.
pub fn view_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    turntable: &mut Turntable,
    shown: &Shown,
    commands: &Commands,
) {
    let shapes = &shown.shapes[..];
    chosen_view_ui(ui, settings, shapes, commands);
    ui.separator();
    colours_ui(ui, settings, shown.scale.as_ref(), commands);
    ui.separator();
    kernel_ui(ui, settings, shapes);
    ui.separator();
    overlay_ui(ui, &mut settings.overlays, commands);
    ui.separator();
    clip_ui(ui, &mut settings.clip, &shown.extent, commands);
    ui.separator();
    camera_ui(ui, turntable, commands);
    ui.separator();
    ui.label(RichText::new("Theme").strong());
    ui.horizontal(|ui| {
        for theme in commands.at(THEMES) {
            commands.choice_ui(ui, theme);
        }
    });
}

fn chosen_view_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    shapes: &[ShapeKernels],
    commands: &Commands,
) {
    ui.label(RichText::new("View").strong());
    ui.horizontal_wrapped(|ui| {
        for view in commands.at(VIEWS) {
            commands.choice_ui(ui, view);
        }
    });
    ui.label(RichText::new(settings.view().about).weak());
    legend_ui(ui, &(settings.view().legend)());
    if settings.view().needs.second == Comparison::Second {
        ui.horizontal(|ui| {
            let label = ui.label("compared with");
            let (response, chosen) = kernel_combo_ui(ui, "against", settings.against(), shapes);
            response.labelled_by(label.id);
            if let Some(kernel) = chosen {
                settings.against = kernel.to_owned();
            }
        });
    }
    ui.horizontal(|ui| {
        commands.check_box_ui(ui, "smooth");
        let sphere = egui::Checkbox::new(&mut settings.is_spherical, "on the sphere");
        ui.add_enabled(settings.is_smooth, sphere).on_hover_text(
            "Interpolates vertex normals on the unit sphere, not linearly. The view Interpolation shows the angle \
             between both.",
        );
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_crease, "Crease above")
            .on_hover_text(
                "Smooth shading has creases where triangles meet at a larger angle. \
             If off, the file's normals and smoothing groups determine the creases.",
            );
        let degrees = number_field(&mut settings.crease_degrees)
            .range(0.0..=180.0)
            .suffix("°");
        ui.add_enabled(settings.has_crease, degrees)
            .accessible_name("Crease angle");
    });
    ui.horizontal(|ui| {
        let label = ui.label("Samples per pixel");
        let mut power = settings.samples.max(1).ilog2();
        let slider = number_slider(&mut power, 0..=MAX_SAMPLES.ilog2())
            .custom_formatter(|power, _| format!("{}", 1u32 << power as u32))
            .custom_parser(|text| Some(finite::<u32>(text)?.max(1.0).log2()));
        ui.add(slider).labelled_by(label.id);
        settings.samples = 1 << power;
    });
    light_ui(ui, settings, commands);
}

/// Shows the legend of the view.
pub(super) fn legend_ui(ui: &mut egui::Ui, legend: &Legend) {
    for line in legend {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 5.0;
            for (colour, text) in line {
                let [r, g, b] = colour.to_array().map(|x| (255.0 * to_display(x)) as u8);
                let size = egui::vec2(12.0, 12.0);
                let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                ui.painter().rect(
                    rect,
                    2.0,
                    egui::Color32::from_rgb(r, g, b),
                    ui.visuals().widgets.noninteractive.bg_stroke,
                    egui::StrokeKind::Inside,
                );
                ui.label(RichText::new(text).size(11.0));
                ui.add_space(3.0);
            }
        });
    }
}

fn kernel_ui(ui: &mut egui::Ui, settings: &mut Settings, shapes: &[ShapeKernels]) {
    let heading = ui.label(RichText::new("Kernel").strong());
    let (response, chosen) = kernel_combo_ui(ui, "kernel", settings.kernel(), shapes);
    let info = shown_kernel(settings.kernel(), shapes);
    response.labelled_by(heading.id);
    if let Some(kernel) = chosen {
        settings.keep_kernel(kernel);
    }
    if settings.session_kernel.is_some() {
        ui.label("Selected in the Trade tab for this session only.");
    }
    ui.label(RichText::new(info.summary).weak())
        .on_hover_text(info.source);
}

/// The description of the chosen kernel; in a scene of one shape, of the kernel that the shape uses instead if its
/// table lacks the chosen one.
pub fn shown_kernel(choice: KernelChoice, shapes: &[ShapeKernels]) -> &'static KernelInfo {
    match shapes {
        [shape] => choice.among(&shape.kernels).unwrap_or(choice.info),
        _ => choice.info,
    }
}

/// Shows a menu of the kernels of the scene's shapes, by shape. Returns the kernel selected in this frame.
fn kernel_combo_ui(
    ui: &mut egui::Ui,
    id: &str,
    current: KernelChoice,
    shapes: &[ShapeKernels],
) -> (egui::Response, Option<&'static str>) {
    let title = |info: &KernelInfo| format!("{} – {}", info.short_name(), info.title);
    let mut chosen = None;
    let response = egui::ComboBox::from_id_salt(id)
        .selected_text(title(shown_kernel(current, shapes)))
        .width(220.0)
        .height(320.0)
        .show_ui(ui, |ui| {
            for shape in shapes {
                if shapes.len() > 1 {
                    ui.label(RichText::new(heading(shape)).weak());
                }
                let used = current.among(&shape.kernels);
                for kernel in &shape.kernels {
                    let is_current = used.is_some_and(|used| used.name == kernel.name);
                    if ui.selectable_label(is_current, title(kernel)).clicked() {
                        chosen = Some(kernel.name);
                    }
                }
            }
        })
        .response;
    (response, chosen)
}

/// The plural of a shape's name with a capital.
pub(super) fn heading(shape: &ShapeKernels) -> String {
    let plural = shape.shape.plural;
    let mut letters = plural.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn camera_ui(ui: &mut egui::Ui, turntable: &mut Turntable, commands: &Commands) {
    ui.label(RichText::new("Camera").strong());
    commands.check_box_ui(ui, "orthographic");
    ui.horizontal(|ui| {
        let label = ui.label("Field of view");
        let mut degrees = turntable.fov_y_radians.to_degrees();
        // Neither rounds nor clamps the angle of a file's sensor.
        let slider = number_slider(&mut degrees, 5.0..=120.0)
            .clamping(egui::SliderClamping::Edits)
            .suffix("°")
            .custom_formatter(|degrees, _| format!("{degrees:.0}"));
        if ui.add(slider).labelled_by(label.id).changed() {
            turntable.fov_y_radians = degrees.to_radians();
        }
    });
    ui.horizontal(|ui| {
        for name in ["front", "back", "right", "left", "top", "bottom"] {
            commands.small_button_ui(ui, name);
        }
    });
    ui.horizontal(|ui| {
        commands.button_ui(ui, "y-up");
        commands.button_ui(ui, "z-up");
    });
}

//! How the mesh is seen.

use crate::bindings::Action;
use crate::settings::Settings;
use egui::RichText;
use hitscope_core::camera::{StandardView, Turntable};
use hitscope_core::integrator::{Comparison, INTEGRATORS, Legend};
use hitscope_core::kernel::{
    KernelInfo, TRIANGLE_KERNELS, default_triangle_kernel, triangle_kernel,
};
use hitscope_core::srgb::to_display;

/// View, shading, kernel, overlay, camera, theme.
pub fn view_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    turntable: &mut Turntable,
    actions: &mut Vec<Action>,
) {
    picture_ui(ui, settings);
    ui.separator();
    kernel_ui(ui, settings);
    ui.separator();
    overlay_ui(ui, settings);
    ui.separator();
    camera_ui(ui, settings, turntable, actions);
    ui.separator();
    ui.label(RichText::new("Theme").strong());
    let before = settings.theme;
    ui.horizontal(|ui| {
        for (theme, label) in [
            (egui::ThemePreference::Dark, "Dark"),
            (egui::ThemePreference::Light, "Light"),
            (egui::ThemePreference::System, "System"),
        ] {
            ui.selectable_value(&mut settings.theme, theme, label);
        }
    });
    if settings.theme != before {
        ui.ctx().set_theme(settings.theme);
    }
}

fn picture_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.label(RichText::new("Picture").strong());
    ui.horizontal_wrapped(|ui| {
        for choice in INTEGRATORS {
            ui.selectable_value(&mut settings.view, choice.name.to_owned(), choice.title);
        }
    });
    ui.label(RichText::new(settings.integrator().about).weak());
    legend_ui(ui, &(settings.integrator().legend)());
    if settings.integrator().against == Comparison::Second {
        ui.horizontal(|ui| {
            let label = ui.label("against");
            kernel_combo_ui(ui, "against", &mut settings.against).labelled_by(label.id);
        });
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut settings.is_smooth, false, "Flat");
        ui.selectable_value(&mut settings.is_smooth, true, "Smooth");
        ui.label("shading");
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.has_crease, "Edges above")
            .on_hover_text(
                "Smooth shading has an edge where triangles meet at a larger angle. \
             Without this, the file's normals and smoothing groups decide.",
            );
        let degrees = egui::DragValue::new(&mut settings.crease_degrees)
            .range(0.0..=180.0)
            .suffix("°");
        ui.add_enabled(settings.has_crease, degrees);
    });
    ui.horizontal(|ui| {
        let label = ui.label("Samples");
        let mut power = settings.samples.max(1).ilog2();
        let slider = egui::Slider::new(&mut power, 0..=12)
            .custom_formatter(|power, _| format!("{}", 1u32 << power as u32))
            .custom_parser(|text| text.parse().ok().map(f64::log2));
        ui.add(slider).labelled_by(label.id);
        settings.samples = 1 << power;
    });
}

/// The view's colours, line by line.
fn legend_ui(ui: &mut egui::Ui, legend: &Legend) {
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

fn kernel_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    let heading = ui.label(RichText::new("Kernel").strong());
    kernel_combo_ui(ui, "kernel", &mut settings.kernel).labelled_by(heading.id);
    let info = &settings.kernel().info;
    ui.label(RichText::new(info.summary).weak())
        .on_hover_text(info.source);
}

/// Every kernel, the tiers marked by their names.
fn kernel_combo_ui(ui: &mut egui::Ui, id: &str, name: &mut String) -> egui::Response {
    let title = |info: &KernelInfo| match info.tier {
        Some(tier) => format!("{} – {}", info.title, tier.name()),
        None => info.title.to_owned(),
    };
    let current = triangle_kernel(name).unwrap_or_else(default_triangle_kernel);
    egui::ComboBox::from_id_salt(id)
        .selected_text(title(current.info))
        .width(220.0)
        .height(320.0)
        .show_ui(ui, |ui| {
            for kernel in TRIANGLE_KERNELS {
                let value = kernel.info.name.to_owned();
                ui.selectable_value(name, value, title(kernel.info));
            }
        })
        .response
}

fn overlay_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.label(RichText::new("Overlay").strong());
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.shows_wireframe, "Wireframe");
        ui.color_edit_button_srgb(&mut settings.wire_colour);
        ui.checkbox(&mut settings.shows_diagonals, "with diagonals");
    });
    ui.checkbox(&mut settings.shows_normals, "Normals");
    ui.horizontal(|ui| {
        let label = ui.label("Length");
        let slider = egui::Slider::new(&mut settings.normal_length, 0.002..=0.5)
            .logarithmic(true)
            .custom_formatter(|part, _| format!("{:.1} %", 100.0 * part))
            .custom_parser(|text| {
                let percent = text.trim_end_matches(['%', ' ']).parse::<f64>().ok()?;
                Some(percent / 100.0)
            });
        ui.add(slider).labelled_by(label.id);
    });
}

fn camera_ui(
    ui: &mut egui::Ui,
    settings: &mut Settings,
    turntable: &mut Turntable,
    actions: &mut Vec<Action>,
) {
    ui.label(RichText::new("Camera").strong());
    ui.horizontal(|ui| {
        ui.selectable_value(&mut turntable.is_orthographic, false, "Perspective");
        ui.selectable_value(&mut turntable.is_orthographic, true, "Orthographic");
    });
    ui.horizontal(|ui| {
        let label = ui.label("Field of view");
        let mut degrees = turntable.fov_y_radians.to_degrees();
        let slider = egui::Slider::new(&mut degrees, 5.0..=120.0)
            .suffix("°")
            .fixed_decimals(0);
        if ui.add(slider).labelled_by(label.id).changed() {
            turntable.fov_y_radians = degrees.to_radians();
        }
    });
    ui.horizontal(|ui| {
        for (view, label) in [
            (StandardView::Front, "Front"),
            (StandardView::Back, "Back"),
            (StandardView::Right, "Right"),
            (StandardView::Left, "Left"),
            (StandardView::Top, "Top"),
            (StandardView::Bottom, "Bottom"),
        ] {
            if ui.small_button(label).clicked() {
                actions.push(Action::LookFrom(view));
            }
        }
    });
    ui.horizontal(|ui| {
        ui.label("Up axis");
        ui.selectable_value(&mut settings.is_z_up, false, "Y");
        ui.selectable_value(&mut settings.is_z_up, true, "Z");
    });
}

//! The sheet *About hitscope*: the version, the graphics adapter and the machine.

use crate::about::{LICENCE, NAME, SUMMARY, version_and_target};
use eframe::egui_wgpu::RenderState;
use egui::{Grid, Modal, RichText};
use hitscope_core::counts::grouped;
use hitscope_core::simd::SimdLevel;
use hitscope_lab::commands::default_thread_count;
use wgpu::{AdapterInfo, DeviceType};

/// Facts about the program and the machine, by name.
pub struct AboutSheet(Vec<(&'static str, String)>);

impl AboutSheet {
    /// Collects the facts.
    pub fn new(render_state: &RenderState) -> Self {
        let adapter = render_state.adapter.get_info();
        let limits = render_state.device.limits();
        let simd =
            SimdLevel::chosen().map_or_else(|error| error.to_string(), |l| l.name().to_owned());
        let mega_bytes = (limits.max_buffer_size / 1_000_000) as usize;
        let side = limits.max_texture_dimension_2d as usize;
        Self(vec![
            ("Version", version_and_target().to_owned()),
            ("SIMD", simd),
            ("Threads", default_thread_count().to_string()),
            ("Graphics adapter", adapter_text(&adapter)),
            ("Graphics backend", adapter.backend.to_string()),
            ("Graphics driver", driver_text(&adapter)),
            ("Largest buffer", format!("{} MB", grouped(mega_bytes))),
            ("Largest texture", format!("{} pixels wide", grouped(side))),
            ("Licence", LICENCE.to_owned()),
        ])
    }

    /// Shows the sheet over the window. Returns whether the user closes it.
    pub fn about_ui(&self, ctx: &egui::Context) -> bool {
        let response = Modal::new(egui::Id::unique("about")).show(ctx, |ui| {
            ui.set_max_width((ui.ctx().content_rect().width() - 60.0).clamp(1.0, 480.0));
            ui.heading(NAME);
            ui.label(SUMMARY);
            ui.add_space(4.0);
            Grid::new("about").num_columns(2).show(ui, |ui| {
                for (name, value) in &self.0 {
                    ui.label(RichText::new(*name).strong());
                    ui.label(value);
                    ui.end_row();
                }
            });
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                let copy = ui.button("Copy");
                if copy.on_hover_text("Copies these lines as text").clicked() {
                    ui.ctx().copy_text(self.text());
                }
                ui.button("Close").clicked()
            })
            .inner
        });
        response.inner || response.backdrop_response.clicked()
    }

    /// The facts as lines of text.
    fn text(&self) -> String {
        let lines = self
            .0
            .iter()
            .map(|(name, value)| format!("{name}: {value}\n"));
        lines.collect()
    }
}

/// The adapter's name and whether it is a software renderer.
fn adapter_text(adapter: &AdapterInfo) -> String {
    let kind = match adapter.device_type {
        DeviceType::DiscreteGpu => "dedicated",
        DeviceType::IntegratedGpu => "integrated",
        DeviceType::VirtualGpu => "virtual",
        DeviceType::Cpu => "software",
        DeviceType::Other => "unknown kind",
    };
    format!("{} ({kind})", adapter.name)
}

fn driver_text(adapter: &AdapterInfo) -> String {
    let parts = [&*adapter.driver, &*adapter.driver_info];
    let parts = parts.into_iter().filter(|part| !part.is_empty());
    match parts.collect::<Vec<_>>().join(" ") {
        text if text.is_empty() => "unknown".to_owned(),
        text => text,
    }
}

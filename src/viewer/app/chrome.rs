//! The window around the picture: tool bar, side panel, status line, messages and help.

use super::App;
use crate::bindings::{Action, KEYS, POINTER, SYSTEM};
use crate::panels;
use crate::settings::{PANEL_WIDTHS, Tab};
use crate::trade::Trade;
use crate::watch::Watch;
use egui::{Align, Layout, RichText};
use glam::UVec2;
use hitscope_core::Scene;
use hitscope_core::counts::{counted, counted_as};
use hitscope_core::integrator::INTEGRATORS;

/// Width in points that the panel leaves for the picture in a narrow window.
const NARROWEST_PICTURE: f32 = 120.0;
/// Width in points of the panel in the narrowest window.
const MIN_PANEL_WIDTH: f32 = 160.0;

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
        if ui
            .button("Frame")
            .on_hover_text("Frame the mesh (Home)")
            .clicked()
        {
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
                    let name = choice.name.to_owned();
                    ui.selectable_value(&mut self.settings.view, name, choice.title)
                        .on_hover_text(choice.about);
                }
            })
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "View"));
    }

    fn switches_ui(&self, ui: &mut egui::Ui, actions: &mut Vec<Action>) {
        let settings = &self.settings;
        // Label, state, action, tooltip, whether it is enabled.
        let switches = [
            (
                "Smooth",
                settings.is_smooth,
                Action::ToggleSmooth,
                "Smooth shading (S)",
                true,
            ),
            (
                "Wireframe",
                settings.shows_wireframe,
                Action::ToggleWireframe,
                "Wireframe (W)",
                true,
            ),
            (
                "Normals",
                settings.shows_normals,
                Action::ToggleNormals,
                "Normals (N)",
                true,
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
        ];
        for (label, is_on, action, hint, is_enabled) in switches {
            let button = egui::Button::selectable(is_on, label);
            let response = ui.add_enabled(is_enabled, button);
            if response.on_hover_text(hint).clicked() {
                actions.push(action);
            }
        }
    }

    pub(super) fn panel_ui(&mut self, ui: &mut egui::Ui, actions: &mut Vec<Action>) {
        let mut is_expanded = self.settings.shows_panel;
        let (narrowest, widest) = (*PANEL_WIDTHS.start(), *PANEL_WIDTHS.end());
        // In a narrow window, the panel leaves some room for the picture.
        let limit = (ui.available_width() - NARROWEST_PICTURE).clamp(MIN_PANEL_WIDTH, widest);
        let shown = egui::Panel::right("panel")
            .default_size(self.settings.panel_width)
            .size_range(narrowest.min(limit)..=limit)
            .show_collapsible(ui, &mut is_expanded, |ui| {
                ui.add_space(4.0);
                ui.horizontal(|ui| {
                    for (tab, label) in [
                        (Tab::Inspect, "Inspect"),
                        (Tab::Display, "Display"),
                        (Tab::Mesh, "Mesh"),
                        (Tab::Trade, "Trade"),
                    ] {
                        ui.selectable_value(&mut self.settings.tab, tab, label);
                    }
                });
                ui.separator();
                // In a narrow window the contents are wider than the panel.
                egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                    match self.settings.tab {
                        Tab::Inspect | Tab::Mesh | Tab::Trade if self.document.is_blank => {
                            ui.label("No file is open.");
                        }
                        Tab::Inspect => {
                            let is_busy = self.picking.is_some() || self.clicks.pending.is_some();
                            let pick = self.pick.as_ref();
                            let is_reading = self.face_lookup.is_some();
                            let view = pick.map(|pick| pick.view(&self.document, is_reading));
                            panels::inspect::inspect_ui(ui, view, is_busy);
                        }
                        Tab::Display => {
                            panels::view::view_ui(
                                ui,
                                &mut self.settings,
                                &mut self.turntable,
                                actions,
                            );
                        }
                        Tab::Mesh => {
                            let (document, settings) = (&mut self.document, &mut self.settings);
                            panels::mesh::mesh_ui(
                                ui,
                                document,
                                settings,
                                self.flaw.as_ref(),
                                actions,
                            );
                        }
                        Tab::Trade => self.trade_ui(ui),
                    }
                });
            });
        self.settings.shows_panel = is_expanded;
        if let Some(shown) = shown {
            // The width changes from frame to frame while the panel slides in or out.
            let width = shown.response.rect.width();
            let last = std::mem::replace(&mut self.panel_width, width);
            if last == width && width < limit && PANEL_WIDTHS.contains(&width) {
                self.settings.panel_width = width;
            }
        }
    }

    /// Measures the scene when the tab is first shown, and later only on request.
    fn trade_ui(&mut self, ui: &mut egui::Ui) {
        let is_wanted = match &mut self.trade {
            Some(trade) => {
                trade.poll();
                panels::trade::trade_ui(ui, trade, &mut self.settings)
            }
            None if self.has_measured => panels::trade::measure_ui(ui),
            None => true,
        };
        // Requires the picture's camera and the final tree.
        let is_ready = self.resolution != UVec2::ZERO && !self.is_unframed;
        if is_wanted && is_ready && self.document.has_last_tree() {
            let camera = self.turntable.camera(self.resolution);
            let axis = self.trade.take().map(|trade| trade.axis);
            let scene = &self.document.loaded.scene;
            let axis = axis.unwrap_or_default();
            self.trade = Some(Trade::start(scene, camera, axis, ui.ctx()));
            self.has_measured = true;
        }
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
        let pause = if self.tracer.is_paused() {
            ", paused"
        } else {
            ""
        };
        let tree = if scene.has_best_tree() {
            "tree"
        } else {
            "quick tree"
        };
        let kernel = self.document.intersector().kernel().short_name();
        let mut parts = vec![
            format!("{kernel} kernel"),
            primitives(scene),
            format!(
                "{} of {}{pause}",
                status.samples,
                counted(self.settings.samples as usize, "sample")
            ),
            format!("pass {} of {}", status.passes, status.pass_count),
            format!("{:.1} Mrays/s", status.rays_per_s / 1e6),
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

    /// Shows the windows over the picture.
    pub(super) fn windows_ui(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if let Some(path) = self.open_dialog.field_ui(ctx) {
            self.load(path, ctx);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.first().cloned());
        if let Some(file) = dropped {
            self.load(file.path().to_owned(), ctx);
        }
        self.drop_hint_ui(ctx);
        self.notices_ui(ctx);
        self.help_ui(ctx, actions);
    }

    fn drop_hint_ui(&self, ctx: &egui::Context) {
        if ctx.input(|input| input.raw.hovered_files.is_empty()) {
            return;
        }
        egui::Area::new(egui::Id::unique("drop"))
            .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| ui.heading("Drop to open"));
            });
    }

    /// Shows the loading progress and the notice.
    fn notices_ui(&mut self, ctx: &egui::Context) {
        // Without an open document, `hints_ui` shows the progress.
        let loading = self.loading.as_ref().filter(|_| !self.document.is_blank);
        if loading.is_none() && self.notice.is_none() {
            return;
        }
        let (mut is_closed, mut is_cancelled) = (false, false);
        egui::Area::new(egui::Id::unique("notices"))
            .fixed_pos(self.canvas_rect.min + egui::vec2(10.0, 10.0))
            .show(ctx, |ui| {
                // Don't overlap the side panel.
                ui.set_max_width((self.canvas_rect.width() - 40.0).clamp(80.0, 560.0));
                if let Some(loading) = loading {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.label(format!("Loading {}", loading.name()));
                        is_cancelled = loading.progress_ui(ui);
                    });
                }
                if let Some(notice) = &self.notice {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        let visuals = ui.visuals();
                        let (title, colour) = if notice.is_error {
                            ("Error", visuals.error_fg_color)
                        } else {
                            ("Warning", visuals.warn_fg_color)
                        };
                        ui.horizontal(|ui| {
                            ui.label(RichText::new(title).color(colour).strong());
                            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                                is_closed = ui.small_button("Close").clicked();
                            });
                        });
                        ui.label(&notice.text);
                    });
                }
            });
        if is_closed {
            self.notice = None;
        }
        if is_cancelled {
            self.cancel_loading();
        }
    }

    fn help_ui(&self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if !self.shows_help {
            return;
        }
        let response = egui::Modal::new(egui::Id::unique("help")).show(ctx, |ui| {
            ui.heading("Keyboard and mouse");
            ui.add_space(4.0);
            let size = ui.ctx().content_rect().size() - egui::vec2(60.0, 120.0);
            let height = size.y;
            egui::ScrollArea::both()
                .max_width(size.x)
                .max_height(height)
                .min_scrolled_height(height)
                .show(ui, |ui| {
                    let row = |ui: &mut egui::Ui, keys: &str, about: &str| {
                        ui.label(RichText::new(keys).strong());
                        ui.label(about);
                        ui.end_row();
                    };
                    egui::Grid::new("keys")
                        .num_columns(2)
                        .spacing([16.0, 3.0])
                        .show(ui, |ui| {
                            for (pointer, about) in POINTER {
                                row(ui, pointer, about);
                            }
                            for binding in KEYS {
                                row(ui, &binding.key_text(ctx), binding.about);
                            }
                            for (keys, about) in SYSTEM {
                                row(ui, keys, about);
                            }
                        });
                });
            ui.add_space(6.0);
            ui.button("Close").clicked()
        });
        if response.inner || response.backdrop_response.clicked() {
            actions.push(Action::ToggleHelp);
        }
    }
}

/// The primitives of a scene: triangles, or all of them if it has other shapes.
fn primitives(scene: &Scene) -> String {
    match scene.groups() {
        [group] => counted_as(group.count(), group.shape().name, group.shape().plural),
        _ => counted(scene.primitive_count(), "primitive"),
    }
}

//! The side panel with its tabs.

use super::App;
use crate::command::{Commands, TABS};
use crate::panels;
use crate::settings::PANEL_WIDTHS;
use crate::tab::Tab;
use crate::trade::Trade;
use glam::UVec2;

/// Width in points that the panel leaves for the picture in a narrow window.
const NARROWEST_PICTURE: f32 = 120.0;
/// Width in points of the panel in the narrowest window.
const MIN_PANEL_WIDTH: f32 = 160.0;

impl App {
    pub(super) fn panel_ui(&mut self, ui: &mut egui::Ui, commands: &Commands) {
        let mut is_expanded = self.settings.shows_panel;
        let (narrowest, widest) = (*PANEL_WIDTHS.start(), *PANEL_WIDTHS.end());
        // In a narrow window, the panel leaves some room for the picture.
        let limit = (ui.available_width() - NARROWEST_PICTURE).clamp(MIN_PANEL_WIDTH, widest);
        let shown = egui::Panel::right("panel")
            .default_size(self.settings.panel_width)
            .size_range(narrowest.min(limit)..=limit)
            .show_collapsible(ui, &mut is_expanded, |ui| {
                tabs_ui(ui, commands);
                // In a narrow window the contents are wider than the panel.
                egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                    self.tab_ui(ui, commands);
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

    /// The contents of the selected tab.
    fn tab_ui(&mut self, ui: &mut egui::Ui, commands: &Commands) {
        match self.settings.tab {
            Tab::Inspect | Tab::Mesh | Tab::Trade if self.document.is_blank => {
                ui.label("No file is open.");
            }
            Tab::Inspect => {
                let is_busy = self.picking.is_some() || self.clicks.pending.is_some();
                let pick = self.pick.as_ref();
                let is_reading = self.face_lookup.is_some();
                let view = pick.map(|pick| pick.view(&self.document, is_reading));
                let selected = panels::inspect::inspect_ui(ui, view, is_busy, commands);
                if let Some((pick, crossing)) = self.pick.as_mut().zip(selected) {
                    pick.select(crossing);
                }
                let path = self.path_view();
                let selected = path.and_then(|path| panels::path::path_ui(ui, &path));
                if let Some(sample) = selected {
                    self.select_sample(sample);
                }
            }
            Tab::Display => {
                panels::view::view_ui(
                    ui,
                    &mut self.settings,
                    &mut self.turntable,
                    &self.document.loaded.scene.kernels(),
                    commands,
                );
            }
            Tab::Mesh => {
                let flaw = self.flaw.as_ref();
                let shown = panels::mesh::mesh_ui(ui, &mut self.document, flaw, commands);
                if let Some(shown) = shown {
                    self.show_flaw(shown);
                }
            }
            Tab::Trade => self.trade_ui(ui),
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
}

/// Shows the names of the tabs.
fn tabs_ui(ui: &mut egui::Ui, commands: &Commands) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        for tab in commands.at(TABS) {
            commands.choice_ui(ui, tab);
        }
    });
    ui.separator();
}

//! The side panel with its tabs.

use super::App;
use crate::command::{Commands, TABS};
use crate::panels;
use crate::preferences::PANEL_WIDTHS;
use crate::tab::Tab;
use crate::theme::panel_frame;
use crate::trade::Trade;
use egui::PanelState;
use glam::UVec2;

/// The panel's name in egui's memory.
const PANEL: &str = "panel";
/// Width in points that the panel leaves for the picture in a narrow window.
const NARROWEST_PICTURE: f32 = 120.0;
/// Width in points of the panel in the narrowest window.
const MIN_PANEL_WIDTH: f32 = 160.0;

impl App {
    pub(super) fn panel_ui(&mut self, ui: &mut egui::Ui, commands: &Commands) {
        let mut is_expanded = self.preferences.shows_panel;
        let (narrowest, widest) = (*PANEL_WIDTHS.start(), *PANEL_WIDTHS.end());
        let available = ui.available_width();
        // In a narrow window, the panel leaves some room for the picture; by default half of the window.
        let limit = (available - NARROWEST_PICTURE).clamp(MIN_PANEL_WIDTH, widest);
        let default = self.preferences.panel_width.min(0.5 * available);
        if self.shown.panel_room != available {
            // egui would keep the width of the narrowest window.
            (self.shown.panel_room, self.shown.settled_panel_width) = (available, None);
            let id = ui.scope_id().with(PANEL);
            ui.data_mut(|data| data.remove::<PanelState>(id));
        }
        let shown = egui::Panel::right(PANEL)
            .frame(panel_frame(ui.style()))
            .default_size(default)
            .size_range(narrowest.min(limit)..=limit)
            .show_collapsible(ui, &mut is_expanded, |ui| {
                tabs_ui(ui, commands);
                // In a narrow window the contents are wider than the panel.
                egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                    self.tab_ui(ui, commands);
                });
            });
        self.preferences.shows_panel = is_expanded;
        if let Some(shown) = shown {
            // The width changes from frame to frame while the panel slides in or out.
            let width = shown.response.rect.width();
            let is_settled = std::mem::replace(&mut self.shown.panel_width, width) == width;
            if is_settled && self.shown.settled_panel_width != Some(width) {
                // The first width in a window is the default; a later one is the user's.
                let is_own = self.shown.settled_panel_width.replace(width).is_some();
                if is_own && width < limit && PANEL_WIDTHS.contains(&width) {
                    self.preferences.panel_width = width;
                }
            }
        }
    }

    /// The contents of the selected tab.
    fn tab_ui(&mut self, ui: &mut egui::Ui, commands: &Commands) {
        match self.preferences.tab {
            Tab::Inspect | Tab::Parts | Tab::Mesh | Tab::Trade | Tab::Compare
                if self.open.document.is_blank =>
            {
                ui.label("No file is open.");
            }
            Tab::Inspect => {
                let view = self.picks_view();
                if let Some(change) = panels::picks::picks_ui(ui, &view, commands) {
                    self.change_picks(change, ui.ctx());
                }
                let is_busy = self.picked.picking.is_some() || self.picked.clicks.pending.is_some();
                let pick = self.picked.pick.as_ref();
                let is_reading = self.picked.face_lookup.is_some();
                let document = self.document_of(self.inspected_side());
                let view = pick.map(|pick| pick.view(document, is_reading));
                let selected = panels::inspect::inspect_ui(ui, view, is_busy, commands);
                if let Some((pick, crossing)) = self.picked.pick.as_mut().zip(selected) {
                    pick.select(crossing);
                }
                let path = self.path_view();
                let selected = path.and_then(|path| panels::path::path_ui(ui, &path));
                if let Some(sample) = selected {
                    self.select_sample(sample);
                }
            }
            Tab::Display => {
                let shown = panels::view::Shown {
                    shapes: self.open.document.loaded.scene.kernels(),
                    scale: self.colour_scale(),
                    extent: self.extent(),
                };
                let trade = self.open.trade.as_ref();
                let is_measuring =
                    panels::quality::quality_ui(ui, &mut self.seen.settings, trade, commands);
                if is_measuring {
                    self.preferences.tab = Tab::Trade;
                }
                ui.separator();
                panels::view::view_ui(
                    ui,
                    &mut self.seen.settings,
                    &mut self.seen.turntable,
                    &shown,
                    commands,
                );
            }
            Tab::Parts => self.parts_ui(ui, commands),
            Tab::Mesh => {
                let flaw = self.picked.flaw.as_ref();
                let shown = panels::mesh::mesh_ui(ui, &mut self.open.document, flaw, commands);
                if let Some(shown) = shown {
                    self.show_flaw(shown, ui.ctx());
                }
            }
            Tab::Trade => self.trade_ui(ui),
            Tab::Compare => self.compare_tab_ui(ui, commands),
        }
    }

    /// Measures the scene when the tab is first shown, and later only on request.
    fn trade_ui(&mut self, ui: &mut egui::Ui) {
        let is_wanted = match &mut self.open.trade {
            Some(trade) => {
                trade.poll();
                panels::trade::trade_ui(ui, trade, &mut self.seen.settings)
            }
            None if self.open.has_measured => panels::trade::measure_ui(ui),
            None => true,
        };
        // Requires the picture's camera and the final tree.
        let is_ready = self.shown.resolution != UVec2::ZERO && !self.seen.is_unframed;
        if is_wanted && is_ready && self.open.document.has_last_tree() {
            let camera = self.seen.turntable.camera(self.shown.resolution);
            let axis = self.open.trade.take().map(|trade| trade.axis);
            let scene = &self.open.document.loaded.scene;
            let axis = axis.unwrap_or_default();
            self.open.trade = Some(Trade::start(scene, camera, axis, ui.ctx()));
            self.open.has_measured = true;
        }
    }
}

/// Shows the names of the tabs.
fn tabs_ui(ui: &mut egui::Ui, commands: &Commands) {
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        for tab in commands.at(TABS) {
            commands.choice_ui(ui, tab);
        }
    });
    ui.separator();
}

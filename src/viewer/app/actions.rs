//! What keys and buttons do.

use super::App;
use crate::bindings::Action;
use hitscope_core::mesh::Flaw;
use std::path::Path;

impl App {
    pub(super) fn perform(&mut self, action: Action, ctx: &egui::Context, frame: &eframe::Frame) {
        match action {
            Action::Open => {
                let folder = self.document.path.as_deref().and_then(Path::parent);
                self.open_dialog.open(ctx, frame, folder);
            }
            Action::Reload => {
                if let Some(path) = self.document.path.clone() {
                    self.load(path, ctx);
                }
            }
            // From its direction the mesh can't be seen: a flat one edge-on.
            Action::Frame if self.shows_nothing() => self.use_default_view(),
            Action::Frame => {
                let bounds = self.document.loaded.scene.bounds();
                self.turntable.frame(bounds, self.resolution);
            }
            Action::ShowFlaw(flaw) => self.show_flaw(flaw),
            Action::ToggleWatch => self.settings.watches = !self.settings.watches,
            Action::LookFrom(view) => self.turntable.look_from(view),
            Action::ToggleOrthographic => {
                self.turntable.is_orthographic = !self.turntable.is_orthographic;
            }
            Action::ToggleTurning => self.is_turning = !self.is_turning,
            Action::ToggleWireframe => {
                self.settings.shows_wireframe = !self.settings.shows_wireframe;
            }
            Action::ToggleNormals => self.settings.shows_normals = !self.settings.shows_normals,
            Action::ToggleSmooth => self.settings.is_smooth = !self.settings.is_smooth,
            Action::TogglePause => self.tracer.toggle_pause(),
            Action::TogglePanel => self.settings.shows_panel = !self.settings.shows_panel,
            Action::ToggleHelp => self.shows_help = !self.shows_help,
            Action::Dismiss => self.dismiss(),
        }
        ctx.request_repaint();
    }

    /// Marks flaws and shows them, with what surrounds them.
    fn show_flaw(&mut self, flaw: Option<Flaw>) {
        self.flaw = flaw;
        if let (Some(flaw), Some(findings)) = (flaw, self.document.known_findings()) {
            let scene = &self.document.loaded.scene;
            let around = findings.health.bounds(flaw);
            let bounds = around.unwrap_or(scene.bounds());
            self.turntable.frame(bounds, self.resolution);
        }
    }

    /// Ends a load, or closes the topmost thing that can be closed.
    fn dismiss(&mut self) {
        if let Some(loading) = &self.loading {
            loading.cancel();
            return;
        }
        let is_closed = std::mem::take(&mut self.shows_help)
            || self.open_dialog.dismiss()
            || self.notice.take().is_some();
        if !is_closed && self.flaw.take().is_none() {
            (self.pick, self.picking) = (None, None);
        }
    }
}

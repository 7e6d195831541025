//! The actions of keys and buttons.

use super::App;
use crate::bindings::Action;
use crate::flaw_place::FlawPlace;
use crate::overlay::wireframe::WIREFRAME;
use crate::saving::{NotSaved, suggested_path};
use hitscope_core::mesh::Flaw;

/// Distance of the camera from a flaw, relative to the distance that frames the triangles there.
const FLAW_DISTANCE: f64 = 3.0;

impl App {
    pub(super) fn perform(&mut self, action: Action, ctx: &egui::Context, frame: &eframe::Frame) {
        match action {
            Action::Open => {
                let near = self.document.path.as_deref();
                self.open_dialog.open(ctx, frame, near);
            }
            Action::Save if self.document.path.is_none() => self.error(NotSaved::BuiltIn),
            Action::Save => {
                let suggested = suggested_path(&self.document);
                self.save_dialog.open(ctx, frame, suggested.as_deref());
            }
            Action::OpenEnvironment => {
                let near = self.document.path.as_deref();
                self.environment_dialog.open(ctx, frame, near);
            }
            Action::Reload => {
                if let Some(path) = self.document.path.clone() {
                    self.load(path, ctx);
                }
            }
            Action::Frame => self.frame(),
            Action::StepCrossing(step) => {
                if let Some(pick) = &mut self.pick {
                    pick.step(step);
                }
            }
            Action::SetUpAxis(axis) => self.settings.keep_up_axis(axis),
            Action::ShowFlaw(flaw) => self.show_flaw(flaw),
            Action::ToggleWatch => self.settings.watches = !self.settings.watches,
            Action::LookFrom(view) => self.turntable.look_from(view),
            Action::ToggleOrthographic => {
                self.turntable.is_orthographic = !self.turntable.is_orthographic;
            }
            Action::ToggleRotation => self.is_rotating = !self.is_rotating,
            Action::ToggleWireframe => {
                self.settings.overlays.toggle(&WIREFRAME);
            }
            Action::ToggleNormals => self.settings.toggle_normals(),
            Action::ToggleSmooth => self.settings.is_smooth = !self.settings.is_smooth,
            Action::ToggleNoise => self.settings.shows_noise = !self.settings.shows_noise,
            Action::TogglePause => self.tracer.toggle_pause(),
            Action::TogglePanel => self.settings.shows_panel = !self.settings.shows_panel,
            Action::ToggleHelp => self.shows_help = !self.shows_help,
            Action::Dismiss => self.dismiss(),
        }
        ctx.request_repaint();
    }

    /// Marks the flaws of a kind and frames the triangles around one of them; `None` clears the mark.
    fn show_flaw(&mut self, shown: Option<(Flaw, usize)>) {
        let findings = self.document.known_findings();
        self.flaw = shown.zip(findings).and_then(|((flaw, index), findings)| {
            let scene = &self.document.loaded.scene;
            FlawPlace::find(scene.mesh(), &findings.health, flaw, index)
        });
        if let Some(place) = &self.flaw {
            self.turntable.frame(place.bounds, self.resolution);
            // Shows some of the surface around it.
            self.turntable.distance *= FLAW_DISTANCE;
        }
    }

    /// Cancels loading, closes the topmost message or window, clears the marked flaw, or clears the pick: the first
    /// of these that applies.
    fn dismiss(&mut self) {
        if let Some(loading) = &self.loading {
            loading.cancel();
            return;
        }
        let is_closed = std::mem::take(&mut self.shows_help)
            || self.open_dialog.dismiss()
            || self.save_dialog.dismiss()
            || self.environment_dialog.dismiss()
            || self.notice.take().is_some();
        if !is_closed && self.flaw.take().is_none() {
            (self.pick, self.picking, self.face_lookup) = (None, None, None);
            self.clicks.pending = None;
        }
    }
}

//! Sessions, and undo and redo of what they hold.

use super::App;
use super::pick::Pick;
use crate::document::Document;
use crate::history::Gesture;
use crate::saving::Saving;
use crate::session::{PickedPixel, Session, Sight, Viewpoint};
use crate::task::Task;
use std::path::{Path, PathBuf};

impl App {
    /// How the document is seen now.
    pub fn sight(&self) -> Sight {
        Sight {
            camera: self.viewpoint(),
            settings: self.seen.settings.clone(),
            comparison: self.seen.comparison.clone(),
            parts: self.seen.parts.choice().clone(),
            picks: self.picked_pixel().into_iter().collect(),
        }
    }

    fn viewpoint(&self) -> Viewpoint {
        let origin = self.open.document.loaded.scene.mesh().origin();
        Viewpoint::of(&self.seen.turntable, origin)
    }

    /// The pixel that is picked, or will be once it is inspected.
    fn picked_pixel(&self) -> Option<PickedPixel> {
        let origin = self.open.document.loaded.scene.mesh().origin();
        let pick = self.picked.pick.as_ref();
        let of_pick = |pick: &Pick| {
            let pixel = pick.inspection.pixel.into();
            PickedPixel::new(&pick.camera, pixel, pick.crossing(), origin)
        };
        let picked = match &self.picked.picking {
            Some(picking) => {
                let crossing = picking.crossing(pick);
                let (camera, pixel) = (&picking.camera, picking.pixel);
                Some(PickedPixel::new(camera, pixel, crossing, origin))
            }
            None => pick.map(of_pick),
        };
        picked.map(|picked| picked.on(self.picked.side))
    }

    /// Shows the document as it was seen.
    fn restore(&mut self, sight: &Sight, ctx: &egui::Context) {
        let scene = &self.open.document.loaded.scene;
        let origin = scene.mesh().origin();
        self.seen.turntable = sight.camera.turntable(scene);
        self.seen.settings = sight.settings.clone();
        self.seen.comparison = sight.comparison.clone();
        if *self.seen.parts.choice() != sight.parts {
            self.seen.parts.choose(sight.parts.clone());
        }
        (self.seen.is_unframed, self.seen.is_rotating) = (false, false);
        let wanted = sight.picks.first();
        if self.picked_pixel().as_ref() != wanted {
            self.picked.clear_pick();
            let camera = wanted.and_then(|pick| Some((pick, pick.camera(origin).ok()?)));
            if let Some((pick, camera)) = camera {
                self.picked.side = pick.side;
                self.start_picking(camera, pick.pixel(), pick.crossing, ctx);
            }
        }
        ctx.request_repaint();
    }

    /// Notes a step of undo if what is seen has changed. Called at the end of each frame.
    pub(super) fn note_step(&mut self, ctx: &egui::Context) {
        if self.seen.is_unframed || self.open.document.is_blank {
            return;
        }
        let (is_pressed, is_wheel, secs) = ctx.input(|input| {
            let pointer = &input.pointer;
            let is_wheel =
                input.smooth_scroll_delta() != egui::Vec2::ZERO || input.zoom_delta() != 1.0;
            let is_pressed = pointer.any_down() || pointer.any_released();
            (is_pressed, is_wheel, input.time)
        });
        let gesture = if is_pressed || self.seen.is_rotating {
            Some(Gesture::Motion)
        } else {
            is_wheel.then_some(Gesture::Wheel)
        };
        // Most frames change nothing; comparing is cheaper than copying.
        let is_same = self.history.now().is_some_and(|now| {
            now.settings == self.seen.settings
                && now.comparison == self.seen.comparison
                && now.parts == *self.seen.parts.choice()
                && now.camera == self.viewpoint()
                && now.picks.first() == self.picked_pixel().as_ref()
        });
        if is_same {
            self.history.rest(gesture, secs);
        } else {
            self.history.note(self.sight(), gesture, secs);
        }
    }

    /// Why nothing can be undone; `None` if a step can.
    pub(crate) fn lacks_undo(&self) -> Option<&'static str> {
        (!self.history.can_undo()).then_some("Nothing to undo")
    }

    /// Why nothing can be redone; `None` if a step can.
    pub(crate) fn lacks_redo(&self) -> Option<&'static str> {
        (!self.history.can_redo()).then_some("Nothing to redo")
    }

    /// Undoes the last step.
    pub(crate) fn undo(&mut self, ctx: &egui::Context) {
        if let Some(sight) = self.history.undo() {
            self.restore(&sight, ctx);
            self.history.absorb();
        }
    }

    /// Redoes the step that was undone last.
    pub(crate) fn redo(&mut self, ctx: &egui::Context) {
        if let Some(sight) = self.history.redo() {
            self.restore(&sight, ctx);
            self.history.absorb();
        }
    }

    /// Writes the session to a file.
    pub(super) fn save_session(&mut self, path: &Path, ctx: &egui::Context) {
        let session = Session::new(
            self.open.document.path.clone(),
            self.sight(),
            self.preferences.shows_panel,
            self.preferences.tab,
        );
        match Saving::start_session(session, path, ctx) {
            Ok(saving) => self.open.saving = Some(saving),
            Err(error) => self.error(error),
        }
    }

    /// Reads a session file in the background.
    pub(super) fn read_session(&mut self, path: PathBuf, ctx: &egui::Context) {
        self.open.session_path.clone_from(&path);
        let read = move || Session::read(&path);
        self.open.session = Some(Task::spawn("session", ctx, read));
    }

    /// Opens the session that was read: its file, unless that is open, and then shows it as it was seen.
    pub(super) fn poll_session(&mut self, ctx: &egui::Context) {
        let session = match self.open.session.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(session))) => session,
            Some(Err(panicked)) => Err(panicked.to_string()),
        };
        self.open.session = None;
        let session = match session {
            Ok(session) => session,
            Err(message) => {
                if let Some(screenshot) = &self.screenshot {
                    screenshot.fail(ctx, message.clone());
                }
                self.error(message);
                return;
            }
        };
        let absolute = |path: &PathBuf| std::path::absolute(path).ok();
        let open = self.open.document.path.as_ref().and_then(absolute);
        match session.file.clone() {
            file if !self.open.document.is_blank && open == file => self.use_session(&session, ctx),
            None => {
                let document = Document::embedded(session.sight.settings.kernel());
                self.show(document, ctx);
                self.use_session(&session, ctx);
            }
            Some(file) => {
                self.load(file, ctx);
                self.open.loading_session = Some(session);
            }
        }
    }

    /// Shows the open document as a session saw it.
    pub(super) fn use_session(&mut self, session: &Session, ctx: &egui::Context) {
        self.restore(&session.sight, ctx);
        self.preferences.shows_panel = session.shows_panel;
        self.preferences.tab = session.tab;
    }
}

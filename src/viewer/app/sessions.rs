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
            picks: self.listed_picks().collect(),
            snapping: self.snapping(),
        }
    }

    fn viewpoint(&self) -> Viewpoint {
        let origin = self.open.document.loaded.scene.mesh().origin();
        Viewpoint::of(&self.seen.turntable, origin)
    }

    /// The list of picks.
    fn listed_picks(&self) -> impl ExactSizeIterator<Item = PickedPixel> {
        let origin = self.open.document.origin();
        let picks = &self.picked.inspecting.picks;
        picks.list.iter().map(move |pick| {
            let listed = PickedPixel::new(pick, origin);
            if picks.selected == Some(pick.number) {
                listed.selected(self.chosen_crossing())
            } else {
                listed
            }
        })
    }

    /// The crossing that is marked instead of the hit, or will be once the pick is inspected.
    fn chosen_crossing(&self) -> Option<usize> {
        let pick = self.picked.pick.as_ref();
        match &self.picked.picking {
            Some(picking) => picking.crossing(pick),
            None => pick.and_then(Pick::crossing),
        }
    }

    fn lists_picks(&self, picks: &[PickedPixel]) -> bool {
        let listed = self.listed_picks();
        listed.len() == picks.len() && listed.zip(picks).all(|(pick, other)| pick == *other)
    }

    /// Shows the document as it was seen.
    fn restore(&mut self, sight: &Sight, ctx: &egui::Context) {
        let scene = &self.open.document.loaded.scene;
        self.seen.turntable = sight.camera.turntable(scene);
        self.seen.settings = sight.settings.clone();
        self.seen.comparison = sight.comparison.clone();
        if *self.seen.parts.choice() != sight.parts {
            self.seen.parts.choose(sight.parts.clone());
        }
        (self.seen.is_unframed, self.seen.is_rotating) = (false, false);
        self.picked.inspecting.picks.snapping = sight.snapping;
        self.restore_picks(&sight.picks, ctx);
        ctx.request_repaint();
    }

    /// Replaces the list of picks, and inspects the one that is selected.
    fn restore_picks(&mut self, wanted: &[PickedPixel], ctx: &egui::Context) {
        if self.lists_picks(wanted) {
            return;
        }
        let inspected = self.listed_picks().find(|pick| pick.is_selected);
        let origin = self.open.document.origin();
        let usable = |pick: &PickedPixel| Some((pick.clone(), pick.in_scene(origin).ok()?));
        let (plain, picks): (Vec<_>, Vec<_>) = wanted.iter().filter_map(usable).unzip();
        self.picked.inspecting.picks.restore(picks);
        let selected = plain.iter().position(|pick| pick.is_selected);
        let selected = selected.map(|index| {
            let listed = &self.picked.inspecting.picks.list[index];
            (&plain[index], listed.number, listed.camera)
        });
        let is_same = match (&inspected, selected) {
            (Some(old), Some((new, ..))) => old.is_inspected_as(new),
            (old, new) => old.is_none() && new.is_none(),
        };
        if !is_same {
            self.picked.clear_pick();
        }
        let Some((plain, number, camera)) = selected else {
            return;
        };
        self.picked.inspecting.picks.selected = Some(number);
        if !is_same {
            self.picked.side = plain.side;
            self.start_picking(camera, plain.pixel(), plain.crossing, ctx);
        }
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
        } else if self.navigation.is_changing_view() {
            Some(Gesture::Transition)
        } else if is_wheel {
            Some(Gesture::Wheel)
        } else {
            ctx.text_edit_focused().then_some(Gesture::Typing)
        };
        // Most frames change nothing; comparing is cheaper than copying.
        let is_same = self.history.now().is_some_and(|now| {
            now.settings == self.seen.settings
                && now.comparison == self.seen.comparison
                && now.parts == *self.seen.parts.choice()
                && now.camera == self.viewpoint()
                && now.snapping == self.snapping()
                && self.lists_picks(&now.picks)
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
                if let Some(screenshot) = &mut self.screenshot {
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

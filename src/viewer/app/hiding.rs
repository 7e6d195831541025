//! Hidden parts: their commands, and their use in the document.

use super::App;
use super::pick::Pick;
use crate::clip_choice::{ClipChoice, ClipShape};
use crate::parts::{Grouping, PartChange, Parts, PartsChoice};

impl App {
    /// Shows only the chosen parts, as soon as they are found and a tree over them is built. Returns whether building
    /// begins now.
    pub(super) fn use_parts(&mut self, ctx: &egui::Context) -> bool {
        let parts = &mut self.seen.parts;
        if let Err(panicked) = parts.update(&self.open.document.loaded.scene, ctx) {
            self.error(panicked);
            return false;
        }
        let begins = self.open.document.use_primitives(parts.shown(), ctx);
        if self.open.document.shows(parts.shown()) {
            parts.note_applied();
        }
        begins
    }

    /// Collects the tree over the chosen parts. If building it failed, everything is shown.
    pub(super) fn poll_parts(&mut self, ctx: &egui::Context) {
        if let Err(panicked) = self.open.document.poll_primitives(ctx) {
            self.seen.parts.show_all();
            self.error(panicked);
        }
    }

    /// Stops building a tree over the chosen parts, and goes back to those that are shown.
    pub(super) fn cancel_parts(&mut self) {
        self.open.document.cancel_primitives();
        self.seen.parts.revert();
    }

    /// The parts of the scene.
    pub fn parts(&self) -> &Parts {
        &self.seen.parts
    }

    /// Shows all of a new document. After a reload of the same file, the clip and the choices about parts with the same
    /// names stay instead. The grouping always stays.
    pub(super) fn forget_shown_part(&mut self, is_same_file: bool) {
        let parts = std::mem::take(&mut self.seen.parts);
        let choice = if is_same_file {
            parts.choice().clone()
        } else {
            PartsChoice::default()
        };
        self.seen.parts = Parts::by(parts.grouping, choice);
        self.seen.parts.filter = parts.filter;
        if !is_same_file {
            self.seen.settings.clip = ClipChoice::default();
            self.seen.settings.colours.scales.clear();
        }
    }

    /// Shows the tab *Parts*.
    pub(super) fn parts_ui(&mut self, ui: &mut egui::Ui, commands: &crate::command::Commands) {
        let picked = self.picked.pick.as_ref().and_then(Pick::marked_primitive);
        crate::panels::parts::parts_ui(ui, &mut self.seen.parts, picked, commands);
    }

    fn change_picked_part(&mut self, change: PartChange) {
        if let Some(picked) = self.picked.pick.as_ref().and_then(Pick::marked_primitive) {
            self.seen.parts.change_part_of(picked, change);
        }
    }

    /// Hides the part of the picked primitive.
    pub(crate) fn hide_picked_part(&mut self) {
        self.change_picked_part(PartChange::Hide);
    }

    /// Shows the part of the picked primitive alone.
    pub(crate) fn show_only_picked_part(&mut self) {
        self.change_picked_part(PartChange::ShowOnly);
    }

    /// Shows all parts.
    pub(crate) fn show_all_parts(&mut self) {
        self.seen.parts.show_all();
    }

    /// Shows the hidden parts and hides the others.
    pub(crate) fn invert_parts(&mut self) {
        self.seen.parts.invert();
    }

    /// Why no part can be shown; `None` if some are hidden.
    pub(crate) fn lacks_hidden_part(&self) -> Option<&'static str> {
        let all = self.seen.parts.shown().0.is_none();
        all.then_some("No part is hidden")
    }

    /// Why nothing can be shown again; `None` if a clip or hidden parts remove something.
    pub(crate) fn lacks_hidden_surface(&self) -> Option<&'static str> {
        let is_clipped = self.seen.settings.clip.shape != ClipShape::None;
        let is_whole = !is_clipped && self.lacks_hidden_part().is_some();
        is_whole.then_some("Neither a clip nor hidden parts remove anything")
    }

    /// Turns the clip off and shows all parts.
    pub(crate) fn show_everything(&mut self) {
        self.seen.settings.clip.shape = ClipShape::None;
        self.seen.parts.show_all();
    }

    /// Groups the parts in another way.
    pub(crate) fn group_parts_by(&mut self, grouping: Grouping) {
        self.seen.parts.group_by(grouping);
    }
}

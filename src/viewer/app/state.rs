//! The parts of the state that other modules and tests read.

use super::App;
use crate::document::Document;
use crate::flaw_place::FlawPlace;
use crate::preferences::Preferences;
use crate::settings::Settings;
use crate::tracer::Request;
use crate::trade::Trade;
use glam::DVec3;
use hitscope_core::camera::Turntable;
use hitscope_core::{Film, Scene};
use hitscope_lab::inspection::{Inspection, PathReport};
use std::sync::Arc;
use std::time::Duration;

impl App {
    /// The film of the picture being traced.
    pub fn film(&self) -> &Film {
        self.traced.tracer.film()
    }

    /// Whether the picture has all samples or has reached a limit, the overlay has all lines, and nothing is being
    /// loaded.
    pub fn is_settled(&self) -> bool {
        let is_wanted = |request: &Request| {
            Arc::ptr_eq(&request.context.scene, &self.open.document.loaded.scene)
                && request.shows_last_tree == self.shows_last_tree()
        };
        self.open.loading.is_none()
            && self.open.session.is_none()
            && !self.is_loading_environment()
            && !self.traced.lights.is_pending()
            && self.open.document.has_last_tree()
            && !self.seen.parts.is_stale()
            && self.open.document.shows(self.seen.parts.shown())
            && self.traced.tracer.posted().is_some_and(is_wanted)
            && self.traced.tracer.is_finished()
            && self.traced.overlay.is_complete()
            && self.is_comparison_settled()
    }

    /// Whether the view shows the cost of rays in the final tree.
    pub(super) fn shows_last_tree(&self) -> bool {
        self.seen.settings.view().needs.final_tree && self.open.document.has_last_tree()
    }

    /// The scene of the picture.
    pub fn traced_scene(&self) -> Option<&Scene> {
        let posted = self.traced.tracer.posted()?;
        Some(&posted.context.scene)
    }

    /// Whether auto-rotation is on.
    pub fn is_rotating(&self) -> bool {
        self.seen.is_rotating
    }

    /// Whether the user has paused refinement.
    pub fn is_paused(&self) -> bool {
        self.traced.tracer.is_paused()
    }

    /// How the scene is shown.
    pub fn settings(&self) -> &Settings {
        &self.seen.settings
    }

    /// The preferences of the window.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// The open document.
    pub fn document(&self) -> &Document {
        &self.open.document
    }

    /// The camera.
    pub fn turntable(&self) -> &Turntable {
        &self.seen.turntable
    }

    /// The inspection of the picked pixel.
    pub fn inspection(&self) -> Option<&Inspection> {
        self.picked.pick.as_ref().map(|pick| &*pick.inspection)
    }

    /// The path of a sample of the picked pixel, if the view follows paths.
    pub fn path(&self) -> Option<&PathReport> {
        self.picked.path.followed().map(|path| &path.report)
    }

    /// The crossing of the picked ray that is marked, counted from 0.
    pub fn crossing(&self) -> Option<usize> {
        self.picked.pick.as_ref()?.selected()
    }

    /// Where the picked ray is marked, in the scene's coordinates.
    pub fn marked_point(&self) -> Option<DVec3> {
        self.picked.pick.as_ref()?.point()
    }

    /// The flaw that is shown; all of its kind are marked.
    pub fn flaw(&self) -> Option<&FlawPlace> {
        self.picked.flaw.as_ref()
    }

    /// The measurement of this scene, if it was started.
    pub fn trade(&self) -> Option<&Trade> {
        self.open.trade.as_ref()
    }

    /// The text of the message that is shown.
    pub fn notice(&self) -> Option<&str> {
        self.feedback
            .notice
            .as_ref()
            .map(|notice| notice.text.as_str())
    }

    /// The time from the start of the program to the first traced picture on the screen; `None` before it.
    pub fn first_picture(&self) -> Option<Duration> {
        self.shown.first_picture.after()
    }

    /// The picture's place in the window, in points.
    pub fn canvas_rect(&self) -> egui::Rect {
        self.shown.canvas_rect
    }

    /// The number of errors that the graphics device has reported.
    pub fn graphics_errors(&self) -> usize {
        self.faults.count()
    }

    /// The texts of the toasts that are shown.
    pub fn toasts(&self) -> Vec<&str> {
        self.feedback.toasts.texts()
    }
}

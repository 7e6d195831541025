//! Pauses of refinement: by the user, at a limit, and until nothing has changed for a while.

use super::{Limits, Tracer};
use std::time::Duration;

/// Refinement begins when nothing has changed for this long. Until then the CPU is free to draw the window, which
/// takes most of its time without a GPU.
pub(super) const REST: Duration = Duration::from_millis(80);

impl Tracer {
    /// Starts refinement, or the view after its preview, once nothing has changed for a while.
    pub(super) fn end_hold(&mut self, ctx: &egui::Context) {
        if !self.is_held {
            return;
        }
        let since = self
            .posted
            .as_ref()
            .map_or(REST, |posted| posted.at.elapsed());
        let is_preview = self.posted.as_ref().is_some_and(|posted| posted.is_preview);
        if since < REST {
            ctx.request_repaint_after(REST - since);
        } else if !is_preview {
            self.is_held = false;
            self.apply_pause();
        } else if self.film.passes_done() > 0 {
            self.is_held = false;
            self.begin_view();
        }
    }

    /// Ends refinement if a limit is reached, also in the middle of a pass, but not before the first one is done.
    pub(super) fn check_limits(&mut self) {
        if let (None, Some(posted)) = (self.stopped, &self.posted)
            && posted.is_lit()
            && self.film.passes_done() > 0
            && !self.film.is_complete()
        {
            let secs = posted.refined.elapsed().as_secs_f64();
            let (samples, noise) = (self.film.samples(), self.noise.total());
            self.stopped = self.limits.reached(secs, samples, noise);
            self.apply_pause();
        }
    }

    /// Requests a frame for the end of the time limit, because no tile may arrive until then.
    pub(super) fn await_time_limit(&self, ctx: &egui::Context) {
        if let (Some(limit), Some(posted)) = (self.limits.secs, &self.posted)
            && posted.is_lit()
            && !self.is_paused
            && !self.is_finished()
        {
            let left = limit - posted.refined.elapsed().as_secs_f64();
            // At least a millisecond; at most a day, the largest time limit that can be set.
            ctx.request_repaint_after(Duration::from_secs_f64(left.clamp(0.001, 86_400.0)));
        }
    }

    /// Sets the conditions that end refinement.
    pub fn set_limits(&mut self, limits: Limits) {
        if self.limits != limits {
            (self.limits, self.stopped) = (limits, None);
            self.check_limits();
            self.apply_pause();
        }
    }

    /// Whether the user has paused refinement.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Pauses or resumes refinement.
    pub fn toggle_pause(&mut self) {
        self.is_paused = !self.is_paused;
        self.apply_pause();
    }

    pub(super) fn apply_pause(&mut self) {
        if let Some(posted) = &mut self.posted {
            let is_running = !self.is_paused && self.stopped.is_none();
            posted.refined.run(is_running);
        }
        if self.is_paused || self.is_held || self.stopped.is_some() {
            self.renderer.pause();
        } else {
            self.renderer.resume();
        }
    }
}

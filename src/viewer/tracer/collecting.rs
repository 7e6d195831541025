//! Collecting of tiles, at the start of a frame and after its request.

use super::Tracer;
use hitscope_core::integrator::Context;
use hitscope_core::render::{Message, RenderPanic};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time limit for collecting tiles in one frame.
const COLLECTING: Duration = Duration::from_millis(6);
/// Longest time for which a frame waits for the first pass of its request. Most passes while the camera moves are
/// quicker, and a frame that doesn't wait shows its picture a whole frame later: with 2 cores and lavapipe, the 99th
/// percentile from input to picture was 36 ms, and 49 ms without waiting (1.1 million triangles, 1280 × 720, 2026-11).
const WAITING: Duration = Duration::from_millis(10);

impl Tracer {
    /// Collects the tiles that the threads have sent. Returns panics.
    pub fn collect(&mut self, ctx: &egui::Context) -> Vec<RenderPanic> {
        let start = Instant::now();
        let mut panics = Vec::new();
        while let Some(message) = self.renderer.try_next() {
            panics.extend(self.receive(message));
            if start.elapsed() > COLLECTING {
                // The remaining tiles are collected in the next frame.
                ctx.request_repaint();
                break;
            }
        }
        self.note_progress(ctx);
        panics
    }

    /// Waits for the first pass of the posted request, if it is quick. Returns panics.
    pub fn await_first_pass(&mut self, ctx: &egui::Context) -> Vec<RenderPanic> {
        let mut panics = Vec::new();
        if !self.is_first_pass_quick() {
            return panics;
        }
        let deadline = Instant::now() + WAITING;
        while self.film.passes_done() == 0
            && let Some(message) = self.renderer.next_before(deadline)
        {
            panics.extend(self.receive(message));
        }
        self.note_progress(ctx);
        panics
    }

    /// Whether the first pass isn't complete, and is expected to take at most [`WAITING`].
    pub(super) fn is_first_pass_quick(&self) -> bool {
        self.posted.is_some()
            && self.film.passes_done() == 0
            && self
                .expected_time(self.film.plan(), self.is_lit())
                .is_some_and(|time| time <= WAITING)
    }

    /// Adds a tile to the film, or returns a panic.
    fn receive(&mut self, message: Message) -> Option<RenderPanic> {
        match message {
            Message::Tile(tile) => {
                self.add(tile);
                None
            }
            Message::Panicked(unit, panic) => {
                self.film.skip(unit);
                Some(panic)
            }
        }
    }

    /// Notes what the tiles that were added have completed.
    fn note_progress(&mut self, ctx: &egui::Context) {
        self.check_limits();
        if self.film.passes_done() > 0 {
            self.shows_lit = self.is_lit();
        }
        self.note_luminance();
        if self.film.passes_done() > 0
            && let Some(posted) = &self.posted
            && !self.is_shown(&posted.request.context)
        {
            let Context { scene, camera, .. } = &posted.request.context;
            self.shown = Some((Arc::clone(scene), *camera));
            self.count_frame();
        }
        self.end_hold(ctx);
        self.await_time_limit(ctx);
    }
}

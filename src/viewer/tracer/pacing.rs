//! The pace of pictures: how coarse the first pass has to be, so that frames meet their target.

use super::Tracer;
use glam::UVec2;
use hitscope_core::plan::{Plan, STEPS};
use std::ops::{Range, RangeInclusive};
use std::time::{Duration, Instant};

/// Target time of a frame while the camera moves. The slowest frames in a hundred take some 10 ms longer, and shall take
/// at most 33 ms.
pub(super) const FRAME: Range<Duration> = Duration::from_millis(20)..Duration::from_millis(25);
/// Time of the first pass within a frame. Drawing the window takes almost no time with a GPU, and half of the frame
/// without one.
pub(super) const FIRST_PASS: RangeInclusive<Duration> =
    Duration::from_millis(4)..=Duration::from_millis(16);
/// A picture that stays longer than this ends a movement.
pub(super) const LOOK: Duration = Duration::from_millis(250);
/// Rays per second per thread, until they are measured.
const ASSUMED_SPEED: f64 = 1e6;

/// The number of rays of a first pass with blocks of `step` pixels.
fn rays_of_pass(size: UVec2, step: u32) -> f64 {
    size.as_dvec2().element_product() / f64::from(step * step)
}

impl Tracer {
    /// Records the time since the previous picture.
    pub(super) fn count_frame(&mut self) {
        let now = Instant::now();
        let interval = self.shown_at.map(|last| now - last);
        self.shown_at = Some(now);
        match interval {
            Some(interval) if !self.has_rested => {
                self.frame_intervals.push(interval);
                self.adapt(interval);
            }
            // A new movement begins after a rest.
            _ => self.frame_intervals.clear(),
        }
    }

    /// Adjusts the time of the first pass to the time that the last frame took.
    pub(super) fn adapt(&mut self, interval: Duration) {
        let factor = if interval > FRAME.end {
            0.9
        } else if interval < FRAME.start {
            1.05
        } else {
            return;
        };
        let wanted = self.first_pass.mul_f64(factor);
        self.first_pass = wanted.clamp(*FIRST_PASS.start(), *FIRST_PASS.end());
    }

    /// Sets the block size of the first pass of previews and of views that need no lights; `None` adapts it to the speed.
    pub fn set_first_step(&mut self, step: Option<u32>) {
        self.chosen_step = step;
    }

    /// The block size of the first pass.
    pub(super) fn first_step(&self, size: UVec2, is_lit: bool) -> u32 {
        let chosen = self.chosen_step.filter(|_| !is_lit);
        chosen.unwrap_or_else(|| self.affordable_step(size, is_lit))
    }

    /// The smallest block size with which the first pass is fast enough.
    pub(super) fn affordable_step(&self, size: UVec2, is_lit: bool) -> u32 {
        let speed = self.speeds[usize::from(is_lit)].rays_per_s();
        let affordable =
            self.of_all_threads(speed.unwrap_or(ASSUMED_SPEED)) * self.first_pass.as_secs_f64();
        let is_affordable = |step: &u32| rays_of_pass(size, *step) <= affordable;
        let coarsest = STEPS[STEPS.len() - 1];
        STEPS.into_iter().find(is_affordable).unwrap_or(coarsest)
    }

    /// The time that a plan's first pass will take; `None` while the speed isn't known.
    pub(super) fn expected_time(&self, plan: &Plan, is_lit: bool) -> Option<Duration> {
        let speed = self.speeds[usize::from(is_lit)].rays_per_s()?;
        let rays = rays_of_pass(plan.size(), plan.first_step());
        Duration::try_from_secs_f64(rays / self.of_all_threads(speed)).ok()
    }

    /// The speed of all threads together.
    pub(super) fn of_all_threads(&self, rays_per_s: f64) -> f64 {
        rays_per_s * self.renderer.thread_count() as f64
    }
}

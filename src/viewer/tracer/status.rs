//! Figures for the status line.

use super::{StopReason, Tracer};
use hitscope_core::film::Noise;
use std::time::Duration;

/// Figures for the status line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Status {
    /// Whether the preview of a view that needs lights is being traced.
    pub is_preview: bool,
    /// Number of samples that every pixel has; 0 while the picture consists of coarse blocks.
    pub samples: u32,
    /// Passes done.
    pub passes: usize,
    /// Total number of passes.
    pub pass_count: usize,
    /// Rays per second of all threads together, while they are tracing.
    pub rays_per_s: f64,
    /// Time from the last change to the newest tile.
    pub lasted: Duration,
    /// Time between the pictures of the last movement: median and 99th percentile.
    pub frame_interval: Option<[Duration; 2]>,
    /// The noise of a view that needs lights; `None` while a pixel has fewer than two samples.
    pub noise: Option<Noise>,
    /// Why refinement has ended before all samples were traced.
    pub stopped: Option<StopReason>,
}

impl Tracer {
    /// Figures for the status line.
    pub fn status(&self) -> Status {
        let speed = &self.speeds[usize::from(self.is_lit())];
        Status {
            is_preview: self.posted.as_ref().is_some_and(|posted| posted.is_preview),
            samples: self.film.samples(),
            passes: self.film.passes_done(),
            pass_count: self.film.plan().pass_count(),
            rays_per_s: self.of_all_threads(speed.rays_per_s().unwrap_or(0.0)),
            lasted: self
                .posted
                .as_ref()
                .map_or(Duration::ZERO, |posted| posted.lasted),
            frame_interval: self.frame_intervals.median_and_99th(),
            noise: self.noise.total(),
            stopped: self.stopped,
        }
    }
}

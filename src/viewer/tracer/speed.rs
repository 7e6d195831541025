//! The measured speed of a thread.

use std::time::Duration;

/// Rays that a thread traces, and the time that it takes, both with an exponential decay.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Speed {
    /// Number of rays.
    pub rays: f64,
    /// Seconds of one thread.
    pub busy_secs: f64,
}

impl Speed {
    /// Adds a measurement.
    pub fn add(&mut self, rays: u32, busy: Duration) {
        /// Half-life of the measurements, in seconds of one thread.
        const MEMORY_SECS: f64 = 0.5;
        let busy = busy.as_secs_f64();
        let fade = (-busy / MEMORY_SECS).exp2();
        self.rays = self.rays * fade + f64::from(rays);
        self.busy_secs = self.busy_secs * fade + busy;
    }

    /// Rays per second; `None` before the first measurement.
    pub fn rays_per_s(&self) -> Option<f64> {
        (self.busy_secs > 0.0).then(|| self.rays / self.busy_secs)
    }
}

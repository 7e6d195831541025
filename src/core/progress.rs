//! Progress and cancellation of a load.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

/// A phase of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Phase {
    /// Reading and parsing the file.
    Reading,
    /// Triangulating polygons and checking triangles.
    Checking,
    /// Building the tree.
    Building,
}

impl Phase {
    /// All phases, in their order.
    pub const ALL: [Self; 3] = [Self::Reading, Self::Checking, Self::Building];

    /// Label for the progress bar.
    pub fn label(self) -> &'static str {
        match self {
            Self::Reading => "Reading",
            Self::Checking => "Checking triangles",
            Self::Building => "Building the tree",
        }
    }
}

/// Progress of one load, shared by the loading thread and the thread that waits for it. Clones refer to the
/// same load.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    bytes_read: AtomicU64,
    bytes_total: AtomicU64,
    /// Steps of the phase after reading; no total if they aren't counted.
    steps_done: AtomicU64,
    steps_total: AtomicU64,
    phase: AtomicU8,
    cancelled: AtomicBool,
}

/// Error: the load was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Progress {
    /// Bytes read so far and in total.
    pub fn bytes(&self) -> (u64, u64) {
        (
            self.0.bytes_read.load(Relaxed),
            self.0.bytes_total.load(Relaxed),
        )
    }

    /// The part of the current phase that is done, from 0 to 1; `None` if it isn't known.
    pub fn part_of_phase(&self) -> Option<f32> {
        let (done, total) = match self.phase() {
            Phase::Reading => self.bytes(),
            Phase::Checking | Phase::Building => (
                self.0.steps_done.load(Relaxed),
                self.0.steps_total.load(Relaxed),
            ),
        };
        (total > 0).then(|| (done as f32 / total as f32).min(1.0))
    }

    /// The current phase.
    pub fn phase(&self) -> Phase {
        match self.0.phase.load(Relaxed) {
            0 => Phase::Reading,
            1 => Phase::Checking,
            _ => Phase::Building,
        }
    }

    /// Asks the loading thread to stop, which it does at its next [`check`](Self::check).
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Relaxed);
    }

    /// Fails if the load was cancelled. The loading thread calls it every few thousand steps.
    ///
    /// # Errors
    /// [`Cancelled`] after [`cancel`](Self::cancel).
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.0.cancelled.load(Relaxed) {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    pub(crate) fn set_total(&self, bytes: u64) {
        self.0.bytes_total.store(bytes, Relaxed);
    }

    pub(crate) fn add_read(&self, bytes: u64) {
        self.0.bytes_read.fetch_add(bytes, Relaxed);
    }

    pub(crate) fn set_steps(&self, done: usize, total: usize) {
        self.0.steps_done.store(done as u64, Relaxed);
        self.0.steps_total.store(total as u64, Relaxed);
    }

    pub(crate) fn add_step(&self) {
        self.0.steps_done.fetch_add(1, Relaxed);
    }

    pub(crate) fn enter(&self, phase: Phase) {
        self.set_steps(0, 0);
        self.0.phase.store(phase as u8, Relaxed);
    }

    /// Runs `work` on another thread and waits for its result, but no longer than until the load is cancelled.
    /// Then the thread is abandoned. Some steps, and freeing a load's memory, take longer than a user waits
    /// for a cancel.
    ///
    /// # Errors
    /// See [`BackgroundError`].
    ///
    /// # Panics
    /// If `work` panics.
    pub(crate) fn run_in_background<T: Send + 'static>(
        &self,
        name: &str,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, BackgroundError> {
        /// Interval of the checks for cancellation.
        const PATIENCE: Duration = Duration::from_millis(10);
        let (sender, receiver) = sync_channel(1);
        let thread = std::thread::Builder::new().name(name.to_owned());
        let handle = thread.spawn(move || {
            // The receiver is gone if the load was cancelled.
            _ = sender.send(work());
        });
        let handle = handle.map_err(|error| {
            let message = format!("the system grants no thread to load it: {error}");
            BackgroundError::NoThread(io::Error::new(error.kind(), message))
        })?;
        loop {
            match receiver.recv_timeout(PATIENCE) {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => self.check()?,
                Err(RecvTimeoutError::Disconnected) => match handle.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(()) => unreachable!("it sends before it ends"),
                },
            }
        }
    }
}

/// Why [`Progress::run_in_background`] has no result.
#[derive(Debug)]
pub(crate) enum BackgroundError {
    Cancelled,
    /// No thread could be started; the error says so.
    NoThread(io::Error),
}

impl From<Cancelled> for BackgroundError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cancelled_wait_returns_while_the_work_continues() {
        let progress = Progress::default();
        assert!(matches!(progress.run_in_background("two", || 2), Ok(2)));
        let (_keep, endless) = sync_channel::<()>(0);
        progress.clone().cancel();
        let result = progress.run_in_background("endless", move || endless.recv());
        assert!(matches!(result, Err(BackgroundError::Cancelled)));
    }

    #[test]
    fn each_phase_has_its_share_of_the_progress() {
        let progress = Progress::default();
        assert_eq!(progress.part_of_phase(), None);
        progress.set_total(200);
        progress.add_read(50);
        assert_eq!(progress.part_of_phase(), Some(0.25));
        progress.add_read(150);
        progress.enter(Phase::Checking);
        assert_eq!(progress.part_of_phase(), None);
        progress.set_steps(3, 4);
        assert_eq!(progress.part_of_phase(), Some(0.75));
        progress.enter(Phase::Building);
        assert_eq!(progress.part_of_phase(), None);
    }

    #[test]
    #[should_panic(expected = "on purpose")]
    fn a_panic_in_the_work_is_propagated_to_the_caller() {
        _ = Progress::default().run_in_background("panicking", || panic!("on purpose"));
    }
}

//! How far a load has come, and whether anyone still wants it.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

/// What a load is doing.
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
    /// For a user's eyes.
    pub fn label(self) -> &'static str {
        match self {
            Self::Reading => "Reading",
            Self::Checking => "Checking triangles",
            Self::Building => "Building the tree",
        }
    }
}

/// Shared by the thread that loads and the one that waits for it. Clones are of the same load.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    bytes_read: AtomicU64,
    bytes_total: AtomicU64,
    phase: AtomicU8,
    cancelled: AtomicBool,
}

/// The load was cancelled: its result is wanted no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Progress {
    /// Bytes read, and bytes in all.
    pub fn bytes(&self) -> (u64, u64) {
        (
            self.0.bytes_read.load(Relaxed),
            self.0.bytes_total.load(Relaxed),
        )
    }

    /// What is being done.
    pub fn phase(&self) -> Phase {
        match self.0.phase.load(Relaxed) {
            0 => Phase::Reading,
            1 => Phase::Checking,
            _ => Phase::Building,
        }
    }

    /// Asks the loading thread to stop. It looks every few thousand steps.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Relaxed);
    }

    /// Called by the loading thread every few thousand steps.
    ///
    /// # Errors
    /// [`Cancelled`] when the result is wanted no more.
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

    /// The file is read once more.
    pub(crate) fn restart(&self) {
        self.0.bytes_read.store(0, Relaxed);
    }

    pub(crate) fn enter(&self, phase: Phase) {
        self.0.phase.store(phase as u8, Relaxed);
    }

    /// Works on a thread of its own, for which nobody waits any more once the result isn't wanted. Some steps of a
    /// load, and giving back its memory, take longer than a user would wait for a cancel.
    ///
    /// # Errors
    /// [`Cancelled`], or the system grants no thread.
    ///
    /// # Panics
    /// As the work does.
    pub(crate) fn run_in_background<T: Send + 'static>(
        &self,
        name: &str,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, BackgroundError> {
        /// How often it is looked whether the result is wanted.
        const PATIENCE: Duration = Duration::from_millis(10);
        let (sender, receiver) = sync_channel(1);
        let thread = std::thread::Builder::new().name(name.to_owned());
        let handle = thread.spawn(move || {
            // Nobody waits any more if the load was cancelled.
            _ = sender.send(work());
        });
        let handle = handle.map_err(BackgroundError::NoThread)?;
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

/// Why there is no result of work on another thread.
#[derive(Debug)]
pub(crate) enum BackgroundError {
    Cancelled,
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
    fn nobody_waits_for_what_is_not_wanted() {
        let progress = Progress::default();
        assert!(matches!(progress.run_in_background("two", || 2), Ok(2)));
        let (_keep, endless) = sync_channel::<()>(0);
        progress.clone().cancel();
        let result = progress.run_in_background("endless", move || endless.recv());
        assert!(matches!(result, Err(BackgroundError::Cancelled)));
    }

    #[test]
    #[should_panic(expected = "on purpose")]
    fn a_panic_aside_is_a_panic_here() {
        _ = Progress::default().run_in_background("panicking", || panic!("on purpose"));
    }
}

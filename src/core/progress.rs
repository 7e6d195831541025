//! How far a load has come, and whether anyone still wants it.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering::Relaxed};

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

/// Shared by the thread that loads and the one that waits for it.
#[derive(Debug, Default)]
pub struct Progress {
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
            self.bytes_read.load(Relaxed),
            self.bytes_total.load(Relaxed),
        )
    }

    /// What is being done.
    pub fn phase(&self) -> Phase {
        match self.phase.load(Relaxed) {
            0 => Phase::Reading,
            1 => Phase::Checking,
            _ => Phase::Building,
        }
    }

    /// Asks the loading thread to stop. It looks every few thousand steps.
    pub fn cancel(&self) {
        self.cancelled.store(true, Relaxed);
    }

    /// Called by the loading thread every few thousand steps.
    ///
    /// # Errors
    /// [`Cancelled`] when the result is wanted no more.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Relaxed) {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    pub(crate) fn set_total(&self, bytes: u64) {
        self.bytes_total.store(bytes, Relaxed);
    }

    pub(crate) fn add_read(&self, bytes: u64) {
        self.bytes_read.fetch_add(bytes, Relaxed);
    }

    /// The file is read once more.
    pub(crate) fn restart(&self) {
        self.bytes_read.store(0, Relaxed);
    }

    pub(crate) fn enter(&self, phase: Phase) {
        self.phase.store(phase as u8, Relaxed);
    }
}

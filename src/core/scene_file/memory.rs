//! Accounting of the memory that reading a scene takes.

use super::description::Place;
use super::problem::Problem;

/// The memory held by the description and by the files that are being read.
pub(super) struct Memory {
    limit: u64,
    held: u64,
}

impl Memory {
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, held: 0 }
    }

    /// Bytes that may still be taken.
    pub(super) fn left(&self) -> u64 {
        self.limit.saturating_sub(self.held)
    }

    pub(super) fn limit(&self) -> u64 {
        self.limit
    }

    /// # Errors
    /// The limit is exceeded.
    pub(super) fn take(&mut self, bytes: u64, place: Place) -> Result<(), Problem> {
        if bytes > self.left() {
            return Err(self.exceeded(place));
        }
        self.held += bytes;
        Ok(())
    }

    /// The problem that the limit is exceeded.
    pub(super) fn exceeded(&self, place: Place) -> Problem {
        let megabytes = self.limit >> 20;
        let message =
            format!("loading needs more than the {megabytes} MB of memory allowed (--max-memory)");
        Problem::of_file(place.file, message)
    }

    /// Returns memory that was taken before.
    pub(super) fn give_back(&mut self, bytes: u64) {
        self.held = self.held.saturating_sub(bytes);
    }
}

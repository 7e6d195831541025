//! Accounting of the memory that reading a scene takes.

use super::description::Place;
use super::problem::Problem;
use crate::counts::grouped;

/// An upper bound on the memory of an entry of a hash map. While a full table grows, it has 8/7 slots per entry besides
/// twice as many in the new one, each with a byte more than the entry.
pub(super) const fn bytes_per_map_entry<T>() -> usize {
    4 * size_of::<T>()
}

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

    /// Bytes that are held.
    pub(super) fn held(&self) -> u64 {
        self.held
    }

    /// # Errors
    /// The limit is exceeded.
    pub(super) fn take(&mut self, bytes: u64, place: Place) -> Result<(), Problem> {
        if bytes > self.left() {
            return Err(self.exceeded(bytes, place));
        }
        self.held += bytes;
        Ok(())
    }

    /// The problem that `bytes` more exceed the limit.
    pub(super) fn exceeded(&self, bytes: u64, place: Place) -> Problem {
        let message = exceeded("at least", self.held.saturating_add(bytes), self.limit);
        Problem::of_file(place.file, message)
    }

    /// Appends to a list, and takes the memory for its growth.
    ///
    /// # Errors
    /// The limit is exceeded.
    pub(super) fn push<T>(
        &mut self,
        list: &mut Vec<T>,
        item: T,
        place: Place,
    ) -> Result<(), Problem> {
        if list.len() == list.capacity() {
            let (old, more) = (list.capacity(), list.capacity().max(4));
            let bytes = |count: usize| (count * size_of::<T>()) as u64;
            // The entries may be copied.
            self.take(bytes(old) + bytes(old + more), place)?;
            list.reserve_exact(more);
            self.give_back(2 * bytes(old));
        }
        list.push(item);
        Ok(())
    }

    /// Returns memory that was taken before.
    pub(super) fn give_back(&mut self, bytes: u64) {
        self.held = self.held.saturating_sub(bytes);
    }
}

/// The message that loading needs more memory than allowed. `how` says how the need is known.
pub(crate) fn exceeded(how: &str, needed: u64, limit: u64) -> String {
    let [needed, limit] = [needed.div_ceil(1 << 20), limit >> 20].map(|mb| grouped(mb as usize));
    format!(
        "loading needs {how} {needed} MB of memory, more than the {limit} MB allowed (--max-memory)"
    )
}

//! Work that the window doesn't wait for: one thread, one result.

use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

/// A result that a thread is working on.
pub struct Task<T>(Receiver<T>);

/// The thread ended without a result: it panicked.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("an internal error ended the work; the terminal has the details")]
pub struct TaskPanicked;

impl<T: Send + 'static> Task<T> {
    /// Starts a thread of this name; `ctx` is repainted when the result is there.
    ///
    /// If the system grants no thread, [`poll`](Self::poll) says [`TaskPanicked`].
    pub fn spawn(
        name: &str,
        ctx: &egui::Context,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Self {
        let (sender, receiver) = sync_channel(1);
        let repaint = RepaintOnDrop(ctx.clone());
        let run = move || {
            // Dropped last, after the result was sent or the work panicked.
            let _repaint = repaint;
            // Nobody waits any more if the window is closed.
            _ = sender.send(work());
        };
        // Without a thread the sender is gone, which is what `poll` reports.
        _ = std::thread::Builder::new().name(name.to_owned()).spawn(run);
        Self(receiver)
    }

    /// The result, once it is there.
    ///
    /// # Errors
    /// [`TaskPanicked`] if it will never be.
    pub fn poll(&self) -> Result<Option<T>, TaskPanicked> {
        match self.0.try_recv() {
            Ok(result) => Ok(Some(result)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(TaskPanicked),
        }
    }
}

/// Work on one of several things that could be wanted.
pub struct KeyedTask<K, T>(Option<(K, Task<T>)>);

impl<K, T> Default for KeyedTask<K, T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<K: PartialEq, T: Send + 'static> KeyedTask<K, T> {
    /// The result for `key`, once it is there. Starts the work unless it is under way; work for
    /// another key is then forgotten.
    ///
    /// # Errors
    /// [`TaskPanicked`] if it will never be; the next call starts anew.
    pub fn get(
        &mut self,
        key: K,
        start: impl FnOnce() -> Task<T>,
    ) -> Result<Option<T>, TaskPanicked> {
        match &self.0 {
            Some((wanted, task)) if *wanted == key => {
                let result = task.poll();
                if !matches!(result, Ok(None)) {
                    self.0 = None;
                }
                result
            }
            _ => {
                self.0 = Some((key, start()));
                Ok(None)
            }
        }
    }
}

struct RepaintOnDrop(egui::Context);

impl Drop for RepaintOnDrop {
    fn drop(&mut self) {
        self.0.request_repaint();
    }
}

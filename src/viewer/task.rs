//! Work that the window doesn't wait for: one thread, one result.

use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

/// A result that a thread is working on.
pub struct Task<T>(Receiver<T>);

/// The thread ended without a result: it panicked.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("an internal error ended the work; the terminal has the details")]
pub struct Broken;

impl<T: Send + 'static> Task<T> {
    /// Starts a thread of this name; `ctx` is repainted when the result is there.
    ///
    /// If the system grants no thread, [`poll`](Self::poll) says [`Broken`].
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
    /// [`Broken`] if it will never be.
    pub fn poll(&self) -> Result<Option<T>, Broken> {
        match self.0.try_recv() {
            Ok(result) => Ok(Some(result)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(Broken),
        }
    }
}

struct RepaintOnDrop(egui::Context);

impl Drop for RepaintOnDrop {
    fn drop(&mut self) {
        self.0.request_repaint();
    }
}

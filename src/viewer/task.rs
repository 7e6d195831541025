//! Work that the window doesn't wait for: one thread, one result.

use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

/// A result that a thread is working on.
pub struct Task<T>(Receiver<T>);

/// The thread ended without a result: it panicked.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("internal error; see the terminal for details")]
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
        #[cfg(test)]
        let work = sabotage::wrap(name, work);
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

/// Panics for tests of what a panic does.
#[cfg(test)]
pub(crate) mod sabotage {
    use std::cell::RefCell;

    thread_local! {
        static NAME: RefCell<Option<&'static str>> = const { RefCell::new(None) };
    }

    /// The next task of this name that the calling thread starts panics.
    pub fn next(name: &'static str) {
        NAME.set(Some(name));
    }

    /// The work of a task, or a panic in its place.
    pub fn wrap<T, W: FnOnce() -> T>(name: &str, work: W) -> impl FnOnce() -> T + use<T, W> {
        let panics = NAME.with_borrow_mut(|next| next.take_if(|next| *next == name).is_some());
        move || {
            assert!(!panics, "a test lets this task panic");
            work()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// What a task ends with.
    fn end<T: Send + 'static>(task: &Task<T>) -> Result<T, TaskPanicked> {
        loop {
            if let Some(result) = task.poll().transpose() {
                return result;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_task_that_panics_says_so_and_asks_for_a_frame() {
        let ctx = egui::Context::default();
        // A new context wants frames anyway.
        for _ in 0..10 {
            _ = ctx.run_ui(egui::RawInput::default(), |_| ());
        }
        assert!(!ctx.has_requested_repaint());
        sabotage::next("bad");
        let good = Task::spawn("good", &egui::Context::default(), || 1);
        let bad = Task::spawn("bad", &ctx, || 2);
        assert!(matches!(end(&good), Ok(1)));
        assert!(matches!(end(&bad), Err(TaskPanicked)));
        while !ctx.has_requested_repaint() {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(matches!(end(&Task::spawn("bad", &ctx, || 3)), Ok(3)));
    }

    #[test]
    fn a_keyed_task_starts_anew_after_a_panic_and_for_another_key() {
        let ctx = egui::Context::default();
        let mut keyed = KeyedTask::default();
        let mut get = |key: i32| loop {
            match keyed.get(key, || Task::spawn("keyed", &ctx, move || 10 * key)) {
                Ok(None) => std::thread::sleep(Duration::from_millis(1)),
                other => return other,
            }
        };
        sabotage::next("keyed");
        assert!(matches!(get(1), Err(TaskPanicked)));
        assert!(matches!(get(1), Ok(Some(10))));
        assert!(matches!(get(2), Ok(Some(20))));
    }
}

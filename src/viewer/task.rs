//! Background tasks: one thread, one result.

#[cfg(test)]
pub(crate) mod sabotage;

use hitscope_core::progress::Progress;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::{Duration, Instant};

/// A thread and its future result.
pub struct Task<T> {
    receiver: Receiver<T>,
    start: Instant,
    _cancelled_on_drop: CancelledOnDrop,
}

struct CancelledOnDrop(Progress);

impl Drop for CancelledOnDrop {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

/// The error of a thread that ended without a result: it panicked.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("internal error; see the terminal for details")]
pub struct TaskPanicked;

impl<T: Send + 'static> Task<T> {
    /// Starts a thread with this name. Requests a repaint of `ctx` when the thread ends.
    ///
    /// If the thread can't be started, [`poll`](Self::poll) returns [`TaskPanicked`].
    pub fn spawn(
        name: &str,
        ctx: &egui::Context,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Self {
        Self::cancellable(name, ctx, |_| work())
    }

    /// Like [`spawn`](Self::spawn), for work whose progress is cancelled when the task is dropped.
    pub fn cancellable(
        name: &str,
        ctx: &egui::Context,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
    ) -> Self {
        let progress = Progress::default();
        let cancelled_on_drop = CancelledOnDrop(progress.clone());
        let work = move || work(&progress);
        let (sender, receiver) = sync_channel(1);
        let repaint = RepaintOnDrop(ctx.clone());
        #[cfg(test)]
        let work = sabotage::wrap(name, work);
        let run = move || {
            // Dropped last, after the result is sent or the work panics.
            let _repaint = repaint;
            // The receiver is gone if the window has been closed.
            _ = sender.send(work());
        };
        // Without a thread the sender is dropped, which `poll` reports.
        _ = std::thread::Builder::new().name(name.to_owned()).spawn(run);
        let start = Instant::now();
        Self {
            receiver,
            start,
            _cancelled_on_drop: cancelled_on_drop,
        }
    }

    /// The time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// The result, once it is ready.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked.
    pub fn poll(&self) -> Result<Option<T>, TaskPanicked> {
        match self.receiver.try_recv() {
            Ok(result) => Ok(Some(result)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(TaskPanicked),
        }
    }
}

/// Runs work in its own thread pool, so that its parallel parts don't delay the UI thread's work in the global pool.
pub fn in_own_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let threads = hitscope_lab::commands::default_thread_count();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    match pool.thread_name(|k| format!("pool {k}")).build() {
        Ok(pool) => pool.install(work),
        // If no threads can be started, the work uses the global pool.
        Err(_) => work(),
    }
}

/// A result that a background task computes.
#[derive(Default)]
pub enum Pending<T> {
    /// No task was started.
    #[default]
    Unasked,
    /// The task is running.
    Running(Task<T>),
    /// The result.
    Done(T),
    /// The task panicked.
    Failed,
}

impl<T: Send + 'static> Pending<T> {
    /// Collects the result once it is ready. Returns whether that happened in this call.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if the thread panicked.
    pub fn poll(&mut self) -> Result<bool, TaskPanicked> {
        let Self::Running(task) = self else {
            return Ok(false);
        };
        match task.poll() {
            Ok(None) => Ok(false),
            Ok(Some(result)) => {
                *self = Self::Done(result);
                Ok(true)
            }
            Err(panicked) => {
                *self = Self::Failed;
                Err(panicked)
            }
        }
    }

    /// The result; `None` unless it is there.
    pub fn get(&self) -> Option<&T> {
        match self {
            Self::Done(result) => Some(result),
            _ => None,
        }
    }

    /// Takes the result once it is ready; nothing is asked for then.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if the thread panicked.
    pub fn take(&mut self) -> Result<Option<T>, TaskPanicked> {
        self.poll()?;
        match std::mem::replace(self, Self::Unasked) {
            Self::Done(result) => Ok(Some(result)),
            other => {
                *self = other;
                Ok(None)
            }
        }
    }

    /// Time since the task began; `None` if it isn't running.
    pub fn elapsed(&self) -> Option<Duration> {
        match self {
            Self::Running(task) => Some(task.elapsed()),
            _ => None,
        }
    }

    /// Whether the task has ended.
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Done(_) | Self::Failed)
    }
}

/// A task for one of several keys.
pub struct KeyedTask<K, T>(Option<(K, Task<T>)>);

impl<K, T> Default for KeyedTask<K, T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<K: PartialEq, T: Send + 'static> KeyedTask<K, T> {
    /// Time since the task began; `None` if it isn't running.
    pub fn elapsed(&self) -> Option<Duration> {
        self.0.as_ref().map(|(_, task)| task.elapsed())
    }

    /// Drops the task.
    pub fn cancel(&mut self) {
        self.0 = None;
    }

    /// Whether the task is running.
    pub fn is_running(&self) -> bool {
        self.0.is_some()
    }

    /// The result of the running task, once it is ready, with its key. Starts the task for `key` if none is running.
    /// Unlike [`get`](Self::get), this doesn't drop a running task for another key, so that there are results while a
    /// slider changes the key in each frame.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked; the next call starts again.
    pub fn in_turn(
        &mut self,
        key: K,
        start: impl FnOnce() -> Task<T>,
    ) -> Result<Option<(K, T)>, TaskPanicked> {
        let Some((running, task)) = self.0.take() else {
            self.0 = Some((key, start()));
            return Ok(None);
        };
        let result = task.poll()?;
        if result.is_none() {
            self.0 = Some((running, task));
            return Ok(None);
        }
        Ok(result.map(|result| (running, result)))
    }

    /// The result for `key`, once it is ready. Starts the task unless it is running; a task for
    /// another key is dropped.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked; the next call starts again.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Waits for the result of a task.
    fn end<T: Send + 'static>(task: &Task<T>) -> Result<T, TaskPanicked> {
        loop {
            if let Some(result) = task.poll().transpose() {
                return result;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_task_that_panics_returns_an_error_and_requests_a_repaint() {
        let ctx = egui::Context::default();
        // A new context requests repaints anyway.
        for _ in 0..10 {
            let mut output = ctx.run_ui(egui::RawInput::default(), |_| ());
            // Nobody draws.
            output.textures_delta.clear();
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
    fn a_task_is_cancelled_when_it_is_dropped_and_not_before() {
        let ctx = egui::Context::default();
        let (sender, receiver) = sync_channel(1);
        let share = move |progress: &Progress| sender.send(progress.clone());
        let task = Task::cancellable("shared", &ctx, share);
        let progress = receiver.recv().expect("sent");
        assert!(progress.check().is_ok());
        drop(task);
        assert!(progress.check().is_err());
    }

    #[test]
    fn a_pending_result_is_taken_once_and_a_panic_is_reported_once() {
        let ctx = egui::Context::default();
        let mut pending = Pending::Unasked;
        assert!(matches!(pending.take(), Ok(None)) && !pending.is_over());
        pending = Pending::Running(Task::spawn("pending", &ctx, || 1));
        let taken = loop {
            if let Some(taken) = pending.take().expect("no panic") {
                break taken;
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        assert_eq!((taken, pending.get()), (1, None));
        sabotage::next("pending");
        pending = Pending::Running(Task::spawn("pending", &ctx, || 2));
        while !matches!(pending.poll(), Err(TaskPanicked)) {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(pending.is_over() && matches!(pending.poll(), Ok(false)));
    }

    #[test]
    fn a_keyed_task_starts_again_after_a_panic_and_for_another_key() {
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

    #[test]
    fn keyed_tasks_in_turn_end_before_the_next_one_begins() {
        let ctx = egui::Context::default();
        let mut keyed = KeyedTask::default();
        let mut get =
            |key: i32| keyed.in_turn(key, || Task::spawn("keyed", &ctx, move || 10 * key));
        let hold = sabotage::hold("keyed");
        for key in 1..4 {
            assert!(matches!(get(key), Ok(None)));
        }
        drop(hold);
        let first = loop {
            if let Some(result) = get(4).expect("no panic") {
                break result;
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        assert_eq!(first, (1, 10));
    }
}

//! Replaced data that is large. Freeing hundreds of megabytes takes longer than a frame, so background tasks do it.

use crate::task::Task;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Data that others may still use.
pub trait Shared: Send {
    /// Whether something else uses a part of it.
    fn is_shared(&self) -> bool;
}

impl<T: ?Sized + Send + Sync> Shared for Arc<T> {
    fn is_shared(&self) -> bool {
        Arc::strong_count(self) > 1
    }
}

/// Replaced data, kept until nothing else uses it, so that the window's other parts don't free it when they drop it.
#[derive(Default)]
pub struct Retired {
    waiting: Vec<(Box<dyn Shared>, Instant)>,
    freeing: Vec<Task<()>>,
}

impl Retired {
    /// Adds data.
    pub fn add(&mut self, data: impl Shared + 'static) {
        self.waiting.push((Box::new(data), Instant::now()));
    }

    /// Starts to free what nothing else uses.
    pub fn poll(&mut self, ctx: &egui::Context) {
        /// Time between two checks while the window is idle.
        const PAUSE: Duration = Duration::from_millis(100);
        /// Data that is in use for longer is dropped here, and its last user frees it.
        const PATIENCE: Duration = Duration::from_secs(2);
        self.freeing.retain(|task| matches!(task.poll(), Ok(None)));
        let unused = self.waiting.extract_if(.., |(data, since)| {
            !data.is_shared() || since.elapsed() > PATIENCE
        });
        let unused: Vec<_> = unused.map(|(data, _)| data).collect();
        if !unused.is_empty() {
            self.freeing
                .push(Task::spawn("free", ctx, move || drop(unused)));
        }
        if !self.waiting.is_empty() {
            ctx.request_repaint_after(PAUSE);
        }
    }

    /// Whether no data is waiting or being freed.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.freeing.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::thread::ThreadId;

    /// Tells which thread frees it.
    struct Large(Sender<ThreadId>);

    impl Drop for Large {
        fn drop(&mut self) {
            _ = self.0.send(std::thread::current().id());
        }
    }

    fn large() -> (Arc<Large>, Receiver<ThreadId>) {
        let (sender, receiver) = channel();
        (Arc::new(Large(sender)), receiver)
    }

    #[test]
    fn data_is_freed_by_another_thread_once_nothing_uses_it() {
        let ctx = egui::Context::default();
        let mut retired = Retired::default();
        let (data, freed) = large();
        retired.add(Arc::clone(&data));
        retired.poll(&ctx);
        assert!(freed.try_recv().is_err());
        drop(data);
        assert!(freed.try_recv().is_err(), "not by the last user");
        retired.poll(&ctx);
        let thread = freed.recv_timeout(Duration::from_secs(60)).expect("freed");
        assert_ne!(thread, std::thread::current().id());
        while !retired.is_empty() {
            retired.poll(&ctx);
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

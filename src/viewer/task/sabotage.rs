//! Deliberate panics and delays for tests.

use std::cell::RefCell;
use std::sync::mpsc::{Receiver, Sender, channel};

thread_local! {
    static NAME: RefCell<Option<&'static str>> = const { RefCell::new(None) };
    static HELD: RefCell<Option<(&'static str, Receiver<()>)>> = const { RefCell::new(None) };
}

/// Makes a task wait until this is dropped.
pub struct Hold(Sender<()>);

impl Drop for Hold {
    fn drop(&mut self) {
        _ = self.0.send(());
    }
}

/// Makes the next task with this name that the calling thread starts wait.
pub fn hold(name: &'static str) -> Hold {
    let (sender, receiver) = channel();
    HELD.set(Some((name, receiver)));
    Hold(sender)
}

/// Makes the next task with this name that the calling thread starts panic.
pub fn next(name: &'static str) {
    NAME.set(Some(name));
}

/// The work of a task, or a panic instead.
pub fn wrap<T, W: FnOnce() -> T>(name: &str, work: W) -> impl FnOnce() -> T + use<T, W> {
    let panics = NAME.with_borrow_mut(|next| next.take_if(|next| *next == name).is_some());
    let held = HELD.with_borrow_mut(|held| held.take_if(|held| held.0 == name));
    move || {
        if let Some((_, end)) = held {
            _ = end.recv();
        }
        assert!(!panics, "a test makes this task panic");
        work()
    }
}

//! The threads of a command.

use super::CommandError;
use clap::Args;
use rayon::{ThreadBuilder, ThreadPoolBuilder};
use std::io;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

/// Most threads that are started for one purpose: more than any machine has cores that would gain by it.
const MOST_THREADS: u16 = 1024;

/// The number of threads that a command uses.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ThreadsArg {
    /// Threads that load, build trees and trace rays, 1 to 1024 [default: one per core]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST_THREADS)))]
    pub threads: Option<u16>,
}

impl ThreadsArg {
    /// The number of threads.
    pub fn count(self) -> usize {
        self.threads.map_or_else(default_thread_count, usize::from)
    }
}

/// One per core.
pub fn default_thread_count() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Starts the threads of the process that load meshes and build trees: `threads`, but at most one per core. Where the
/// system grants fewer, those that it grants do the work. Call it once, before anything else.
///
/// # Errors
/// The system grants no thread at all.
pub fn start_thread_pool(threads: ThreadsArg) -> Result<(), CommandError> {
    let in_environment = || {
        let text = std::env::var("RAYON_NUM_THREADS").ok()?;
        text.parse().ok().filter(|&count: &usize| count > 0)
    };
    let wanted = match threads.threads {
        Some(_) => threads.count().min(default_thread_count()),
        None => in_environment().unwrap_or_else(default_thread_count),
    };
    let wanted = wanted.min(usize::from(MOST_THREADS));
    let mut idle = Vec::new();
    while idle.len() < wanted {
        match IdleThread::start(idle.len()) {
            Ok(thread) => idle.push(thread),
            Err(source) if idle.is_empty() => return Err(no_threads(&source)),
            Err(_) => {
                // Loading a mesh needs one thread besides these.
                if idle.len() > 1
                    && let Some(thread) = idle.pop()
                {
                    thread.end();
                }
                break;
            }
        }
    }
    let pool = ThreadPoolBuilder::new().num_threads(idle.len());
    let mut idle = idle.into_iter();
    let pool = pool.spawn_handler(|worker| {
        let thread = idle.next();
        thread
            .expect("there is one for each worker")
            .become_worker(worker)
    });
    pool.build_global()
        .map_err(|error| CommandError::Other(format!("the threads can't be started: {error}")))
}

/// What is said where not one thread can be started.
pub(super) fn no_threads(source: &io::Error) -> CommandError {
    CommandError::Other(format!("the system grants no threads: {source}"))
}

/// A thread that waits to become one of the pool's. The pool can't be built twice, so the threads are there first.
struct IdleThread {
    worker: SyncSender<ThreadBuilder>,
    thread: JoinHandle<()>,
}

impl IdleThread {
    fn start(index: usize) -> io::Result<Self> {
        let (sender, receiver) = sync_channel::<ThreadBuilder>(1);
        let name = format!("pool-{index}");
        let wait = move || receiver.recv().map_or((), ThreadBuilder::run);
        Ok(Self {
            worker: sender,
            thread: std::thread::Builder::new().name(name).spawn(wait)?,
        })
    }

    fn become_worker(self, worker: ThreadBuilder) -> io::Result<()> {
        self.worker
            .send(worker)
            .map_err(|_| io::Error::other("a thread ended before its work"))
    }

    /// Ends it, and waits until it has.
    fn end(self) {
        drop(self.worker);
        // It waits and does nothing else: it can't panic.
        _ = self.thread.join();
    }
}

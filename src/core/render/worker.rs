//! The rendering threads.

use super::job::{Job, RenderPanic, TileResult};
use crate::plan::WorkUnit;
use std::io;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Capacity of the channel in tiles: more than one pass over 1280 × 720.
const CHANNEL_TILES: usize = 512;
/// Minimum time between two calls of `wake` within a pass.
const WAKE_INTERVAL: Duration = Duration::from_millis(30);
/// The same in the first pass, which is shown as a whole unless it takes longer than this.
const FIRST_PASS_WAKE_INTERVAL: Duration = Duration::from_millis(100);

/// A message from a rendering thread.
#[derive(Debug)]
pub enum Message {
    /// A tile of the newest job.
    Tile(TileResult),
    /// A tile of the newest job that couldn't be traced.
    Panicked(WorkUnit, RenderPanic),
}

/// The current job and its next tile.
struct PostedJob {
    job: Job,
    generation: u64,
    next_unit: AtomicUsize,
    sent: AtomicUsize,
}

impl PostedJob {
    /// Counts a message, and returns whether to call `wake`: a pass is complete, or enough time has passed.
    fn is_time_to_wake(&self, last_wake: &mut Instant) -> bool {
        let sent = self.sent.fetch_add(1, Relaxed) + 1;
        let tiles = self.job.plan.tile_count();
        let interval = if sent > tiles {
            WAKE_INTERVAL
        } else {
            FIRST_PASS_WAKE_INTERVAL
        };
        let is_time = sent.is_multiple_of(tiles) || last_wake.elapsed() > interval;
        if is_time {
            *last_wake = Instant::now();
        }
        is_time
    }

    fn is_in_later_pass(&self) -> bool {
        self.next_unit.load(Relaxed) >= self.job.plan.tile_count()
    }
}

#[derive(Default)]
struct State {
    posted: Option<Arc<PostedJob>>,
    is_paused: bool,
    is_ending: bool,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    /// Generation of the newest job; 0 at the end, which makes every job stale.
    generation: AtomicU64,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it holds the lock, and the state would stay consistent if it did.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Threads that render the newest job. Dropping it ends them within one batch of rays.
pub struct Renderer {
    shared: Arc<Shared>,
    /// `None` only while the renderer is dropped.
    messages: Option<Receiver<(u64, Message)>>,
    threads: Vec<JoinHandle<()>>,
    generation: u64,
}

impl Renderer {
    /// Starts `threads` threads, at least one. `wake` is called when messages are worth collecting:
    /// after each pass, now and then within one, and whenever the channel is full.
    ///
    /// # Panics
    /// If the system grants no thread.
    pub fn new(threads: usize, wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self::try_new(threads, wake).expect("a thread to render with")
    }

    /// The same as [`new`](Self::new).
    ///
    /// # Errors
    /// The system grants no thread.
    pub fn try_new(count: usize, wake: impl Fn() + Send + Sync + 'static) -> io::Result<Self> {
        let shared = Arc::new(Shared {
            state: Mutex::default(),
            changed: Condvar::new(),
            generation: AtomicU64::new(0),
        });
        let (sender, messages) = sync_channel(CHANNEL_TILES);
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let start = |k: usize| {
            let (shared, sender, wake) = (Arc::clone(&shared), sender.clone(), Arc::clone(&wake));
            std::thread::Builder::new()
                .name(format!("render-{k}"))
                .spawn(move || work(&shared, &sender, &*wake))
        };
        // Where the system grants fewer threads, those it grants do the work.
        let mut threads = vec![start(0)?];
        threads.extend((1..count).map_while(|k| start(k).ok()));
        Ok(Self {
            shared,
            messages: Some(messages),
            threads,
            generation: 0,
        })
    }

    /// Number of threads.
    pub fn thread_count(&self) -> usize {
        self.threads.len()
    }

    /// Replaces the current job.
    pub fn post(&mut self, job: Job) {
        self.generation += 1;
        let mut state = self.shared.state();
        state.posted = Some(Arc::new(PostedJob {
            job,
            generation: self.generation,
            next_unit: AtomicUsize::new(0),
            sent: AtomicUsize::new(0),
        }));
        self.shared.generation.store(self.generation, Relaxed);
        self.shared.changed.notify_all();
    }

    /// Drops the job; threads stop within one batch of rays.
    pub fn cancel(&mut self) {
        self.generation += 1;
        self.shared.state().posted = None;
        self.shared.generation.store(self.generation, Relaxed);
    }

    /// Stops after the current tiles, but not before the first, coarse pass is complete. No work is lost. Jobs
    /// posted while paused still get their first pass, so the picture follows the camera.
    pub fn pause(&mut self) {
        self.shared.state().is_paused = true;
    }

    /// Continues where [`pause`](Self::pause) stopped.
    pub fn resume(&mut self) {
        self.shared.state().is_paused = false;
        self.shared.changed.notify_all();
    }

    /// The next message of the newest job that has arrived already. Never waits.
    pub fn try_next(&self) -> Option<Message> {
        let messages = self.messages.as_ref()?;
        let newest = |(generation, message)| (generation == self.generation).then_some(message);
        messages.try_iter().find_map(newest)
    }

    /// The next message of the newest job. Waits for it until `deadline`.
    pub fn next_before(&self, deadline: Instant) -> Option<Message> {
        let messages = self.messages.as_ref()?;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let (generation, message) = messages.recv_timeout(left).ok()?;
            if generation == self.generation {
                return Some(message);
            }
        }
    }

    /// The next message of the newest job. Blocks until it arrives; call it only while there is work left.
    pub fn wait_next(&self) -> Message {
        let messages = self.messages.iter().flatten();
        let newest = |(generation, message)| (generation == self.generation).then_some(message);
        messages
            .into_iter()
            .find_map(newest)
            .expect("the threads live as long as the renderer")
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        self.shared.state().is_ending = true;
        self.shared.generation.store(0, Relaxed);
        self.shared.changed.notify_all();
        // A thread that waits for room in the channel now receives an error and ends.
        self.messages = None;
        for thread in self.threads.drain(..) {
            // The thread has already printed its panic.
            _ = thread.join();
        }
    }
}

fn work(shared: &Shared, sender: &SyncSender<(u64, Message)>, wake: &(dyn Fn() + Send + Sync)) {
    let (mut done, mut current) = (0, 0);
    let mut last_wake = Instant::now();
    while let Some(posted) = wait_for_work(shared, done) {
        let generation = posted.generation;
        if current != generation {
            (current, last_wake) = (generation, Instant::now());
        }
        let index = posted.next_unit.fetch_add(1, Relaxed);
        if index >= posted.job.plan.unit_count() {
            done = generation;
            continue;
        }
        let unit = posted.job.plan.unit(index);
        let is_stale = || shared.generation.load(Relaxed) != generation;
        let message = match posted.job.trace(unit, is_stale) {
            Ok(Some(tile)) => Message::Tile(tile),
            Ok(None) => continue,
            Err(panic) => Message::Panicked(unit, panic),
        };
        let sent = sender.try_send((generation, message));
        let sent = sent.or_else(|error| match error {
            TrySendError::Full(message) => {
                wake();
                sender.send(message).map_err(|_| ())
            }
            TrySendError::Disconnected(_) => Err(()),
        });
        if sent.is_err() {
            return;
        }
        if posted.is_time_to_wake(&mut last_wake) {
            wake();
        }
    }
}

/// Waits for a job that is neither finished nor paused; `None` at the end.
fn wait_for_work(shared: &Shared, done: u64) -> Option<Arc<PostedJob>> {
    let mut state = shared.state();
    loop {
        if state.is_ending {
            return None;
        }
        if let Some(posted) = &state.posted
            && posted.generation != done
            && !(state.is_paused && posted.is_in_later_pass())
        {
            return Some(Arc::clone(posted));
        }
        let waited = shared.changed.wait(state);
        state = waited.unwrap_or_else(PoisonError::into_inner);
    }
}

//! The threads that render.

use super::job::{Job, RenderPanic, TileResult};
use super::plan::WorkUnit;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Tiles that wait to be collected before the threads wait, too: a pass over 1280 × 720 and more.
const CHANNEL_TILES: usize = 512;
/// Between two calls of `wake` within a pass.
const WAKE_INTERVAL: Duration = Duration::from_millis(30);
/// The same in the first pass: if it takes so long, a part of it is better than nothing.
const FIRST_PASS_WAKE_INTERVAL: Duration = Duration::from_millis(100);

/// What a thread sends.
#[derive(Debug)]
pub enum Message {
    /// A tile of the newest job.
    Tile(TileResult),
    /// A tile of the newest job that couldn't be traced.
    Panicked(WorkUnit, RenderPanic),
}

/// The job that the threads work on, and the next tile of it.
struct PostedJob {
    job: Job,
    generation: u64,
    next_unit: AtomicUsize,
    sent: AtomicUsize,
}

impl PostedJob {
    /// Counts a message, and tells whether it is time to wake whoever collects them: a pass is
    /// complete, or some time has gone by.
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
    /// The newest job's; 0 at the end, which makes whatever is being traced stale.
    generation: AtomicU64,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it holds the lock; if it did, the state would still be whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Threads that render the job posted last. Dropping it ends them within a batch of rays.
pub struct Renderer {
    shared: Arc<Shared>,
    /// `None` only while it is dropped.
    messages: Option<Receiver<(u64, Message)>>,
    threads: Vec<JoinHandle<()>>,
    generation: u64,
}

impl Renderer {
    /// Starts `threads` threads, at least one. `wake` is called when messages are worth collecting:
    /// after each pass, now and then within one, and whenever the channel is full.
    pub fn new(threads: usize, wake: impl Fn() + Send + Sync + 'static) -> Self {
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
        let threads: Vec<_> = (0..threads.max(1)).map_while(|k| start(k).ok()).collect();
        assert!(!threads.is_empty(), "the system grants no thread at all");
        Self {
            shared,
            messages: Some(messages),
            threads,
            generation: 0,
        }
    }

    /// How many threads there are.
    pub fn thread_count(&self) -> usize {
        self.threads.len()
    }

    /// Renders this from now on, and nothing else.
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

    /// Drops the job: what is being traced is given up within a batch of rays.
    pub fn cancel(&mut self) {
        self.generation += 1;
        self.shared.state().posted = None;
        self.shared.generation.store(self.generation, Relaxed);
    }

    /// Stops after the first, coarse pass, or after the tiles that are being traced. No work is
    /// lost, and jobs posted while paused still get their first pass: the picture follows the camera.
    pub fn pause(&mut self) {
        self.shared.state().is_paused = true;
    }

    /// Goes on where [`pause`](Self::pause) stopped.
    pub fn resume(&mut self) {
        self.shared.state().is_paused = false;
        self.shared.changed.notify_all();
    }

    /// A message that is there, of the newest job. Never waits.
    pub fn try_next(&self) -> Option<Message> {
        let messages = self.messages.as_ref()?;
        let newest = |(generation, message)| (generation == self.generation).then_some(message);
        messages.try_iter().find_map(newest)
    }

    /// The next message of the newest job. Waits for it, so call it only while there is work left.
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
        // A thread that waits for room in the channel now gets an error instead, and ends.
        self.messages = None;
        for thread in self.threads.drain(..) {
            // A panic outside of tracing has already been printed by the thread.
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

/// The newest job, once it isn't the one that is done and isn't held up by a pause; `None` at the end.
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

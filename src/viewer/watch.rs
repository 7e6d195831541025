//! Watching of the open file and the files that it names for changes.
//!
//! A thread compares the files' metadata several times per second. File system events (such as inotify's) are
//! faster, but they end when the watched folder is deleted (`rm -rf out && make`), miss renamed parents and
//! redirected links, and don't report writes by other machines to a network drive.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant, SystemTime};

/// Programs write a file in several steps. It counts as complete once it hasn't changed for this long.
const QUIET: Duration = Duration::from_millis(300);
/// Time between two comparisons.
const INTERVAL: Duration = Duration::from_millis(150);
/// The pause after a comparison is at least this many times its duration, for slow drives.
const IDLE_FACTOR: u32 = 20;
/// A file's time may be this much earlier than the clock at the write: systems use the time of their last timer
/// tick, of which there are at least 100 per second.
const TICK: Duration = Duration::from_millis(10);

/// A watch on some files, which ends when dropped.
pub struct Watch {
    has_changed: Arc<AtomicBool>,
    /// Whether the watched file doesn't exist now.
    is_missing: Arc<AtomicBool>,
    /// Never sent to; the thread ends when this is dropped.
    _stop: Sender<()>,
}

impl Watch {
    /// Watches a file and the files that it names, whether or not they exist. A file written after `since` counts as
    /// changed.
    ///
    /// A deleted file is reported when it exists again.
    ///
    /// # Errors
    /// If the thread can't be started.
    pub fn of(
        file: &Path,
        named: &[PathBuf],
        since: SystemTime,
        ctx: &egui::Context,
    ) -> io::Result<Self> {
        let named = named.iter().map(PathBuf::as_path);
        let files: Vec<PathBuf> = [file]
            .into_iter()
            .chain(named)
            .map(Path::to_owned)
            .collect();
        let has_changed = Arc::new(AtomicBool::new(false));
        let is_missing = Arc::new(AtomicBool::new(false));
        let (stop, stopped) = channel();
        let (shared, ctx) = (Arc::clone(&has_changed), ctx.clone());
        let missing = Arc::clone(&is_missing);
        let watch = move || {
            let mut changes = Changes::since(since, state_of(&files), Instant::now());
            loop {
                let start = Instant::now();
                let state = state_of(&files);
                let is_gone = state[0].is_none();
                let was_gone = missing.swap(is_gone, Relaxed);
                let is_news = changes.is_news(state, start);
                if is_news {
                    shared.store(true, Relaxed);
                }
                if is_news || is_gone != was_gone {
                    ctx.request_repaint();
                }
                let pause = INTERVAL.max(start.elapsed() * IDLE_FACTOR);
                if stopped.recv_timeout(pause) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
            }
        };
        let thread = std::thread::Builder::new().name("watch".to_owned());
        thread.spawn(watch)?;
        Ok(Self {
            has_changed,
            is_missing,
            _stop: stop,
        })
    }

    /// Whether files have changed since the last call and are complete. A repaint is requested when this becomes true.
    pub fn poll(&self) -> bool {
        self.has_changed.swap(false, Relaxed)
    }

    /// Whether the watched file doesn't exist. A repaint is requested when this changes.
    pub fn is_missing(&self) -> bool {
        self.is_missing.load(Relaxed)
    }
}

/// The metadata of all files, the mesh first; `None` for a file that doesn't exist.
type Files = Vec<Option<FileState>>;

/// Metadata that differs between two versions of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FileState {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Time when the file's name or contents last changed, which programs can't set.
    changed: Option<SystemTime>,
    /// Device and inode.
    identity: (u64, u64),
}

fn state_of(files: &[PathBuf]) -> Files {
    let state = |path: &PathBuf| {
        let metadata = path.metadata().ok()?;
        let (identity, changed) = identity_of(&metadata);
        Some(FileState {
            bytes: metadata.len(),
            modified: metadata.modified().ok(),
            changed,
            identity,
        })
    };
    files.iter().map(state).collect()
}

#[cfg(unix)]
fn identity_of(metadata: &std::fs::Metadata) -> ((u64, u64), Option<SystemTime>) {
    use std::os::unix::fs::MetadataExt as _;
    let secs = u64::try_from(metadata.ctime()).ok();
    let nanos = u64::try_from(metadata.ctime_nsec()).unwrap_or(0);
    let changed = secs.and_then(|secs| {
        SystemTime::UNIX_EPOCH.checked_add(Duration::from_secs(secs) + Duration::from_nanos(nanos))
    });
    ((metadata.dev(), metadata.ino()), changed)
}

#[cfg(not(unix))]
fn identity_of(metadata: &std::fs::Metadata) -> ((u64, u64), Option<SystemTime>) {
    ((0, 0), metadata.created().ok())
}

/// Decides when to report a change.
struct Changes {
    /// The state that was reported last, or loaded at first; `None` if the loaded state is out of date.
    reported: Option<Files>,
    /// The state at the last comparison; `quiet_since` is the time since which it has been the same.
    last: Files,
    quiet_since: Instant,
}

impl Changes {
    /// Files whose loading began at `since` and whose state is now `files`.
    fn since(since: SystemTime, files: Files, now: Instant) -> Self {
        let latest = SystemTime::now();
        // A time in the future, from another machine's clock, would be newer at each load.
        let is_newer = |time: SystemTime| time + TICK > since && time <= latest;
        let is_out_of_date = files.iter().flatten().any(|file| {
            let times = [file.modified, file.changed];
            times.into_iter().flatten().any(is_newer)
        });
        Self {
            reported: (!is_out_of_date).then(|| files.clone()),
            last: files,
            quiet_since: now,
        }
    }

    /// Updates the files' state. Returns whether the mesh exists, the state differs from the reported one, and
    /// nothing has changed for a while.
    fn is_news(&mut self, files: Files, now: Instant) -> bool {
        if files != self.last {
            (self.last, self.quiet_since) = (files, now);
        }
        let is_there = self.last.first().is_some_and(Option::is_some);
        let is_quiet = now.saturating_duration_since(self.quiet_since) >= QUIET;
        let is_news = is_there && is_quiet && self.reported.as_ref() != Some(&self.last);
        if is_news {
            self.reported = Some(self.last.clone());
        }
        is_news
    }
}

#[cfg(test)]
mod tests;

//! Progress of long work, and its bar on the terminal.

use hitscope_core::progress::Progress;
use std::io::{self, IsTerminal as _, Write};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Work shorter than this shows no bar.
const DELAY: Duration = Duration::from_secs(1);
/// Time between two updates of the bar.
const INTERVAL: Duration = Duration::from_millis(100);
/// Characters between the brackets of the bar.
const BAR_WIDTH: usize = 20;
/// Characters of a label; the line then fits on a terminal of 80.
const LABEL_WIDTH: usize = 28;

/// What is being done, and how much of it is done.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// The step, as in “Rendering”.
    pub label: String,
    /// The part that is done, from 0 to 1; `None` if it isn't known.
    pub part: Option<f64>,
}

/// The status of some work, shared by the thread that does it and the bar. Clones refer to the same work.
#[derive(Clone, Debug, Default)]
pub struct Meter(Arc<Mutex<Status>>);

impl Meter {
    /// Begins a step.
    pub fn begin(&self, label: impl Into<String>) {
        *self.locked() = Status {
            label: label.into(),
            part: None,
        };
    }

    /// Sets the part of the step that is done, from 0 to 1.
    pub fn set(&self, part: f64) {
        self.locked().part = Some(part.clamp(0.0, 1.0));
    }

    /// The current status.
    pub fn status(&self) -> Status {
        self.locked().clone()
    }

    fn locked(&self) -> MutexGuard<'_, Status> {
        // A status is never half written.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A bar on stderr, if that is a terminal. It appears once the work has taken a second, and is erased when this is dropped.
pub struct ProgressBar {
    _thread: Option<BarThread>,
}

struct BarThread {
    /// Dropping it ends the thread.
    stop: Option<SyncSender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl ProgressBar {
    /// Shows a meter.
    pub fn of(meter: &Meter) -> Self {
        let meter = meter.clone();
        Self::on_terminal(move || meter.status())
    }

    /// Shows the progress of a load.
    pub fn of_load(progress: &Progress) -> Self {
        let progress = progress.clone();
        Self::on_terminal(move || Status {
            label: progress.phase().label().to_owned(),
            part: progress.part_of_phase().map(f64::from),
        })
    }

    fn on_terminal(status: impl Fn() -> Status + Send + 'static) -> Self {
        if !io::stderr().is_terminal() {
            return Self { _thread: None };
        }
        Self::to(io::stderr(), [DELAY, INTERVAL], status)
    }

    /// Draws on a terminal. Without a thread to spare, there is no bar.
    fn to(
        mut terminal: impl Write + Send + 'static,
        [delay, interval]: [Duration; 2],
        status: impl Fn() -> Status + Send + 'static,
    ) -> Self {
        let (stop, stopped) = sync_channel::<()>(0);
        let draw = move || {
            let (mut line, mut wait) = (Line::default(), delay);
            while stopped.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                line.draw(&status(), &mut terminal);
                wait = interval;
            }
            line.erase(&mut terminal);
        };
        let thread = std::thread::Builder::new().name("progress".to_owned());
        Self {
            _thread: thread.spawn(draw).ok().map(|thread| BarThread {
                stop: Some(stop),
                thread: Some(thread),
            }),
        }
    }
}

impl Drop for BarThread {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            // It panics only if a status can't be taken, and then the bar is missing.
            _ = thread.join();
        }
    }
}

/// The line on the terminal.
#[derive(Default)]
struct Line {
    /// The step that is shown, and when it was first seen.
    step: Option<(String, Instant)>,
    /// Its number of characters.
    width: usize,
}

impl Line {
    fn draw(&mut self, status: &Status, terminal: &mut impl Write) {
        let now = Instant::now();
        let since = match &self.step {
            Some((label, since)) if *label == status.label => *since,
            _ => {
                self.step = Some((status.label.clone(), now));
                now
            }
        };
        let text = bar_text(status, now - since);
        let width = text.chars().count();
        // Spaces overwrite the end of a longer line.
        let rest = self.width.saturating_sub(width);
        self.width = width;
        // If stderr is closed or full, the bar is lost without an error.
        _ = write!(terminal, "\r{text}{:rest$}", "");
        _ = terminal.flush();
    }

    fn erase(&mut self, terminal: &mut impl Write) {
        if self.width > 0 {
            _ = write!(terminal, "\r{:width$}\r", "", width = self.width);
            _ = terminal.flush();
        }
    }
}

/// `Rendering  [#####---------------]  27 %  12s left`.
fn bar_text(Status { label, part }: &Status, elapsed: Duration) -> String {
    let label: String = label.chars().take(LABEL_WIDTH).collect();
    let Some(part) = *part else {
        return format!("{label}  {}", seconds_text(elapsed));
    };
    let full = (part * BAR_WIDTH as f64) as usize;
    let (full, empty) = ("#".repeat(full), "-".repeat(BAR_WIDTH - full));
    let mut text = format!("{label}  [{full}{empty}] {:3.0} %", (100.0 * part).floor());
    if let Some(left) = time_left(part, elapsed) {
        text += &format!("  {} left", seconds_text(left));
    }
    text
}

/// The time until work is done that has done a part of it, from 0 to 1, in a time, if it goes on at that speed; `None` while
/// it is too early for an estimate.
pub fn time_left(part: f64, elapsed: Duration) -> Option<Duration> {
    if part <= 0.0 || elapsed < DELAY {
        return None;
    }
    let left = elapsed.as_secs_f64() * (1.0 - part) / part;
    Duration::try_from_secs_f64(left).ok()
}

/// A duration in whole seconds, as in `2m 5s`.
pub fn seconds_text(time: Duration) -> String {
    let seconds = Duration::from_secs(time.as_secs_f64().ceil() as u64);
    humantime::format_duration(seconds).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A terminal that keeps what is written to it.
    #[derive(Clone, Default)]
    struct Recorder(Arc<Mutex<Vec<u8>>>);

    impl Write for Recorder {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().expect("no panic").extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Recorder {
        fn text(&self) -> String {
            String::from_utf8(self.0.lock().expect("no panic").clone()).expect("UTF-8")
        }
    }

    #[test]
    fn a_bar_appears_after_its_delay_follows_the_work_and_is_erased() {
        let (recorder, meter) = (Recorder::default(), Meter::default());
        meter.begin("Rendering");
        meter.set(0.5);
        let shown = meter.clone();
        let delays = [Duration::from_millis(1); 2];
        let bar = ProgressBar::to(recorder.clone(), delays, move || shown.status());
        let wait_for = |text: &str| {
            let start = Instant::now();
            while !recorder.text().contains(text) {
                assert!(start.elapsed().as_secs() < 60, "{}", recorder.text());
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        wait_for("\rRendering  [##########----------]  50 %");
        meter.begin("Saving");
        // Shorter: the rest of the line is overwritten.
        wait_for("\rSaving  0s                 ");
        drop(bar);
        let text = recorder.text();
        assert!(text.ends_with(" \r"), "{text:?}");
        assert!(!text.contains('\n'));
    }

    #[test]
    fn work_that_ends_before_the_delay_shows_nothing() {
        let recorder = Recorder::default();
        let delays = [Duration::from_secs(1000); 2];
        drop(ProgressBar::to(recorder.clone(), delays, Status::default));
        assert_eq!(recorder.text(), "");
    }

    #[test]
    fn the_time_left_follows_from_the_part_that_is_done() {
        let status = |part| Status {
            label: "Reading".to_owned(),
            part,
        };
        let text = |part, secs| bar_text(&status(part), Duration::from_secs(secs));
        assert!(text(Some(0.25), 40).ends_with(" 25 %  2m left"));
        assert!(text(Some(1.0), 40).ends_with("100 %  0s left"));
        assert!(text(Some(0.0), 40).ends_with("  0 %"));
        assert_eq!(text(None, 40), "Reading  40s");
        let long = Status {
            label: "x".repeat(100),
            part: Some(0.001),
        };
        assert!(bar_text(&long, Duration::from_secs(10)).len() < 80);
    }
}

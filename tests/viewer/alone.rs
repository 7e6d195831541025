//! Runs a test in its own process, whose memory the test can measure and which writes only to a temporary folder.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The environment variable with the folder of a process that was started for one test.
const FOLDER: &str = "HITSCOPE_TEST_FOLDER";

/// The panics of all threads of this process.
static PANICS: AtomicUsize = AtomicUsize::new(0);

/// Runs the test of this name in its own process, in a temporary folder. File dialogs and portals are hidden from it.
pub fn alone(name: &str, test: impl FnOnce(&Path)) {
    if let Some(folder) = std::env::var_os(FOLDER) {
        count_panics();
        test(&PathBuf::from(folder));
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args([name, "--exact", "--nocapture", "--test-threads=1"])
        .current_dir(folder.path())
        .env(FOLDER, folder.path())
        .env("PATH", folder.path())
        .env("XDG_RUNTIME_DIR", folder.path())
        .env("XDG_DATA_HOME", folder.path())
        .env("XDG_CONFIG_HOME", folder.path())
        .env_remove("DBUS_SESSION_BUS_ADDRESS")
        // Makes jemalloc return freed memory to the system at once.
        .env("MALLOC_CONF", "dirty_decay_ms:0,muzzy_decay_ms:0")
        .output()
        .expect("started");
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    if said.contains("SKIPPED") || std::env::var_os("HITSCOPE_MONKEY").is_some() {
        crate::harness::say(&said);
    }
    assert!(output.status.success(), "{}: {said}", output.status);
    assert!(
        said.contains("1 passed"),
        "no test is called {name}: {said}"
    );
}

fn count_panics() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        PANICS.fetch_add(1, Ordering::Relaxed);
        report(panic);
    }));
}

/// The number of panics in this process so far, on any thread.
pub fn panics() -> usize {
    PANICS.load(Ordering::Relaxed)
}

/// This process's memory in MB; `None` where the system doesn't tell.
pub fn memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// Waits until this process uses at most `limit` MB, or for some seconds: threads that were told to end take a while.
/// Returns the memory.
pub fn memory_below(limit: f64) -> f64 {
    const PATIENCE: Duration = Duration::from_secs(20);
    let start = Instant::now();
    loop {
        if let Some(gpu) = crate::harness::gpu() {
            // Frees what was dropped; lavapipe frees pipelines at the next submission.
            gpu.queue.submit([]);
            _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
        }
        let now = memory_mb().unwrap_or(0.0);
        if now <= limit || start.elapsed() > PATIENCE {
            return now;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

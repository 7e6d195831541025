//! Time that the window's thread takes per frame, which doesn't depend on the size of the mesh.

use crate::harness::{press, say};
use crate::moving::{hilly_square, window_of_triangles};
use egui::Key;
use std::time::Duration;

/// The CPU time of this thread so far.
fn cpu_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux");
    let nanoseconds = text.split(' ').next().map(str::parse);
    Duration::from_nanos(nanoseconds.expect("a number").expect("a number"))
}

/// The median and the 99th percentile of the CPU times that frames take while the camera turns about a mesh of twice
/// `side` × `side` triangles.
fn frame_times(side: usize) -> Option<[Duration; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hills.obj");
    std::fs::write(&path, hilly_square(side)).expect("written");
    let mut window = window_of_triangles(Some(path))?;
    press(&mut window, Key::T);
    window.run_steps(10);
    let mut times: Vec<Duration> = (0..200)
        .map(|_| {
            // The threads trace the picture meanwhile.
            std::thread::sleep(Duration::from_millis(10));
            let start = cpu_time();
            window.step();
            cpu_time() - start
        })
        .collect();
    times.sort();
    Some([times[100], times[198]])
}

#[test]
fn a_frame_takes_as_long_for_a_million_triangles_as_for_a_thousand() {
    let Some([small, small_p99]) = frame_times(25) else {
        return;
    };
    let [large, large_p99] = frame_times(720).expect("a graphics adapter");
    say(&format!(
        "UI thread per frame: {small:.1?}, p99 {small_p99:.1?}; with a million triangles {large:.1?}, p99 {large_p99:.1?}"
    ));
    // A look at each triangle would take a few nanoseconds, together at least as long as all else in a frame. Cache misses
    // beside threads that trace a larger mesh take less.
    assert!(large < 2 * small, "{small:.1?} {large:.1?}");
}

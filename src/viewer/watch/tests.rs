//! Tests: changes of files and when they are reported.

use super::*;
use std::fs::{create_dir, create_dir_all, remove_dir_all, rename, write};

/// A test that waits longer has failed, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder with `out/mesh.obj`.
fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = folder.path().join("out/mesh.obj");
    create_dir(folder.path().join("out")).expect("made");
    write(&mesh, "v 0 0 0").expect("written");
    (folder, mesh)
}

/// A watch that knows the current files. It is created as if they had been loaded before they were written, so that it
/// reports them once.
fn watch(mesh: &Path, named: &[PathBuf]) -> Watch {
    let modified = mesh.metadata().and_then(|info| info.modified());
    let since = modified.expect("a time") - QUIET;
    let watch = Watch::of(mesh, named, since, &egui::Context::default()).expect("a thread");
    wait(&watch, "a file newer than what was loaded");
    watch
}

/// Waits until a change is reported.
fn wait(watch: &Watch, what: &str) {
    let start = Instant::now();
    while !watch.poll() {
        assert!(start.elapsed() < PATIENCE, "not reported: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_deleted_and_recreated_folder_is_noticed_each_time() {
    let (folder, mesh) = folder();
    let watch = watch(&mesh, &[]);
    for text in ["v 1 0 0", "v 2 0 0 # longer"] {
        remove_dir_all(folder.path().join("out")).expect("deleted");
        std::thread::sleep(2 * INTERVAL);
        assert!(!watch.poll(), "there is nothing to load yet");
        let start = Instant::now();
        while !watch.is_missing() {
            assert!(start.elapsed() < PATIENCE, "the missing file isn't noticed");
            std::thread::sleep(INTERVAL);
        }
        create_dir(folder.path().join("out")).expect("made");
        write(&mesh, text).expect("written");
        wait(&watch, text);
        assert!(!watch.is_missing());
    }
    write(&mesh, "v 3 0 0").expect("written");
    wait(&watch, "a change in the new folder");
}

#[test]
fn a_renamed_parent_and_its_replacement_are_noticed() {
    let (folder, mesh) = folder();
    let (first, second) = (folder.path().join("out"), folder.path().join("new"));
    let watch = watch(&mesh, &[]);
    create_dir_all(&second).expect("made");
    write(second.join("mesh.obj"), "v 1 0 0").expect("written");
    rename(&first, folder.path().join("old")).expect("renamed");
    rename(&second, &first).expect("renamed");
    wait(&watch, "a renamed folder");
    write(&mesh, "v 2 0 0").expect("written");
    wait(&watch, "a change in the renamed folder");
}

#[test]
fn a_replaced_file_and_a_library_that_appears_are_noticed() {
    let (folder, mesh) = folder();
    let library = folder.path().join("lib/mesh.mtl");
    let watch = watch(&mesh, std::slice::from_ref(&library));
    create_dir(folder.path().join("lib")).expect("made");
    write(&library, "newmtl a").expect("written");
    wait(&watch, "a library in a new folder");
    let other = folder.path().join("other");
    write(&other, "v 1 0 0").expect("written");
    rename(&other, &mesh).expect("renamed");
    wait(&watch, "a replaced file");
}

#[cfg(unix)]
#[test]
fn a_link_that_is_redirected_and_a_change_behind_it_are_noticed() {
    use std::os::unix::fs::symlink;
    let (folder, _) = folder();
    let path = |name: &str| folder.path().join(name);
    create_dir(path("next")).expect("made");
    write(path("next/mesh.obj"), "v 1 0 0").expect("written");
    symlink("out", path("current")).expect("linked");
    let mesh = path("current/mesh.obj");
    let watch = watch(&mesh, &[]);
    write(path("out/mesh.obj"), "v 2 0 0").expect("written");
    wait(&watch, "a change behind the link");
    symlink("next", path("link")).expect("linked");
    rename(path("link"), path("current")).expect("redirected");
    wait(&watch, "a redirected link");
    write(path("next/mesh.obj"), "v 3 0 0 # longer").expect("written");
    wait(&watch, "a change behind the redirected link");
}

/// The state of an existing mesh in a version identified by `bytes`.
fn file(bytes: u64) -> Option<FileState> {
    Some(FileState {
        bytes,
        modified: None,
        changed: None,
        identity: (0, 0),
    })
}

#[test]
fn a_change_is_reported_once_and_only_after_the_last_write() {
    let start = Instant::now();
    let at = |step: u32| start + step * INTERVAL;
    let quiet_steps = QUIET.div_duration_f64(INTERVAL).ceil() as u32;
    let mut changes = Changes::since(SystemTime::now(), vec![file(1), None], start);
    assert!(!changes.is_news(vec![file(1), None], at(10)), "no change");
    for step in 11..20 {
        let growing = vec![file(step.into()), None];
        assert!(!changes.is_news(growing, at(step)), "being written");
    }
    let written = || vec![file(19), None];
    assert!(!changes.is_news(written(), at(18 + quiet_steps)));
    assert!(changes.is_news(written(), at(19 + quiet_steps)));
    assert!(!changes.is_news(written(), at(100)), "reported once");
}

#[test]
fn a_file_with_a_future_time_is_not_reloaded_forever() {
    let (now, start) = (SystemTime::now(), Instant::now());
    let from_tomorrow = Some(FileState {
        modified: Some(now + Duration::from_secs(86400)),
        ..file(1).expect("a file")
    });
    let mut changes = Changes::since(now, vec![from_tomorrow.clone()], start);
    assert!(!changes.is_news(vec![from_tomorrow], start + QUIET));
}

#[test]
fn a_file_written_while_being_loaded_is_reloaded() {
    let (now, start) = (SystemTime::now(), Instant::now());
    let written = |at: SystemTime| {
        let mut file = file(1).expect("a file");
        file.modified = Some(at);
        vec![Some(file)]
    };
    // The second time precedes the load by less than the tick by which the file system's clock may lag.
    for (at, is_news) in [(now, true), (now - TICK / 2, true), (now - 2 * TICK, false)] {
        let mut changes = Changes::since(now, written(at), start);
        assert_eq!(changes.is_news(written(at), start + QUIET), is_news);
    }
}

//! Has the open file changed, or one that it names?

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant, SystemTime};

/// Programs write a file in several steps: only when it has been quiet for so long is it whole.
const QUIET: Duration = Duration::from_millis(300);

/// Sees changes of some files. Their folders are watched, as many programs write a new file and rename it.
pub struct Watch {
    has_event: Arc<AtomicBool>,
    changed_at: Option<Instant>,
    /// Stops when it is dropped.
    _watcher: RecommendedWatcher,
}

impl Watch {
    /// Watches a file and those that it names, whether or not they are there yet. What changed since a time is a
    /// change, too.
    ///
    /// # Errors
    /// What the system says.
    pub fn of(
        file: &Path,
        named: &[PathBuf],
        since: SystemTime,
        ctx: &egui::Context,
    ) -> Result<Self, notify::Error> {
        let all = || named.iter().map(PathBuf::as_path).chain([file]);
        let now = SystemTime::now();
        let is_newer = |path: &Path| {
            let modified = path.metadata().and_then(|info| info.modified());
            // A time yet to come, from another machine's clock, would be newer for ever.
            modified.is_ok_and(|modified| modified > since && modified <= now)
        };
        let has_event = Arc::new(AtomicBool::new(all().any(is_newer)));
        let files: BTreeSet<PathBuf> = all().flat_map(places).collect();
        let folders: BTreeSet<PathBuf> = files
            .iter()
            .filter_map(|path| path.parent())
            // A texture's folder may be missing; the mesh's isn't.
            .filter(|folder| folder.is_dir())
            .map(Path::to_owned)
            .collect();
        let (shared, ctx) = (Arc::clone(&has_event), ctx.clone());
        let mut watcher =
            notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
                // Opening and reading, which loading does, are no changes.
                let is_change = |event: &notify::Event| {
                    !event.kind.is_access() && event.paths.iter().any(|path| files.contains(path))
                };
                if event.as_ref().is_ok_and(is_change) {
                    shared.store(true, Relaxed);
                    ctx.request_repaint();
                }
            })?;
        for folder in folders {
            watcher.watch(&folder, RecursiveMode::NonRecursive)?;
        }
        Ok(Self {
            has_event,
            changed_at: None,
            _watcher: watcher,
        })
    }

    /// Whether something changed and is quiet again; said once. A repaint comes when it will be.
    pub fn poll(&mut self, ctx: &egui::Context) -> bool {
        if self.has_event.swap(false, Relaxed) {
            self.changed_at = Some(Instant::now());
        }
        let Some(since) = self.changed_at else {
            return false;
        };
        let rest = QUIET.saturating_sub(since.elapsed());
        if rest.is_zero() {
            self.changed_at = None;
            return true;
        }
        ctx.request_repaint_after(rest);
        false
    }
}

/// How the system calls a file: in its folder's true place, and, if it is a link, where that leads to.
fn places(file: &Path) -> Vec<PathBuf> {
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let here = folder.canonicalize().ok().zip(file.file_name());
    let here = here.map(|(folder, name)| folder.join(name));
    here.into_iter().chain(file.canonicalize().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waits for a change, ten seconds at most.
    fn is_seen(watch: &mut Watch, ctx: &egui::Context) -> bool {
        (0..200).any(|_| {
            std::thread::sleep(Duration::from_millis(50));
            watch.poll(ctx)
        })
    }

    #[test]
    fn a_change_of_the_file_or_of_one_that_it_names_is_seen_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mesh, library) = (folder.path().join("a.obj"), folder.path().join("a.mtl"));
        std::fs::write(&mesh, "v 0 0 0").expect("written");
        let ctx = egui::Context::default();
        let named = [library.clone()];
        let now = SystemTime::now() + QUIET;
        let mut watch = Watch::of(&mesh, &named, now, &ctx).expect("the system watches");
        std::fs::write(folder.path().join("other"), "").expect("written");
        _ = std::fs::read(&mesh);
        std::thread::sleep(2 * QUIET);
        assert!(!watch.poll(&ctx), "nothing of ours changed");
        std::fs::write(&library, "newmtl a").expect("written");
        assert!(is_seen(&mut watch, &ctx), "a library that came");
        let other = folder.path().join("new");
        std::fs::write(&other, "v 1 0 0").expect("written");
        std::fs::rename(&other, &mesh).expect("renamed");
        assert!(is_seen(&mut watch, &ctx), "a file that was replaced");
        std::thread::sleep(2 * QUIET);
        assert!(!watch.poll(&ctx), "said once");
    }

    #[test]
    fn what_changed_before_it_was_watched_is_seen() {
        let folder = tempfile::tempdir().expect("a folder");
        let mesh = folder.path().join("a.obj");
        let before = SystemTime::now() - QUIET;
        std::fs::write(&mesh, "v 0 0 0").expect("written");
        let ctx = egui::Context::default();
        let mut watch = Watch::of(&mesh, &[], before, &ctx).expect("the system watches");
        assert!(is_seen(&mut watch, &ctx));
    }

    #[cfg(unix)]
    #[test]
    fn what_a_link_leads_to_is_watched() {
        let folder = tempfile::tempdir().expect("a folder");
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        std::fs::create_dir(&real).expect("made");
        std::fs::create_dir(&link).expect("made");
        let target = real.join("a.obj");
        std::fs::write(&target, "v 0 0 0").expect("written");
        let mesh = link.join("b.obj");
        std::os::unix::fs::symlink(&target, &mesh).expect("linked");
        let ctx = egui::Context::default();
        let now = SystemTime::now() + QUIET;
        let mut watch = Watch::of(&mesh, &[], now, &ctx).expect("the system watches");
        std::fs::write(&target, "v 1 0 0").expect("written");
        assert!(is_seen(&mut watch, &ctx));
    }
}

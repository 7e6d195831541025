//! Has the open file changed, or one that it names?

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Programs write a file in several steps: only when it has been quiet for so long is it whole.
const QUIET: Duration = Duration::from_millis(300);

/// Sees changes of some files. Their folders are watched, as many programs write a new file and rename it.
pub struct Watch {
    files: BTreeSet<PathBuf>,
    has_event: Arc<AtomicBool>,
    changed_at: Option<Instant>,
    /// Stops when it is dropped.
    _watcher: RecommendedWatcher,
}

impl Watch {
    /// Watches a file and those that it names, whether or not they are there yet.
    ///
    /// # Errors
    /// What the system says.
    pub fn of(file: &Path, named: &[PathBuf], ctx: &egui::Context) -> Result<Self, notify::Error> {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let named = named.iter().map(absolute);
        let files: BTreeSet<PathBuf> = named.chain([absolute(&file.to_owned())]).collect();
        let has_event = Arc::new(AtomicBool::new(false));
        let (wanted, shared, ctx) = (files.clone(), Arc::clone(&has_event), ctx.clone());
        let mut watcher =
            notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
                // Opening and reading, which loading does, are no changes.
                let is_change = |event: &notify::Event| {
                    !event.kind.is_access() && event.paths.iter().any(|path| wanted.contains(path))
                };
                if event.as_ref().is_ok_and(is_change) {
                    shared.store(true, Relaxed);
                    ctx.request_repaint();
                }
            })?;
        let folders: BTreeSet<&Path> = files.iter().filter_map(|path| path.parent()).collect();
        for folder in folders {
            // A texture's folder may be missing; the mesh's isn't.
            if folder.is_dir() {
                watcher.watch(folder, RecursiveMode::NonRecursive)?;
            }
        }
        Ok(Self {
            files,
            has_event,
            changed_at: None,
            _watcher: watcher,
        })
    }

    /// Whether these are the files that are watched.
    pub fn is_of(&self, file: &Path, named: &[PathBuf]) -> bool {
        let is_watched =
            |path: &Path| std::path::absolute(path).is_ok_and(|path| self.files.contains(&path));
        is_watched(file) && named.iter().all(|path| is_watched(path))
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
        let mut watch = Watch::of(&mesh, &named, &ctx).expect("the system watches");
        assert!(watch.is_of(&mesh, &named) && !watch.is_of(&library.join("x"), &[]));
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
}

//! The files that were opened last.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The number of files that are kept.
const COUNT: usize = 10;

/// The files that were opened last, the newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<PathBuf>", into = "Vec<PathBuf>")]
pub struct RecentFiles(Vec<PathBuf>);

impl RecentFiles {
    /// The absolute paths, the newest first.
    pub fn paths(&self) -> &[PathBuf] {
        &self.0
    }

    /// Puts a file first.
    pub fn add(&mut self, file: &Path) {
        // Only an empty path has no absolute one.
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        self.0.retain(|other| *other != file);
        self.0.insert(0, file);
        self.0.truncate(COUNT);
    }

    /// Removes a file. Returns whether it was there.
    pub fn remove(&mut self, file: &Path) -> bool {
        let count = self.0.len();
        let absolute = std::path::absolute(file);
        self.0.retain(|other| absolute.as_ref().ok() != Some(other));
        self.0.len() < count
    }

    /// Without the paths that aren't UTF-8.
    #[must_use]
    pub fn in_utf_8(mut self) -> Self {
        self.0.retain(|path| path.to_str().is_some());
        self
    }
}

impl From<Vec<PathBuf>> for RecentFiles {
    fn from(mut paths: Vec<PathBuf>) -> Self {
        paths.truncate(COUNT);
        Self(paths)
    }
}

impl From<RecentFiles> for Vec<PathBuf> {
    fn from(recent: RecentFiles) -> Self {
        recent.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_file_is_first_once_and_the_eleventh_is_dropped() {
        let mut recent = RecentFiles::default();
        for number in 0..12 {
            recent.add(Path::new(&format!("/{number}.obj")));
        }
        recent.add(Path::new("/5.obj"));
        let newest = ["/5.obj", "/11.obj", "/10.obj"].map(PathBuf::from);
        assert_eq!(recent.paths()[..3], newest);
        assert_eq!(recent.paths().len(), COUNT);
        assert!(recent.remove(Path::new("/11.obj")));
        assert!(!recent.remove(Path::new("/11.obj")));
        assert_eq!(recent.paths().len(), COUNT - 1);
        recent.add(Path::new("relative.obj"));
        assert!(recent.paths()[0].is_absolute());
    }

    #[test]
    fn stored_files_are_read_back_and_no_more_than_ten() {
        let mut recent = RecentFiles::default();
        recent.add(Path::new("/a.obj"));
        let text = serde_json::to_string(&recent).expect("JSON");
        assert_eq!(text, "[\"/a.obj\"]");
        let again: RecentFiles = serde_json::from_str(&text).expect("what was stored");
        assert_eq!(again, recent);
        let many = serde_json::to_string(&vec!["/x.obj"; 1000]).expect("JSON");
        let read: RecentFiles = serde_json::from_str(&many).expect("paths");
        assert_eq!(read.paths().len(), COUNT);
    }
}

//! Where are the files that an OBJ names?

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

/// Reads a file that an OBJ or its material library names, by a name with `/` between folders.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// The files in and around an OBJ's folder, and those that it names by a whole path.
pub(super) struct Folder {
    path: PathBuf,
    /// Where the OBJ really is, if its name is a link.
    behind_link: Option<PathBuf>,
    /// What was looked for, whether or not it was there.
    wanted: RefCell<BTreeSet<PathBuf>>,
    /// What is in the folders that were looked at.
    listings: RefCell<HashMap<PathBuf, Listing>>,
}

/// A folder's names by their lower case.
type Listing = HashMap<String, OsString>;

impl Folder {
    pub(super) fn of(obj: &Path) -> Self {
        let target = std::fs::read_link(obj)
            .and_then(|_| obj.canonicalize())
            .ok();
        Self {
            path: obj.parent().unwrap_or(Path::new("")).to_owned(),
            behind_link: target.and_then(|target| Some(target.parent()?.to_owned())),
            wanted: RefCell::default(),
            listings: RefCell::default(),
        }
    }

    /// Reads a file; only a regular one of sensible size, so that loading ends.
    pub(super) fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        /// A thousand times the largest library seen, and more than the largest texture.
        const LARGEST: u64 = 256 << 20;
        let file_name = Path::new(name).file_name().map_or(Path::new(""), Path::new);
        // No file makes us ask another machine.
        let name = if name.starts_with("//") {
            file_name
        } else {
            Path::new(name)
        };
        let found = self.find(name, file_name);
        let mut wanted = self.wanted.borrow_mut();
        match &found {
            Some(path) => _ = wanted.insert(path.clone()),
            // It may come to any of them.
            None => wanted.extend(self.folders().map(|folder| folder.join(name))),
        }
        drop(wanted);
        let path = found.unwrap_or_else(|| self.path.join(name));
        let info = std::fs::metadata(&path)?;
        if !info.is_file() {
            return Err(io::Error::other("not a file"));
        }
        if info.len() > LARGEST {
            let message = format!("larger than {} MB", LARGEST >> 20);
            return Err(io::Error::other(message));
        }
        std::fs::read(path)
    }

    pub(super) fn into_wanted(self) -> Vec<PathBuf> {
        self.wanted.into_inner().into_iter().collect()
    }

    /// Where a file may be.
    fn folders(&self) -> impl Iterator<Item = &PathBuf> {
        [Some(&self.path), self.behind_link.as_ref()]
            .into_iter()
            .flatten()
    }

    /// The file of a name; one that differs in letter case, or lies in the folder itself, where there is
    /// none of just that name.
    fn find(&self, name: &Path, file_name: &Path) -> Option<PathBuf> {
        let mut folders = self.folders();
        folders.find_map(|folder| {
            self.any_case(folder, name)
                .or_else(|| self.any_case(folder, file_name))
        })
    }

    /// The file of a path, or of one that is this one but for letter case.
    fn any_case(&self, folder: &Path, name: &Path) -> Option<PathBuf> {
        let exact = folder.join(name);
        if exact.exists() {
            return Some(exact);
        }
        name.components().try_fold(folder.to_owned(), |path, part| {
            let exact = path.join(part);
            if exact.exists() {
                return Some(exact);
            }
            let mut listings = self.listings.borrow_mut();
            let listing = listings
                .entry(path.clone())
                .or_insert_with(|| listing(&path));
            let wanted = part.as_os_str().to_string_lossy().to_lowercase();
            Some(path.join(listing.get(&wanted)?))
        })
    }
}

/// What is in a folder; nothing if it can't be read. Of names that differ in letter case alone the last one by
/// bytes counts.
fn listing(folder: &Path) -> Listing {
    let is_here = folder.as_os_str().is_empty();
    let folder = if is_here { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<OsString> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .collect();
    names.sort();
    let by_lower_case = |name: OsString| (name.to_string_lossy().to_lowercase(), name);
    names.into_iter().map(by_lower_case).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_in_any_case_and_without_their_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let sub = folder.path().join("Maps");
        std::fs::create_dir(&sub).expect("written");
        std::fs::write(sub.join("Wood.PNG"), "w").expect("written");
        std::fs::write(folder.path().join("a b.mtl"), "m").expect("written");
        let folder_files = Folder::of(&folder.path().join("x.obj"));
        for (name, expected) in [
            ("Maps/Wood.PNG", Some("w")),
            ("maps/wood.png", Some("w")),
            ("a b.mtl", Some("m")),
            ("C:/models/A b.mtl", Some("m")),
            ("missing.mtl", None),
            ("//server/share/a b.mtl", Some("m")),
        ] {
            let found = folder_files.read(name).ok();
            assert_eq!(found.as_deref(), expected.map(str::as_bytes), "{name}");
        }
        assert!(folder_files.read("Maps").is_err());
        let wanted = folder_files.into_wanted();
        assert!(wanted.contains(&folder.path().join("missing.mtl")));
    }
}

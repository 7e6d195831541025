//! Finds and reads the files that an OBJ and its material libraries name.

use super::stored_file;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization as _;

/// Reads a file named by an OBJ or its material library; names separate folders by `/`.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// Finds and reads files by names that separate folders by `/`.
pub(super) trait ReferencedFiles {
    /// The path of a name; the same path for all its spellings.
    fn find(&self, name: &str) -> PathBuf;

    /// The bytes of a found file of at most `most_bytes`.
    fn read(&self, path: &Path, most_bytes: u64) -> io::Result<Vec<u8>>;
}

/// Files that a function reads by name.
pub(super) struct NamedFiles<'a>(pub ReadFile<'a>);

impl ReferencedFiles for NamedFiles<'_> {
    fn find(&self, name: &str) -> PathBuf {
        PathBuf::from(name)
    }

    fn read(&self, path: &Path, _: u64) -> io::Result<Vec<u8>> {
        (self.0)(&path.to_string_lossy())
    }
}

/// Files in and around an OBJ's folder, and at absolute paths.
pub(super) struct Folder {
    path: PathBuf,
    /// The folder of the link's target, if the OBJ is a link.
    behind_link: Option<PathBuf>,
    /// Paths that were looked for, including missing ones.
    wanted: RefCell<BTreeSet<PathBuf>>,
    /// Contents of the folders searched.
    listings: RefCell<HashMap<PathBuf, Listing>>,
}

/// A folder's names, keyed by their [`folded`] form.
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

    pub(super) fn into_wanted(self) -> Vec<PathBuf> {
        self.wanted.into_inner().into_iter().collect()
    }

    /// The folders to search.
    fn folders(&self) -> impl Iterator<Item = &PathBuf> {
        [Some(&self.path), self.behind_link.as_ref()]
            .into_iter()
            .flatten()
    }

    /// The file with this name. Failing that, one that differs in case or in the form of accents, or is in the folder
    /// itself.
    fn file_of(&self, name: &Path, file_name: &Path) -> Option<PathBuf> {
        let mut folders = self.folders();
        folders.find_map(|folder| {
            self.any_case(folder, name)
                .or_else(|| self.any_case(folder, file_name))
        })
    }

    /// The file at a path, or one whose path differs only in case.
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
            Some(path.join(listing.get(&folded(part.as_os_str()))?))
        })
    }
}

impl ReferencedFiles for Folder {
    fn find(&self, name: &str) -> PathBuf {
        let file_name = Path::new(name).file_name().map_or(Path::new(""), Path::new);
        // A network path would make this computer contact another one.
        let name = if name.starts_with("//") {
            file_name
        } else {
            Path::new(name)
        };
        let mut wanted = self.wanted.borrow_mut();
        let Some(found) = self.file_of(name, file_name) else {
            // The file may be created in any of them later.
            wanted.extend(self.folders().map(|folder| folder.join(name)));
            return self.path.join(name);
        };
        let canonical = found.canonicalize();
        wanted.insert(found.clone());
        canonical.unwrap_or(found)
    }

    fn read(&self, path: &Path, most_bytes: u64) -> io::Result<Vec<u8>> {
        /// A thousand times the largest library seen, and more than the largest texture.
        const LARGEST: u64 = 256 << 20;
        stored_file::read(path, most_bytes.min(LARGEST))
    }
}

/// A name in lower case, with composed accents: macOS stores them decomposed.
fn folded(name: &OsStr) -> String {
    name.to_string_lossy().to_lowercase().nfc().collect()
}

/// The names in a folder; empty if it can't be read. Of names whose folded forms are the same, the last one by bytes
/// counts.
fn listing(folder: &Path) -> Listing {
    let is_here = folder.as_os_str().is_empty();
    let folder = if is_here { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<OsString> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .collect();
    names.sort();
    names
        .into_iter()
        .map(|name| (folded(&name), name))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_in_any_case_and_without_their_stated_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let sub = folder.path().join("Maps");
        std::fs::create_dir(&sub).expect("written");
        std::fs::write(sub.join("Wood.PNG"), "w").expect("written");
        std::fs::write(folder.path().join("a b.mtl"), "m").expect("written");
        std::fs::write(folder.path().join("cafe\u{301}.mtl"), "c").expect("written");
        let folder_files = Folder::of(&folder.path().join("x.obj"));
        for (name, expected) in [
            ("Maps/Wood.PNG", Some("w")),
            ("maps/wood.png", Some("w")),
            ("a b.mtl", Some("m")),
            ("C:/models/A b.mtl", Some("m")),
            ("café.mtl", Some("c")),
            ("missing.mtl", None),
            ("//server/share/a b.mtl", Some("m")),
        ] {
            let found = folder_files.read(&folder_files.find(name), 1 << 20).ok();
            assert_eq!(found.as_deref(), expected.map(str::as_bytes), "{name}");
        }
        let spellings = ["Maps/Wood.PNG", "maps/wood.png", "./maps/../Maps/wood.png"];
        let paths = spellings.map(|name| folder_files.find(name));
        assert!(paths.iter().all(|path| *path == paths[0]), "{paths:?}");
        assert!(
            folder_files
                .read(&folder_files.find("Maps"), 1 << 20)
                .is_err()
        );
        let wanted = folder_files.into_wanted();
        assert!(wanted.contains(&folder.path().join("missing.mtl")));
    }
}

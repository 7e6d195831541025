//! The files named by an OBJ and its material libraries.

use super::stored_file;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization as _;

/// Reads a file named by an OBJ or a material library. Names use `/` between folders.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// A source of files by name. Names use `/` between folders.
pub(in crate::obj) trait ReferencedFiles {
    /// The path of a named file; the same path for all spellings of the name.
    fn find(&self, name: &str) -> PathBuf;

    /// The bytes of a file of at most `max_bytes`, at a path returned by [`find`](Self::find).
    fn read(&self, path: &Path, max_bytes: u64) -> io::Result<Vec<u8>>;
}

/// Files read by a caller's function.
pub(in crate::obj) struct NamedFiles<'a>(pub ReadFile<'a>);

impl ReferencedFiles for NamedFiles<'_> {
    fn find(&self, name: &str) -> PathBuf {
        PathBuf::from(name)
    }

    fn read(&self, path: &Path, _: u64) -> io::Result<Vec<u8>> {
        (self.0)(&path.to_string_lossy())
    }
}

/// Files at paths relative to an OBJ's folder, and at absolute paths.
pub(in crate::obj) struct Folder {
    path: PathBuf,
    /// The folder of the link's target, if the OBJ is a symbolic link.
    link_target_folder: Option<PathBuf>,
    /// The paths looked up so far, including missing files.
    looked_for: RefCell<BTreeSet<PathBuf>>,
    /// The listings of the folders searched so far.
    listings: RefCell<HashMap<PathBuf, Listing>>,
}

/// The file names in a folder, by their [`folded`] form.
type Listing = HashMap<String, OsString>;

impl Folder {
    pub(in crate::obj) fn of(obj: &Path) -> Self {
        let target = std::fs::read_link(obj)
            .and_then(|_| obj.canonicalize())
            .ok();
        Self {
            path: obj.parent().unwrap_or(Path::new("")).to_owned(),
            link_target_folder: target.and_then(|target| Some(target.parent()?.to_owned())),
            looked_for: RefCell::default(),
            listings: RefCell::default(),
        }
    }

    pub(in crate::obj) fn into_looked_for(self) -> Vec<PathBuf> {
        self.looked_for.into_inner().into_iter().collect()
    }

    /// The folders to search.
    fn folders(&self) -> impl Iterator<Item = &PathBuf> {
        [Some(&self.path), self.link_target_folder.as_ref()]
            .into_iter()
            .flatten()
    }

    /// The path of an existing file: `name`, or else `file_name` directly in the folder. Both ignore case and the
    /// form of accents.
    fn file_of(&self, name: &Path, file_name: &Path) -> Option<PathBuf> {
        let mut folders = self.folders();
        folders.find_map(|folder| {
            self.any_case(folder, name)
                .or_else(|| self.any_case(folder, file_name))
        })
    }

    /// The path of `name` in a folder. If it doesn't exist, an existing path with the same [`folded`] form.
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
        // Opening a network path would contact another computer.
        let name = if name.starts_with("//") {
            file_name
        } else {
            Path::new(name)
        };
        let mut looked_for = self.looked_for.borrow_mut();
        let Some(found) = self.file_of(name, file_name) else {
            // The file may be created in either folder later.
            looked_for.extend(self.folders().map(|folder| folder.join(name)));
            return self.path.join(name);
        };
        let canonical = found.canonicalize();
        looked_for.insert(found.clone());
        canonical.unwrap_or(found)
    }

    fn read(&self, path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
        /// A thousand times the largest library seen, and more than the largest texture.
        const MAX_BYTES: u64 = 256 << 20;
        stored_file::read(path, max_bytes.min(MAX_BYTES))
    }
}

/// A name in lower case with composed accents. macOS stores them decomposed.
fn folded(name: &OsStr) -> String {
    name.to_string_lossy().to_lowercase().nfc().collect()
}

/// The names in a folder, or none if it can't be read. If names have the same folded form, the last one in byte order
/// is used.
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
    fn files_are_found_in_any_case_and_outside_their_stated_folder() {
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
        let looked_for = folder_files.into_looked_for();
        assert!(looked_for.contains(&folder.path().join("missing.mtl")));
    }
}

//! An output file that isn't complete yet.

use std::fs::{File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempPath};

/// A temporary file in the directory of the output. It is deleted unless it is renamed.
pub(super) struct Draft {
    file: File,
    /// `None` if it has no name; the system then removes it even if the program is killed.
    name: Option<TempPath>,
    path: PathBuf,
}

impl Draft {
    /// Creates an empty file with the permissions of the file that it will replace.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let directory = directory_of(path);
        let (file, name) = match unnamed_file(directory) {
            Some(file) => (file, None),
            None => {
                let (file, name) = named_file(directory)?.into_parts();
                (file, Some(name))
            }
        };
        if let Ok(old) = std::fs::metadata(path) {
            keep_owner(&file, &old);
            file.set_permissions(old.permissions())?;
        }
        Ok(Self {
            file,
            name,
            path: path.to_owned(),
        })
    }

    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Moves the file to the output's path, replacing an older file.
    pub(super) fn rename(self) -> io::Result<()> {
        // Synced before it is renamed, so that a power failure can't leave half a file under the name.
        self.file.sync_all()?;
        let name = match self.name {
            Some(name) => name,
            None => name_file(&self.file, directory_of(&self.path))?,
        };
        name.persist(&self.path).map_err(|error| error.error)
    }
}

fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

fn named_file(directory: &Path) -> io::Result<NamedTempFile> {
    make_in(directory, |name| File::create_new(name))
}

/// Makes a file under an unused name.
fn make_in<F>(
    directory: &Path,
    mut make: impl FnMut(&Path) -> io::Result<F>,
) -> io::Result<NamedTempFile<F>> {
    // `Builder` adds the temporary name to the system's error. Users know only the output's name.
    let mut code = None;
    let made = Builder::new().make_in(directory, |name| {
        make(name).inspect_err(|error| code = error.raw_os_error())
    });
    made.map_err(|error| code.map_or(error, io::Error::from_raw_os_error))
}

/// Keeps the owner of the older file if the system allows it, as it does for root.
fn keep_owner(file: &File, old: &Metadata) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt as _, fchown};
        _ = fchown(file, Some(old.uid()), Some(old.gid()));
    }
    #[cfg(not(unix))]
    let _ = (file, old);
}

/// Creates a file without a name, if the file system supports it and `/proc` exists for naming it later.
#[cfg(target_os = "linux")]
fn unnamed_file(directory: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    if !Path::new("/proc/self/fd").exists() {
        return None;
    }
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    // The mode of any new file; the umask applies.
    let mode = Mode::from_raw_mode(0o666);
    open(directory, flags, mode).ok().map(File::from)
}

/// Gives a file from [`unnamed_file`] a name.
#[cfg(target_os = "linux")]
fn name_file(file: &File, directory: &Path) -> io::Result<TempPath> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd as _;
    let unnamed = format!("/proc/self/fd/{}", file.as_raw_fd());
    let link = |name: &Path| Ok(linkat(CWD, &*unnamed, CWD, name, AtFlags::SYMLINK_FOLLOW)?);
    Ok(make_in(directory, link)?.into_temp_path())
}

#[cfg(not(target_os = "linux"))]
fn unnamed_file(_: &Path) -> Option<File> {
    None
}

#[cfg(not(target_os = "linux"))]
fn name_file(_: &File, _: &Path) -> io::Result<TempPath> {
    unreachable!("only Linux has files without a name")
}

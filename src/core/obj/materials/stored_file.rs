//! Reader of stored files: regular files outside `/proc`, `/sys` and other virtual file systems.
//!
//! An untrusted mesh can name any file as its material library or texture. So the opened file is checked, and the
//! limit applies to the bytes read, not to the size that the system reports.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a stored file of at most `max_bytes`.
///
/// # Errors
/// The file can't be read, is larger than `max_bytes`, or isn't a stored file.
pub(super) fn read(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let bytes = read_past(path, max_bytes)?;
    if bytes.len() as u64 > max_bytes {
        let message = format!("larger than the limit of {} MB", max_bytes >> 20);
        return Err(io::Error::other(message));
    }
    Ok(bytes)
}

/// The bytes of a stored file, or its first `max_bytes` + 1 if it is larger.
///
/// # Errors
/// The file can't be read, or isn't a stored file.
pub(crate) fn read_past(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    // Check before opening, which may change a device's state.
    require_regular(&std::fs::metadata(path)?)?;
    let file = open(path)?;
    // Check again: the path may refer to another file by now.
    let info = file.metadata()?;
    require_regular(&info)?;
    if is_in_system_folder(path)? || is_of_kernel(&file) {
        return Err(io::Error::other("in a virtual file system"));
    }
    let size = info.len().min(max_bytes);
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    file.take(max_bytes.saturating_add(1))
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn require_regular(info: &Metadata) -> io::Result<()> {
    if info.is_file() {
        Ok(())
    } else {
        Err(io::Error::other("not a regular file"))
    }
}

/// Opens a file. Opening a pipe doesn't wait for its writer.
fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
        options.custom_flags(flags.bits().cast_signed());
    }
    options.open(path)
}

/// Whether a path is inside `/proc` or `/sys` after resolving links.
fn is_in_system_folder(path: &Path) -> io::Result<bool> {
    let path = path.canonicalize()?;
    Ok(["/proc", "/sys"]
        .iter()
        .any(|folder| path.starts_with(folder)))
}

/// Whether a file is in a virtual file system of the kernel, at any mount point.
#[cfg(any(target_os = "linux", target_os = "android"))]
fn is_of_kernel(file: &File) -> bool {
    /// `f_type` of proc, sysfs, debugfs, tracefs, cgroup, cgroup2, securityfs, bpf, configfs and pstore.
    ///
    /// Source: `include/uapi/linux/magic.h` of the Linux kernel.
    const KERNEL_FILE_SYSTEMS: [u32; 10] = [
        0x9fa0,
        0x6265_6572,
        0x6462_6720,
        0x7472_6163,
        0x0027_e0eb,
        0x6367_7270,
        0x7363_6673,
        0xcafe_4a11,
        0x6265_6570,
        0x6165_676c,
    ];
    rustix::fs::fstatfs(file)
        .is_ok_and(|system| KERNEL_FILE_SYSTEMS.contains(&(system.f_type as u32)))
}

#[cfg(not(any(target_os = "linux", target_os = "android")))]
fn is_of_kernel(_: &File) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_larger_than_the_limit_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("five");
        std::fs::write(&path, "12345").expect("written");
        assert_eq!(read(&path, 5).expect("small enough"), b"12345");
        let error = read(&path, 4).expect_err("too large").to_string();
        assert_eq!(error, "larger than the limit of 0 MB");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn kernel_files_devices_and_pipes_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let link = |to: &str, name: &str| std::os::unix::fs::symlink(to, at(name)).expect("linked");
        link("/proc/self/maps", "maps");
        link("/proc/self", "self");
        link("/dev/zero", "zero");
        let mode = rustix::fs::Mode::from_raw_mode(0o600);
        let pipe = at("pipe");
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, mode, 0)
            .expect("a pipe");
        for (path, why) in [
            (at("maps"), "in a virtual file system"),
            (at("self").join("maps"), "in a virtual file system"),
            ("/proc/self/pagemap".into(), "in a virtual file system"),
            ("/sys/kernel/notes".into(), "in a virtual file system"),
            (at("zero"), "not a regular file"),
            (at("pipe"), "not a regular file"),
            (folder.path().to_owned(), "not a regular file"),
        ] {
            if path.exists() {
                let error = read(&path, 1 << 20).expect_err("refused").to_string();
                assert_eq!(error, why, "{}", path.display());
            }
        }
    }
}

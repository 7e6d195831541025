//! Reader of scene files from the disk.

use crate::counts::grouped;
use crate::obj;
use std::io;
use std::path::Path;

/// Reads a file of at most the given number of bytes.
pub type ReadFile<'a> = &'a dyn Fn(&Path, u64) -> io::Result<Vec<u8>>;

/// The bytes of a stored file. Opens neither pipes, which may block, nor devices, which may never end.
///
/// # Errors
/// The file can't be read, is larger than `max_bytes`, or isn't a stored file.
pub(super) fn read(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let metadata = std::fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::Error::other("this is a directory, not a scene file"));
    }
    if metadata.len() > max_bytes {
        return Err(too_large(metadata.len(), max_bytes));
    }
    let bytes = obj::read_past(path, max_bytes)?;
    if bytes.len() as u64 > max_bytes {
        return Err(too_large(bytes.len() as u64, max_bytes));
    }
    Ok(bytes)
}

/// The error about a file larger than the limit.
fn too_large(bytes: u64, max_bytes: u64) -> io::Error {
    let [size, left] = [bytes.div_ceil(1 << 20), max_bytes >> 20].map(|mb| grouped(mb as usize));
    let message =
        format!("its {size} MB are more than the {left} MB of memory left (--max-memory)");
    io::Error::other(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_within_the_limit_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("five");
        std::fs::write(&path, "12345").expect("written");
        assert_eq!(read(&path, 5).expect("small enough"), b"12345");
        let error = |path: &Path, limit| read(path, limit).expect_err("refused").to_string();
        assert_eq!(
            error(&path, 4),
            "its 1 MB are more than the 0 MB of memory left (--max-memory)"
        );
        assert_eq!(
            error(folder.path(), 5),
            "this is a directory, not a scene file"
        );
        #[cfg(target_os = "linux")]
        assert_eq!(error(Path::new("/dev/zero"), 5), "not a regular file");
    }
}

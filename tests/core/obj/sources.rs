//! Sources of an OBJ's bytes: pipes, devices, and gzip files read like gzip(1).

use super::{STRICT, load_path, parse, warnings};
use flate2::{Compression, write::GzEncoder};
use hitscope_core::obj;
use hitscope_core::progress::Progress;
use std::io::Write as _;
use std::path::Path;

const MESH: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
    packer.write_all(bytes).expect("memory");
    packer.finish().expect("memory")
}

#[test]
fn gzip_with_several_members_or_trailing_zeros_is_read() {
    let (head, tail) = MESH.split_at(10);
    let members = [packed(head), packed(b""), packed(tail)].concat();
    for (bytes, expected) in [
        (members.clone(), None),
        ([&members[..], &[0; 100_000]].concat(), None),
        (
            [&members[..], b"\0\0garbage"].concat(),
            Some("bytes after the end of the gzip data ignored"),
        ),
    ] {
        let loaded = parse(&bytes[..], STRICT).expect("good");
        assert_eq!(loaded.mesh.triangles().len(), 1);
        let expected: Vec<String> = expected.into_iter().map(str::to_owned).collect();
        assert_eq!(warnings(&loaded), expected);
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    assert!(made.expect("mkfifo runs").success());
    let loaded = std::thread::scope(|threads| {
        threads.spawn(|| std::fs::write(&path, MESH).expect("written"));
        load_path(&path, STRICT).expect("good")
    });
    assert_eq!(loaded.mesh.triangles().len(), 1);
}

#[cfg(target_os = "linux")]
#[test]
fn devices_and_kernel_files_are_refused_at_once() {
    for (path, expected) in [
        ("/dev/zero", "/dev/zero: this is a device, not an OBJ file"),
        (
            "/dev/urandom",
            "/dev/urandom: this is a device, not an OBJ file",
        ),
        (
            "/proc/self/environ",
            "/proc/self/environ: this is a binary file, not an OBJ file",
        ),
        (
            "/proc/self/pagemap",
            "/proc/self/pagemap: this is a binary file, not an OBJ file",
        ),
    ] {
        let error = load_path(Path::new(path), STRICT).expect_err(path);
        assert_eq!(error.to_string(), expected);
    }
}

/// Returns one byte at a time, as a pipe may.
struct ByteByByte<'b>(&'b [u8]);

impl std::io::Read for ByteByByte<'_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let count = 1.min(out.len());
        self.0.read(&mut out[..count])
    }
}

#[test]
fn gzip_and_utf_16_are_recognised_in_a_source_that_returns_single_bytes() {
    let text = str::from_utf8(MESH).expect("ASCII");
    let utf_16 = text.encode_utf16().flat_map(u16::to_le_bytes);
    let utf_16: Vec<u8> = [0xFF, 0xFE].into_iter().chain(utf_16).collect();
    for bytes in [packed(MESH), packed(&utf_16), utf_16] {
        let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let progress = Progress::default();
        let bytes = ByteByByte(&bytes);
        let loaded = obj::parse(bytes, Path::new("x.obj"), STRICT, &none, &progress).expect("good");
        assert_eq!(loaded.mesh.triangles().len(), 1);
    }
}

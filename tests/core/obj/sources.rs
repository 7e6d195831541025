//! Sources of an OBJ's bytes: pipes, devices, and gzip files read like gzip(1).

use super::{STRICT, load_path, parse, warnings};
use flate2::{Compression, write::GzEncoder};
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
        let loaded = parse(&bytes, STRICT).expect("good");
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

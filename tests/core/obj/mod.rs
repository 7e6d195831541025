//! Reading OBJ files: unusual, malicious and faulty ones.

// A file for each oddity, and its result.
mod odd_files;

// Material libraries and textures, and how files refer to them.
mod materials;

// Files that an OBJ refers to.
mod referenced_files;

// Compressed files, pipes and devices.
mod sources;

// How far the mesh deviates from the numbers in the file.
mod rounding;

// Refused files and their messages.
mod refused;

// One thread and several give the same.
mod threads;

// Files as programs write them.
mod programs;

// Closed meshes of polygons stay closed.
mod polygons;

// Malicious files.
mod hostile;

use hitscope_core::obj::{self, FaultPolicy, LoadError, LoadOptions, Loaded};
use hitscope_core::progress::Progress;
use std::io;
use std::path::{Path, PathBuf};

const STRICT: LoadOptions = options(FaultPolicy::Strict);
const LENIENT: LoadOptions = options(FaultPolicy::Lenient);

const fn options(faults: FaultPolicy) -> LoadOptions {
    LoadOptions {
        recentre: obj::Recentre::Auto,
        faults,
        max_memory: 1 << 30,
        keeps_coordinates: false,
    }
}

/// The folder with the test files.
fn files() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/core/obj/files")
}

fn load_path(path: &Path, options: LoadOptions) -> Result<Loaded, LoadError> {
    obj::load(path, options, &Progress::default())
}

fn load(name: &str) -> Loaded {
    let loaded = load_path(&files().join(name), STRICT);
    loaded.unwrap_or_else(|error| panic!("{error}"))
}

/// The warnings about a file, as text.
fn warnings(loaded: &Loaded) -> Vec<String> {
    loaded
        .report
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect()
}

/// Parses a text that refers to no other file.
fn parse(bytes: &[u8], options: LoadOptions) -> Result<Loaded, LoadError> {
    let none = |_: &str| Err(io::ErrorKind::NotFound.into());
    let path = Path::new("x.obj");
    obj::parse(bytes, path, options, &none, &Progress::default())
}

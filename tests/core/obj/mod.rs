//! Any OBJ that people have: odd files, and clean ones against tobj alone.

// A file for each oddity, and what becomes of it.
mod odd_files;

// Material libraries and textures, and how files name them.
mod materials;

// The files that an OBJ names.
mod referenced_files;

// Files that are packed, or come from a pipe or a device.
mod sources;

// How far the mesh lies from the numbers in the file.
mod rounding;

// What is refused, and what is said of it.
mod refused;

// Clean files: the same numbers as tobj's.
mod differential;

// Files that were made to hurt.
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
    }
}

/// Where the files of this folder are.
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

/// The warnings about one of the files.
fn warnings(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

/// A mesh from a text that no other file belongs to.
fn parse(bytes: &[u8], options: LoadOptions) -> Result<Loaded, LoadError> {
    let none = |_: &str| Err(io::ErrorKind::NotFound.into());
    let path = Path::new("x.obj");
    obj::parse(|| Ok(bytes), path, options, &none, &Progress::default())
}

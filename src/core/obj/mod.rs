//! Loads OBJ files, with their material libraries and textures.
//!
//! | step | file |
//! |---|---|
//! | bytes are decompressed and decoded | `source`, `gzip` |
//! | the file is cut into chunks of whole statements | `chunks`; `kind` recognises other formats |
//! | **chunks are parsed in parallel** | `parallel`; `plain`, or `reader` with `keyword`, `statement`, `words`, `corner` |
//! | the contents of a chunk | `chunk_contents`, `elements`, `skipped`, `tally` |
//! | they are appended in file order, and checked | `contents`, `parts`, `names`, `colours`, `memory` |
//! | material names are resolved to materials and textures | `materials` |
//! | vertices are recentred, faces triangulated, and triangles that no ray can hit dropped | `assemble`, `used`, `origin`, `rounding`, `triangulate`, `oddities` |
//! | warnings, errors, and the load report | `error`, `fence`, `report`, `steps` |
//! | a face's statement is read again for the inspector, a vertex's to go to it | `face_source`, `vertex_source` |
//!
//! What happens to `f 1 2 3`:
//!
//! 1. `Chunks::next` puts it into a chunk, whole.
//! 2. `plain::read` parses it to the indices 0, 1 and 2. `f -3 -2 -1`, `f 1 2 3 # door` and errors take the general path,
//!    `ChunkReader::take`, instead.
//! 3. `Elements::end` records a face of three corners and its line.
//! 4. `Contents::append` takes the chunk's vertices and makes relative indices absolute.
//! 5. `Contents::finish` joins the vertices of all chunks and checks that those of the face exist.
//! 6. `Assembly::triangulate` renumbers them without unused vertices, drops the face if it has no area, and writes the
//!    triangle to its place in the mesh's list.

mod assemble;
mod chunk_contents;
mod chunks;
mod colours;
mod contents;
mod corner;
mod elements;
mod error;
mod face_source;
mod fence;
mod gzip;
mod keyword;
mod kind;
mod materials;
mod memory;
mod names;
mod oddities;
mod origin;
mod parallel;
mod parts;
mod plain;
mod reader;
mod report;
mod rounding;
mod skipped;
mod source;
mod statement;
mod steps;
mod tally;
mod triangulate;
mod used;
mod vertex_source;
mod words;

pub(crate) use error::printable;
pub use error::{LoadError, Warning, reason, shown};
pub use face_source::{FaceCorner, FaceSource, face_source};
pub(crate) use fence::fenced;
pub use materials::ReadFile;
pub(crate) use materials::{Picture, linear_picture, read_past, read_picture};
pub(crate) use origin::origin_near;
pub use report::{Dropped, LoadReport};
pub use steps::LoadSteps;
pub use tally::{LineRuns, shortened};
pub use vertex_source::{VertexKey, VertexSource, vertex_source};

use crate::mesh::TriangleMesh;
use crate::progress::{Phase, Progress};
use chunks::CHUNK_SIZE;
use error::Problem;
use materials::{Folder, NamedFiles, ReferencedFiles};
use source::Source;
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;
use std::time::Instant;

/// Placement of a mesh's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Recentre {
    /// Near the mesh, if it is far from (0, 0, 0) relative to its size, so that f32 keeps its detail.
    #[default]
    Auto,
    /// At (0, 0, 0): positions are the file's numbers rounded to f32.
    Off,
}

/// Treatment of faces whose indices are out of range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaultPolicy {
    /// The file is refused.
    #[default]
    Strict,
    /// A face with an invalid vertex index is dropped; invalid normals and texture coordinates are omitted. A
    /// warning counts them.
    Lenient,
}

/// Options for loading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadOptions {
    /// Placement of the mesh's origin.
    pub recentre: Recentre,
    /// Treatment of faces whose indices are out of range.
    pub faults: FaultPolicy,
    /// Memory in bytes that loading and building the tree may use; a file that needs more is refused.
    pub max_memory: u64,
    /// Whether texture coordinates are kept although no material of the file has a texture.
    pub keeps_coordinates: bool,
}

impl Default for LoadOptions {
    fn default() -> Self {
        /// Enough for about 50 million triangles.
        const MAX_MEMORY: u64 = 8 << 30;
        Self {
            recentre: Recentre::default(),
            faults: FaultPolicy::default(),
            max_memory: MAX_MEMORY,
            keeps_coordinates: false,
        }
    }
}

/// A mesh and its load report.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// The load report.
    pub report: LoadReport,
}

/// Loads an OBJ file, optionally gzipped, with its material libraries and textures.
///
/// # Errors
/// See [`LoadError`], which gives the reason and the line.
pub fn load(path: &Path, options: LoadOptions, progress: &Progress) -> Result<Loaded, LoadError> {
    load_besides(path, options, 0, progress)
}

/// Like [`load`], if `held` bytes of the allowed memory are in use.
pub(crate) fn load_besides(
    path: &Path,
    options: LoadOptions,
    held: u64,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    let unreadable = |source| LoadError::Unreadable {
        path: path.to_owned(),
        source,
    };
    let before = std::fs::metadata(path).map_err(unreadable)?;
    if before.is_dir() {
        return Err(LoadError::Directory {
            path: path.to_owned(),
        });
    }
    if is_device(&before) {
        // Some devices never end.
        return Err(Problem::Content("this is a device, not an OBJ file".to_owned()).in_file(path));
    }
    progress.set_total(before.len());
    let folder = Folder::of(path);
    let opened = File::open(path).map_err(unreadable)?;
    let parsed = parse_with(opened, path, (options, held), &folder, progress);
    if matches!(parsed, Err(LoadError::Cancelled { .. })) {
        return parsed;
    }
    let after = std::fs::metadata(path).map_err(unreadable)?;
    if is_changed(&before, &after) {
        // A partial file's other errors don't matter.
        return Err(Problem::Content(CHANGED.to_owned()).in_file(path));
    }
    let mut loaded = parsed?;
    loaded.report.files = folder.into_looked_for();
    Ok(loaded)
}

/// The bytes of an OBJ file as text: decompressed, in UTF-8 or another encoding of single bytes, and without byte order mark.
///
/// # Errors
/// The file can't be read, or its compressed data is damaged.
pub fn decoded(bytes: impl Read) -> io::Result<Vec<u8>> {
    let progress = Progress::default();
    let source = Source::new(bytes, &progress);
    let text = source.and_then(Source::read_to_end);
    text.map_err(|problem| match problem {
        Problem::Read(error) => error,
        _ => io::Error::other("cancelled"),
    })
}

/// Whether a file is neither regular nor a pipe, such as a disk, a terminal, or an endless source of bytes.
fn is_device(info: &Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kind = info.file_type();
        kind.is_char_device() || kind.is_block_device()
    }
    #[cfg(not(unix))]
    {
        _ = info;
        false
    }
}

const CHANGED: &str = "the file changed while it was being read; load it again";

fn is_changed(before: &Metadata, after: &Metadata) -> bool {
    before.is_file()
        && (before.len(), before.modified().ok()) != (after.len(), after.modified().ok())
}

/// Parses an OBJ from bytes; error messages use `path`.
///
/// # Errors
/// See [`LoadError`].
pub fn parse(
    bytes: impl Read,
    path: &Path,
    options: LoadOptions,
    read_file: ReadFile,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    parse_with(bytes, path, (options, 0), &NamedFiles(read_file), progress)
}

fn parse_with(
    bytes: impl Read,
    path: &Path,
    (options, held): (LoadOptions, u64),
    files: &dyn ReferencedFiles,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    let start = Instant::now();
    let parse = || {
        progress.enter(Phase::Reading);
        let mut steps = LoadSteps::default();
        let read = || parallel::read(bytes, CHUNK_SIZE, (&options, held), progress, &mut steps);
        let contents = fenced("reading", read);
        let contents = contents.map_err(Problem::Content)??;
        // Textures get the remaining memory.
        let held = held + memory::bytes(&contents);
        let options = LoadOptions {
            max_memory: options.max_memory.saturating_sub(held),
            ..options
        };
        let mut loaded = assemble::assemble(contents, &options, files, progress, &mut steps)?;
        loaded.report.steps = steps;
        loaded.report.duration = start.elapsed();
        Ok(loaded)
    };
    parse().map_err(|problem: Problem| problem.in_file(path))
}

#[cfg(test)]
mod tests;

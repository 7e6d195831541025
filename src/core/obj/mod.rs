//! Loads OBJ files, with their material libraries and textures.
//!
//! | step | file |
//! |---|---|
//! | bytes are split into statements: compression, encodings, line ends | `lines`, `gzip`, `kind` |
//! | statements are checked, recorded, and passed on as plain `v`, `vt`, `vn` and `f` | `reader`, `statement`, `words`, `corner`; `facts`, `names`, `copies`, `memory` |
//! | tobj parses their numbers in f64 | here |
//! | tobj's lists, one per 16 384 faces, are merged | `numbers` |
//! | vertices are recentred, polygons triangulated, and triangles that no ray can hit dropped | `assemble`, `place`, `polygon`, `delaunay`, `outline` |
//! | a face's statement is read again for the inspector | `face_source` |
//! | material names are resolved to materials and textures | `materials`, `mtl`, `picture`, `referenced_files`, `stored_file` |

mod assemble;
mod copies;
mod corner;
mod delaunay;
mod error;
mod face_source;
mod facts;
mod fence;
mod gzip;
mod kind;
mod lines;
mod materials;
mod memory;
mod mtl;
mod names;
mod numbers;
mod outline;
mod picture;
mod place;
mod polygon;
mod reader;
mod referenced_files;
mod statement;
mod stored_file;
mod words;

pub use error::{LoadError, Warning, shown};
pub use face_source::{FaceCorner, FaceSource, face_source};
pub use facts::LineRuns;
pub use referenced_files::ReadFile;

use crate::mesh::TriangleMesh;
use crate::progress::{Phase, Progress};
use error::Problem;
use fence::fenced;
use reader::{NormalisingReader, Outcome};
use referenced_files::{Folder, NamedFiles, ReferencedFiles};
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

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
    /// warning counts them. Pipes are read with [`Strict`](Self::Strict), as they can't be read twice.
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
}

impl Default for LoadOptions {
    fn default() -> Self {
        /// Enough for about 50 million triangles.
        const MAX_MEMORY: u64 = 8 << 30;
        Self {
            recentre: Recentre::default(),
            faults: FaultPolicy::default(),
            max_memory: MAX_MEMORY,
        }
    }
}

/// A mesh and the warnings about its file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// Warnings about dropped, ignored or unusual parts of the file.
    pub warnings: Vec<Warning>,
    /// Number of `v` statements in the file.
    pub vertex_count: usize,
    /// Upper bound on the difference between a coordinate of the traced mesh and its decimal in the file.
    pub max_rounding: f64,
    /// The line of each face, indexed like [`TriangleMesh::face_of`].
    pub face_lines: LineRuns,
    /// Paths of the libraries and textures that were looked for, including missing ones.
    pub files: Vec<PathBuf>,
}

/// Loads an OBJ file, optionally gzipped, with its material libraries and textures.
///
/// # Errors
/// See [`LoadError`], which gives the reason and the line.
pub fn load(path: &Path, options: LoadOptions, progress: &Progress) -> Result<Loaded, LoadError> {
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
    let options = LoadOptions {
        faults: if before.is_file() {
            options.faults
        } else {
            // A pipe can't be read twice.
            FaultPolicy::Strict
        },
        ..options
    };
    let folder = Folder::of(path);
    let parsed = parse_with(|| File::open(path), path, options, &folder, progress);
    let is_cancelled = matches!(parsed, Err(LoadError::Cancelled { .. }));
    let after = std::fs::metadata(path).map_err(unreadable)?;
    if is_changed(&before, &after) && !is_cancelled {
        // A partial file's other errors don't matter.
        return Err(Problem::Content(CHANGED.to_owned()).in_file(path));
    }
    let mut loaded = parsed?;
    loaded.files = folder.into_wanted();
    Ok(loaded)
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
/// `open` opens the bytes at their start. It is called a second time if a lenient read found faces with
/// vertices that never followed.
///
/// # Errors
/// See [`LoadError`].
pub fn parse<R: Read>(
    open: impl Fn() -> io::Result<R>,
    path: &Path,
    options: LoadOptions,
    read_file: ReadFile,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    parse_with(open, path, options, &NamedFiles(read_file), progress)
}

fn parse_with<R: Read>(
    open: impl Fn() -> io::Result<R>,
    path: &Path,
    options: LoadOptions,
    files: &dyn ReferencedFiles,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    let read_twice = || -> Result<Loaded, Problem> {
        let counts = match read(&open, options, None, files, progress)? {
            ReadOutcome::Loaded(loaded) => return Ok(*loaded),
            ReadOutcome::Again(counts) => counts,
        };
        progress.restart();
        match read(&open, options, Some(counts), files, progress)? {
            ReadOutcome::Loaded(loaded) => Ok(*loaded),
            ReadOutcome::Again(_) => Err(Problem::Content(CHANGED.to_owned())),
        }
    };
    read_twice().map_err(|problem| problem.in_file(path))
}

/// Result of reading a file once.
enum ReadOutcome {
    Loaded(Box<Loaded>),
    /// Some indices exceed these counts of vertices, texture coordinates and normals.
    Again([usize; 3]),
}

fn read<R: Read>(
    open: &impl Fn() -> io::Result<R>,
    options: LoadOptions,
    known_counts: Option<[usize; 3]>,
    files: &dyn ReferencedFiles,
    progress: &Progress,
) -> Result<ReadOutcome, Problem> {
    progress.enter(Phase::Reading);
    let bytes = open().map_err(Problem::Read)?;
    let new = || NormalisingReader::new(bytes, &options, known_counts, progress);
    let mut reader = fenced("reading", new)??;
    let tobjs = tobj::LoadOptions {
        triangulate: false,
        single_index: false,
        ..tobj::LoadOptions::default()
    };
    // The reader passes no `mtllib` on: materials are looked up by name afterwards.
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let parsed = fenced("reading", || {
        tobj::load_obj_buf(&mut reader, &tobjs, no_library)
    })?;
    let (models, error) = match parsed {
        Ok((models, _)) => (models, None),
        Err(error) => (Vec::new(), Some(error)),
    };
    // The reader knows the line and the reason of an error; tobj knows neither.
    let mut facts = match reader.finish(error.as_ref())? {
        Outcome::Read(facts) => facts,
        Outcome::Again(counts) => return Ok(ReadOutcome::Again(counts)),
    };
    // Textures get the remaining memory.
    let options = LoadOptions {
        max_memory: options.max_memory.saturating_sub(facts.bytes() as u64),
        ..options
    };
    let numbers = numbers::Numbers::gather(models, &mut facts, progress)?;
    assemble::assemble(numbers, &facts, &options, files, progress)
        .map(|loaded| ReadOutcome::Loaded(Box::new(loaded)))
}

#[cfg(test)]
mod tests;

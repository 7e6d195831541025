//! What does this OBJ file hold?
//!
//! Three steps: `reader` sees every line, checks faces, notes groups and materials and passes on
//! plain `v`, `vn` and `f` statements; tobj reads their numbers, in f64; `assemble` recentres the
//! vertices, triangulates the polygons and drops what no ray can hit.

mod assemble;
mod error;
mod facts;
mod mtl;
mod polygon;
mod reader;

pub use error::{LoadError, Warning};

use crate::mesh::TriangleMesh;
use crate::progress::{Phase, Progress};
use reader::NormalisingReader;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Where a mesh's origin is put.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Recentre {
    /// Near the mesh, if it lies far from (0, 0, 0) for its size: f32 then holds its detail.
    #[default]
    Auto,
    /// At (0, 0, 0): positions are the file's numbers rounded to f32.
    Off,
}

/// A mesh, and what was odd about its file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// What was dropped or ignored, for the user to know.
    pub warnings: Vec<Warning>,
    /// `v` statements in the file.
    pub vertex_count: usize,
    /// The largest distance, in a coordinate, between the file's numbers in f64 and what is traced.
    pub max_rounding: f64,
}

/// Where `mtllib` files come from.
pub type Library<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// Loads an OBJ file and the material libraries beside it.
///
/// # Errors
/// See [`LoadError`]: what is wrong, and on which line.
pub fn load(path: &Path, recentre: Recentre, progress: &Progress) -> Result<Loaded, LoadError> {
    let unreadable = |source| LoadError::Unreadable {
        path: path.to_owned(),
        source,
    };
    let info = std::fs::metadata(path).map_err(unreadable)?;
    if info.is_dir() {
        return Err(LoadError::Directory {
            path: path.to_owned(),
        });
    }
    progress.set_total(info.len());
    let file = File::open(path).map_err(unreadable)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let library = |name: &str| read_library(&folder.join(name.replace('\\', "/")));
    parse(file, path, recentre, &library, progress)
}

/// A material library; only a regular file of sensible size, so that loading ends.
fn read_library(path: &Path) -> io::Result<Vec<u8>> {
    /// A thousand times the largest one seen.
    const LARGEST: u64 = 64 << 20;
    let info = std::fs::metadata(path)?;
    if !info.is_file() || info.len() > LARGEST {
        return Err(io::Error::other("not a file of at most 64 MB"));
    }
    std::fs::read(path)
}

/// Parses an OBJ from bytes; `path` is what errors call it.
///
/// # Errors
/// See [`LoadError`].
pub fn parse(
    bytes: impl Read,
    path: &Path,
    recentre: Recentre,
    library: Library,
    progress: &Progress,
) -> Result<Loaded, LoadError> {
    progress.enter(Phase::Reading);
    let mut reader = NormalisingReader::new(bytes, progress);
    let options = tobj::LoadOptions {
        triangulate: false,
        single_index: false,
        ..tobj::LoadOptions::default()
    };
    // The reader passes on no `mtllib`: materials are looked up by name afterwards.
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let parsed = tobj::load_obj_buf(&mut reader, &options, no_library);

    // The reader knows the line and the reason; tobj only that there is an error.
    let facts = reader.finish().map_err(|problem| problem.in_file(path))?;
    let models = match parsed {
        Ok((models, _)) => models,
        Err(error) => return Err(facts.unexplained(&error).in_file(path)),
    };
    let model = models.into_iter().next().map(|model| model.mesh);
    assemble::assemble(
        &model.unwrap_or_default(),
        &facts,
        recentre,
        library,
        progress,
    )
    .map_err(|problem| problem.in_file(path))
}

#[cfg(test)]
mod tests;

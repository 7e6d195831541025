//! What is there to be seen?

mod tree;

pub use tree::{FirstTree, SceneOptions};

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::intersector::Intersector;
use crate::kernel::TriangleKernel;
use crate::mesh::{Crease, SAFE_SIZE, TriangleMesh, VertexNormals};
use crate::obj::{self, LoadError, LoadOptions, Loaded, Warning};
use crate::progress::{BackgroundError, Cancelled, Phase, Progress};
use crate::simd::SimdLevel;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};
use tree::Tree;

/// How normals vary over a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One normal a triangle.
    #[default]
    Flat,
    /// Normals interpolated from the vertices.
    Smooth,
}

/// A mesh with its tree. Immutable, as far as rays can tell: another scene replaces it.
#[derive(Debug)]
pub struct Scene {
    mesh: Arc<TriangleMesh>,
    bounds: Aabb,
    tree: Arc<Tree>,
    crease: Crease,
    /// Made when smooth shading first asks for it.
    vertex_normals: OnceLock<VertexNormals>,
}

impl Scene {
    /// Builds the tree over a mesh.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn new(mesh: TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        Self::with_options(mesh, SceneOptions::default(), progress)
    }

    /// A scene for speed or for memory, with its first picture soon or at its best.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn with_options(
        mesh: TriangleMesh,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        progress.enter(Phase::Building);
        Ok(Self {
            bounds: mesh.bounds(),
            tree: Arc::new(Tree::build(&mesh, options, progress)?),
            mesh: Arc::new(mesh),
            crease: Crease::default(),
            vertex_normals: OnceLock::new(),
        })
    }

    /// The same triangles and the same tree, with other edges in smooth shading.
    #[must_use]
    pub fn with_crease(&self, crease: Crease) -> Self {
        Self {
            mesh: Arc::clone(&self.mesh),
            bounds: self.bounds,
            tree: Arc::clone(&self.tree),
            crease,
            vertex_normals: OnceLock::new(),
        }
    }

    /// Where smooth shading has edges.
    pub fn crease(&self) -> Crease {
        self.crease
    }

    /// Only some of a mesh's triangles, in their order, without what is known of their faces.
    pub fn of_triangles(mesh: &TriangleMesh, triangles: &[u32]) -> Self {
        let corners = triangles
            .iter()
            .flat_map(|&triangle| mesh.corners(triangle));
        let mesh = TriangleMesh {
            positions: corners.collect(),
            triangles: (0..triangles.len() as u32)
                .map(|k| [3 * k, 3 * k + 1, 3 * k + 2])
                .collect(),
            ..TriangleMesh::default()
        };
        Self::new(mesh, &Progress::default()).expect("nobody cancels")
    }

    /// The triangles.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The tree over the triangles' boxes, as it is at present.
    pub fn bvh(&self) -> Arc<Bvh> {
        self.tree.bvh()
    }

    /// Whether no better tree is to come.
    pub fn has_best_tree(&self) -> bool {
        self.tree.is_best()
    }

    /// Replaces a quick tree by the best one, also under intersectors that were made with the former; what
    /// rays hit doesn't change by a bit, what they cost does. Where it was replaced already, nothing
    /// happens; where another thread is at it, this one waits.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled; another call goes on from there.
    pub fn improve(&self, progress: &Progress) -> Result<(), Cancelled> {
        self.tree.improve(&self.mesh, progress)
    }

    /// The box around everything, in the mesh's coordinates.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How long the tree took that there is at present.
    pub fn build_time(&self) -> Duration {
        self.tree.build_time()
    }

    /// Normals at the corners, computed at the first call.
    pub fn vertex_normals(&self) -> &VertexNormals {
        self.vertex_normals
            .get_or_init(|| VertexNormals::of(&self.mesh, self.crease))
    }

    /// Packs the scene for a kernel.
    pub fn intersector(&self, kernel: &'static TriangleKernel) -> Box<dyn Intersector> {
        self.intersector_at(kernel, SimdLevel::current())
    }

    /// The same, for one of this machine's SIMD levels.
    pub fn intersector_at(
        &self,
        kernel: &'static TriangleKernel,
        level: SimdLevel,
    ) -> Box<dyn Intersector> {
        self.tree.intersector(&self.mesh, kernel, level)
    }
}

/// A scene from a file, and what is known of the file besides.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What was dropped or ignored, for the user to know.
    pub warnings: Vec<Warning>,
    /// `v` statements in the file.
    pub vertex_count: usize,
    /// The largest distance, in a coordinate, between the file's decimals and what is traced.
    pub max_rounding: f64,
    /// The libraries and textures that were looked for, whether or not they are there.
    pub files: Vec<PathBuf>,
    /// How long reading, parsing and checking took; the tree's time is the scene's.
    pub load_time: Duration,
}

impl LoadedScene {
    /// Loads an OBJ file and builds the tree over it.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(
        path: &Path,
        load_options: LoadOptions,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, LoadError> {
        let cancelled = |path: &Path| LoadError::Cancelled {
            path: path.to_owned(),
        };
        let (file, shared) = (path.to_owned(), progress.clone());
        let load = move || {
            let start = Instant::now();
            let loaded = obj::load(&file, load_options, &shared)?;
            Self::of(loaded, start, options, &shared).map_err(|Cancelled| cancelled(&file))
        };
        progress
            .run_in_background("load", load)
            .unwrap_or_else(|why| {
                Err(match why {
                    BackgroundError::Cancelled => cancelled(path),
                    BackgroundError::NoThread(source) => LoadError::Unreadable {
                        path: path.to_owned(),
                        source,
                    },
                })
            })
    }

    /// Builds the tree over a mesh whose loading began at `start`.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn of(
        loaded: Loaded,
        start: Instant,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let load_time = start.elapsed();
        let scene = Scene::with_options(loaded.mesh, options, progress)?;
        let mut warnings = loaded.warnings;
        warnings.extend(size_warning(scene.bounds()));
        Ok(Self {
            scene: Arc::new(scene),
            warnings,
            vertex_count: loaded.vertex_count,
            max_rounding: loaded.max_rounding,
            files: loaded.files,
            load_time,
        })
    }
}

/// What there is to say of a mesh that is too large or too small for f32 kernels.
fn size_warning(bounds: Aabb) -> Option<Warning> {
    let size = 2.0 * bounds.radius();
    let (least, most) = (SAFE_SIZE.start(), SAFE_SIZE.end());
    (!SAFE_SIZE.contains(&size)).then(|| Warning {
        line: None,
        message: format!(
            "the mesh is {size:.1e} units large: outside of {least:e} to {most:e} hits may be missed or inaccurate; scale it"
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;

    #[test]
    fn a_mesh_too_large_or_too_small_for_f32_kernels_is_warned_of() {
        let library = |_: &str| Err(io::ErrorKind::NotFound.into());
        let (path, progress) = (Path::new("x.obj"), Progress::default());
        for (scale, is_warned) in [
            ("1e-20", true),
            ("1e-3", false),
            ("1e9", false),
            ("1e30", true),
        ] {
            let text = format!("v 0 0 0\nv {scale} 0 0\nv 0 {scale} 0\nf 1 2 3\n");
            let open = || Ok(text.as_bytes());
            let loaded = obj::parse(open, path, LoadOptions::default(), &library, &progress);
            let loaded = LoadedScene::of(
                loaded.expect("good"),
                Instant::now(),
                SceneOptions::default(),
                &progress,
            );
            let warnings = loaded.expect("nobody cancels").warnings;
            assert_eq!(
                warnings.len(),
                usize::from(is_warned),
                "{scale}: {warnings:?}"
            );
        }
    }
}

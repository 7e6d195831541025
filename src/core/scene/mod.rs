//! The scene: mesh, bounds and acceleration structure; loading it from a file.

mod tree;

pub use tree::{FirstTree, SceneOptions};

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::intersector::Intersector;
use crate::kernel::TriangleKernel;
use crate::mesh::{Crease, SAFE_SIZE, TriangleMesh, VertexNormals};
use crate::obj::{self, LoadError, LoadOptions, LoadReport, Loaded, Warning};
use crate::progress::{BackgroundError, Cancelled, Phase, Progress};
use crate::simd::SimdLevel;
use glam::Vec3;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use tree::Tree;

/// Flat or smooth shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One normal per triangle.
    #[default]
    Flat,
    /// Normals interpolated from the vertices.
    Smooth,
}

/// A mesh with its acceleration structure. No answer to a ray ever changes; a changed file makes another scene.
#[derive(Debug)]
pub struct Scene {
    mesh: Arc<TriangleMesh>,
    bounds: Aabb,
    /// The same with the lines and points of the file.
    bounds_with_elements: Aabb,
    tree: Arc<Tree>,
    crease: Crease,
    /// Computed on first use.
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

    /// Builds the tree over a mesh, optimised as `options` say.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn with_options(
        mesh: TriangleMesh,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        progress.enter(Phase::Building);
        let bounds = mesh.bounds();
        Ok(Self {
            bounds,
            bounds_with_elements: framed(bounds, mesh.line_and_point_bounds()),
            tree: Arc::new(Tree::build(&mesh, options, progress)?),
            mesh: Arc::new(mesh),
            crease: Crease::default(),
            vertex_normals: OnceLock::new(),
        })
    }

    /// The same mesh and tree with another crease angle for smooth shading.
    #[must_use]
    pub fn with_crease(&self, crease: Crease) -> Self {
        Self {
            mesh: Arc::clone(&self.mesh),
            bounds: self.bounds,
            bounds_with_elements: self.bounds_with_elements,
            tree: Arc::clone(&self.tree),
            crease,
            vertex_normals: OnceLock::new(),
        }
    }

    /// Which edges smooth shading keeps sharp.
    pub fn crease(&self) -> Crease {
        self.crease
    }

    /// A scene of the given triangles of a mesh, in this order, without normals, materials and faces.
    pub fn of_triangles(mesh: &TriangleMesh, triangles: &[u32]) -> Self {
        let corners = triangles
            .iter()
            .flat_map(|&triangle| mesh.corners(triangle));
        let indices = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        let mesh = TriangleMesh::new_unchecked(corners.collect(), indices.collect());
        Self::new(mesh, &Progress::default()).expect("nobody cancels")
    }

    /// The same triangles with the origin at (0, 0, 0), without normals, materials and faces; `None` if that would
    /// round a position.
    pub fn in_file_frame(&self) -> Option<Self> {
        if !self.mesh.are_f32_in_file() {
            return None;
        }
        let in_file = |p: &Vec3| self.mesh.in_file(p.as_dvec3()).as_vec3();
        let positions = self.mesh.positions().iter().map(in_file).collect();
        let mesh = TriangleMesh::new_unchecked(positions, self.mesh.triangles().to_vec());
        let options = SceneOptions {
            packing: self.tree.packing(),
            ..SceneOptions::default()
        };
        Some(Self::with_options(mesh, options, &Progress::default()).expect("nobody cancels"))
    }

    /// The mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The current tree; [`improve`](Self::improve) may replace it.
    pub fn bvh(&self) -> Arc<Bvh> {
        self.tree.bvh()
    }

    /// Whether the tree is the final one.
    pub fn has_best_tree(&self) -> bool {
        self.tree.is_best()
    }

    /// Replaces a quick tree by the best one, also in intersectors that already use it. Hits keep all bits; only
    /// their cost changes. Does nothing if the tree is the best one; waits if another thread is building it.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled; another call resumes.
    pub fn improve(&self, progress: &Progress) -> Result<(), Cancelled> {
        self.tree.improve(&self.mesh, progress)
    }

    /// The bounds of the mesh, in its own coordinates (relative to its origin).
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The box around the triangles and the file's lines and points, in the mesh's coordinates.
    pub fn bounds_with_elements(&self) -> Aabb {
        self.bounds_with_elements
    }

    /// Time it took to build the current tree.
    pub fn build_time(&self) -> Duration {
        self.tree.build_time()
    }

    /// Vertex normals, computed by the first call.
    pub fn vertex_normals(&self) -> &VertexNormals {
        self.vertex_normals
            .get_or_init(|| VertexNormals::of(&self.mesh, self.crease))
    }

    /// Packs the scene for a kernel.
    pub fn intersector(&self, kernel: &'static TriangleKernel) -> Box<dyn Intersector> {
        self.intersector_at(kernel, SimdLevel::current())
    }

    /// Packs the scene for a kernel at one of this machine's SIMD levels.
    pub fn intersector_at(
        &self,
        kernel: &'static TriangleKernel,
        level: SimdLevel,
    ) -> Box<dyn Intersector> {
        self.tree.intersector(&self.mesh, kernel, level)
    }
}

/// A scene of the mesh, with its tree built.
pub fn scene(mesh: TriangleMesh) -> Scene {
    Scene::new(mesh, &Progress::default()).expect("nobody cancels")
}

/// A scene and facts about the file that it was loaded from.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The load report of the file.
    pub report: LoadReport,
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
            let loaded = obj::load(&file, load_options, &shared)?;
            Self::of(loaded, options, &shared).map_err(|Cancelled| cancelled(&file))
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

    /// Builds the tree over a mesh.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn of(
        loaded: Loaded,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let Loaded { mesh, mut report } = loaded;
        let scene = Scene::with_options(mesh, options, progress)?;
        report.warnings.extend(size_warning(scene.bounds()));
        let scene = Arc::new(scene);
        Ok(Self { scene, report })
    }
}

/// The box to frame: that of the surface, lines and points, or of the surface alone if it would be a dot: surveys contain
/// stray points.
fn framed(surface: Aabb, elements: Aabb) -> Aabb {
    /// The surface is then about as large as a pixel.
    const LARGEST: f64 = 1000.0;
    let all = surface.union(elements);
    if !surface.is_empty() && all.radius() > LARGEST * surface.radius() {
        surface
    } else {
        all
    }
}

/// The warning for a mesh whose size f32 kernels can't handle well.
fn size_warning(bounds: Aabb) -> Option<Warning> {
    let size = 2.0 * bounds.radius();
    let (least, most) = (SAFE_SIZE.start(), SAFE_SIZE.end());
    (!SAFE_SIZE.contains(&size)).then(|| Warning {
        line: None,
        message: format!(
            "the mesh is {size:.1e} units large; outside {least:e} to {most:e}, the fast kernel may miss hits and the watertight kernel is slow: scale the mesh or use the precise kernel"
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stray_points_are_not_framed() {
        let surface = Aabb::around([Vec3::ZERO, Vec3::ONE]);
        for (distance, is_framed) in [(10.0, true), (1e6, false)] {
            let point = Aabb::around([Vec3::splat(distance)]);
            assert_eq!(framed(surface, point) != surface, is_framed, "{distance}");
        }
        let line = Aabb::around([Vec3::ZERO, Vec3::X]);
        assert_eq!(framed(Aabb::EMPTY, line), line);
    }

    #[test]
    fn a_mesh_too_large_or_too_small_for_f32_kernels_gives_a_warning() {
        let library = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let (path, progress) = (Path::new("x.obj"), Progress::default());
        for (scale, is_warned) in [
            ("1e-20", true),
            ("1e-3", false),
            ("1e9", false),
            ("1e30", true),
        ] {
            let text = format!("v 0 0 0\nv {scale} 0 0\nv 0 {scale} 0\nf 1 2 3\n");
            let bytes = text.as_bytes();
            let loaded = obj::parse(bytes, path, LoadOptions::default(), &library, &progress);
            let loaded = LoadedScene::of(loaded.expect("good"), SceneOptions::default(), &progress);
            let warnings = loaded.expect("never cancelled").report.warnings;
            assert_eq!(
                warnings.len(),
                usize::from(is_warned),
                "{scale}: {warnings:?}"
            );
        }
    }
}

//! The open document: a scene, its file, and the intersectors that trace it.

mod packing;
mod shown_part;
mod sibling;

pub use shown_part::ShownPrimitives;

use crate::retired::{Retired, Shared};
use crate::task::{Pending, Task, TaskPanicked};
use glam::DVec3;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::light::{Environment, EnvironmentMap, Light, MapPlacement, PlacedMap};
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::{Crease, Health, TriangleMesh, bytes_as};
use hitscope_core::obj::{self, LoadError, LoadOptions};
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::scene::SceneOptions;
use hitscope_core::{Clip, Scene};
use hitscope_lab::requirement::{Requirement, required_tier};
use packing::Packing;
use shown_part::{Packed, Showing};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

pub(crate) const DEFAULT_OBJ: &str = include_str!("../../assets/default.obj");
const DEFAULT_MTL: &[u8] = include_bytes!("../../assets/default.mtl");
/// The rotation of the studio that lights the built-in scene, so that its brightest lamp isn't in the picture.
const STUDIO_ROTATION: f32 = 3.5;

/// Results of checking all triangles and edges.
#[derive(Clone, Debug)]
pub struct MeshReport {
    /// The mesh's health.
    pub health: Arc<Health>,
    /// The tier that the scene requires.
    pub requirement: Requirement,
    /// Size of the surface in each representation, in bytes.
    pub bytes_as: [(&'static str, usize); 3],
}

/// The open document: a scene ready to be traced. Created by a loading thread.
pub struct Document {
    /// The file; `None` for the built-in scene and if nothing is open.
    pub path: Option<PathBuf>,
    /// Whether nothing is open, and the scene is empty.
    pub is_blank: bool,
    /// The scene and facts about its file.
    pub loaded: LoadedScene,
    /// Time when loading began; the document doesn't contain later changes of the file.
    pub began: SystemTime,
    /// The offset that was asked for; see [`move_by`](Self::move_by).
    pub offset: f64,
    /// Whether the scene can't be moved by the offset.
    pub ignores_offset: bool,
    /// The part of the scene that is shown, in the file's coordinates.
    clip: Option<Clip>,
    showing: Showing,
    /// The number of changes of the part that is shown.
    part_changes: u64,
    packing: Packing,
    /// The second intersector of comparing views.
    second: Option<Packing>,
    /// The check of the mesh.
    check: Pending<Arc<MeshReport>>,
    /// Cancelled when the document is dropped, which ends the work on a better tree.
    progress: Progress,
    /// The work on the best tree.
    improvement: Pending<Result<(), Cancelled>>,
    /// Replaced data, which a background task frees.
    retired: Retired,
}

impl Drop for Document {
    fn drop(&mut self) {
        self.stop_improving();
    }
}

impl Shared for Document {
    fn is_shared(&self) -> bool {
        let scene = &self.loaded.scene;
        Arc::strong_count(scene) > 1 || scene.shares_groups() || self.packing.packed.is_shared()
    }
}

impl Document {
    /// Loads a file and packs it for a kernel.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(
        path: &Path,
        kernel: KernelChoice,
        load_options: LoadOptions,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, LoadError> {
        let began = SystemTime::now();
        let loaded = LoadedScene::load(path, load_options, options, progress)?;
        let mut document = Self::new(Some(path.to_owned()), loaded, kernel);
        document.began = began;
        Ok(document)
    }

    /// The built-in scene.
    pub fn embedded(kernel: KernelChoice) -> Self {
        Self::new(None, embedded_scene(), kernel)
    }

    /// An empty scene, shown until the first file is loaded.
    pub fn blank(kernel: KernelChoice) -> Self {
        let mesh = TriangleMesh::default();
        let scene = Scene::new(mesh, &Progress::default()).expect("never cancelled");
        let loaded = LoadedScene {
            scene: Arc::new(scene),
            report: Arc::default(),
            view: None,
            description: None,
            lights: Vec::new(),
        };
        let mut document = Self::new(None, loaded, kernel);
        document.is_blank = true;
        document
    }

    fn new(path: Option<PathBuf>, loaded: LoadedScene, kernel: KernelChoice) -> Self {
        let packing = Packing::new(kernel, Packed::of(&loaded.scene, kernel));
        Self::packed(path, loaded, packing)
    }

    fn packed(path: Option<PathBuf>, loaded: LoadedScene, packing: Packing) -> Self {
        Self {
            path,
            is_blank: false,
            offset: 0.0,
            ignores_offset: false,
            clip: None,
            showing: Showing::default(),
            part_changes: 0,
            packing,
            loaded,
            began: SystemTime::now(),
            second: None,
            check: Pending::Unasked,
            progress: Progress::default(),
            improvement: Pending::Unasked,
            retired: Retired::default(),
        }
    }

    /// Adds an offset along each axis to the coordinates in which the scene is stored, so that their rounding becomes
    /// visible. A scene that can't be moved stays as it is; see [`LoadedScene::moved`].
    pub fn move_by(&mut self, offset: f64) {
        self.offset = offset;
        if offset == 0.0 {
            return;
        }
        let Some(moved) = self.loaded.moved(DVec3::splat(offset)) else {
            self.ignores_offset = true;
            return;
        };
        let kernel = self.packing.kernel;
        self.packing = Packing::new(kernel, Packed::of(&moved.scene, kernel));
        self.loaded = moved;
    }

    /// Starts to build the scene's best tree unless the scene has it. The scene switches to it when it is built.
    pub fn improve(&mut self, ctx: &egui::Context) {
        if self.loaded.scene.has_best_tree() {
            self.improvement = Pending::Done(Ok(()));
        } else {
            let (scene, progress) = (Arc::clone(&self.loaded.scene), self.progress.clone());
            let improve = move || scene.improve(&progress);
            self.improvement = Pending::Running(Task::spawn("improve", ctx, improve));
        }
    }

    /// Collects the end of the work on the best tree.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if building failed; the first tree stays.
    pub fn poll_tree(&mut self) -> Result<(), TaskPanicked> {
        self.improvement.poll().map(|_| ())
    }

    /// Cancels building the best tree; the scene keeps its current tree.
    pub fn stop_improving(&self) {
        self.progress.cancel();
    }

    /// Whether the scene's tree is final.
    pub fn has_last_tree(&self) -> bool {
        self.improvement.is_over()
    }

    /// The origin of the scene's coordinates, in the file's coordinates.
    pub fn origin(&self) -> DVec3 {
        self.loaded.scene.mesh().origin()
    }

    /// The document's name for titles.
    pub fn name(&self) -> String {
        match self.path.as_deref().and_then(Path::file_name) {
            Some(name) => name.to_string_lossy().into_owned(),
            None if self.is_blank => "No file".to_owned(),
            None => "Built-in scene".to_owned(),
        }
    }

    /// Sets where smooth shading has creases. Returns whether that changed the scene.
    pub fn use_crease(&mut self, crease: Crease) -> bool {
        let scene = &mut self.loaded.scene;
        let is_new = scene.crease() != crease;
        if is_new {
            let new = Arc::new(scene.with_crease(crease));
            self.retired.add(std::mem::replace(scene, new));
        }
        is_new
    }

    /// Frees replaced data in the background.
    pub fn poll_retired(&mut self, ctx: &egui::Context) {
        self.retired.poll(ctx);
    }

    /// The mesh's health and required tier. The first call starts the check; `None` until it is done.
    pub fn findings(&mut self, ctx: &egui::Context) -> Option<Arc<MeshReport>> {
        if matches!(self.check, Pending::Unasked) {
            let scene = Arc::clone(&self.loaded.scene);
            let check = move || {
                let health = Arc::new(Health::of(scene.mesh()));
                let requirement = required_tier(&scene, &health);
                Arc::new(MeshReport {
                    health,
                    requirement,
                    bytes_as: bytes_as(scene.mesh()),
                })
            };
            self.check = Pending::Running(Task::spawn("health", ctx, check));
        }
        // The Mesh tab tells if it failed.
        _ = self.check.poll();
        self.known_findings()
    }

    /// Whether checking the mesh failed.
    pub fn has_failed_check(&self) -> bool {
        matches!(self.check, Pending::Failed)
    }

    /// Like [`findings`](Self::findings), without starting the check.
    pub fn known_findings(&self) -> Option<Arc<MeshReport>> {
        self.check.get().map(Arc::clone)
    }
}

/// The built-in scene, which is shown if no file is given.
pub fn embedded_scene() -> LoadedScene {
    let library = |name: &str| match name {
        "default.mtl" => Ok(DEFAULT_MTL.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let progress = Progress::default();
    let path = Path::new("the built-in scene");
    let loaded = obj::parse(
        DEFAULT_OBJ.as_bytes(),
        path,
        LoadOptions::default(),
        &library,
        &progress,
    );
    let loaded = loaded.expect("a test opens the built-in scene");
    let loaded = LoadedScene::of(loaded, SceneOptions::default(), &progress);
    let placement = MapPlacement {
        rotation_radians: STUDIO_ROTATION,
        ..MapPlacement::default()
    };
    let studio = PlacedMap::new(EnvironmentMap::built_in(), placement);
    LoadedScene {
        lights: vec![Light::Environment(Environment::Map(studio))],
        ..loaded.expect("never cancelled")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_scene_loads_without_warnings() {
        let loaded = embedded_scene();
        assert_eq!(loaded.report.warnings, []);
        let mesh = loaded.scene.mesh();
        let attributes = mesh.attributes();
        let groups = attributes.groups.entries();
        assert_eq!(groups, ["", "floor", "knot", "gem", "shell"]);
        assert!(
            attributes.materials.entries()[1..]
                .iter()
                .all(|m| m.diffuse.is_some())
        );
    }
}

//! The open document: a scene, its file, and the intersectors that trace it.

use crate::task::{KeyedTask, Task, TaskPanicked};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::light::{Environment, EnvironmentMap, Light, MapPlacement, PlacedMap};
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::{Crease, Health, TriangleMesh, bytes_as};
use hitscope_core::obj::{self, LoadError, LoadOptions, LoadReport};
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::scene::SceneOptions;
use hitscope_core::{Intersector, Scene};
use hitscope_lab::requirement::{Requirement, required_tier};
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
    intersector: Arc<dyn Intersector>,
    /// The kernel that was chosen for it. A shape whose table lacks this kernel uses another one.
    kernel: KernelChoice,
    /// The intersector for another kernel, while it is being built.
    packing: PackingTask,
    /// The second intersector of comparing views, and the next one while it is being built.
    second: Option<(KernelChoice, Arc<dyn Intersector>)>,
    packing_second: PackingTask,
    health: HealthState,
    /// Cancelled when the document is dropped, which ends the work on a better tree.
    progress: Progress,
    improvement: Improvement,
}

impl Drop for Document {
    fn drop(&mut self) {
        self.stop_improving();
    }
}

enum Improvement {
    Unasked,
    UnderWay(Task<Result<(), Cancelled>>),
    Over,
}

enum HealthState {
    Unasked,
    Checking(Task<MeshReport>),
    Known(Arc<MeshReport>),
    Failed,
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
            report: LoadReport::default(),
            view: None,
            description: None,
            lights: Vec::new(),
        };
        let mut document = Self::new(None, loaded, kernel);
        document.is_blank = true;
        document
    }

    fn new(path: Option<PathBuf>, loaded: LoadedScene, kernel: KernelChoice) -> Self {
        Self {
            path,
            is_blank: false,
            intersector: Arc::from(loaded.scene.intersector(kernel)),
            kernel,
            loaded,
            began: SystemTime::now(),
            packing: KeyedTask::default(),
            second: None,
            packing_second: KeyedTask::default(),
            health: HealthState::Unasked,
            progress: Progress::default(),
            improvement: Improvement::Unasked,
        }
    }

    /// Starts to build the scene's best tree unless the scene has it. The scene switches to it when it is built.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if building failed; the first tree stays.
    pub fn improve(&mut self, ctx: &egui::Context) -> Result<(), TaskPanicked> {
        match &self.improvement {
            Improvement::Unasked if self.loaded.scene.has_best_tree() => {
                self.improvement = Improvement::Over;
            }
            Improvement::Unasked => {
                let (scene, progress) = (Arc::clone(&self.loaded.scene), self.progress.clone());
                let improve = move || scene.improve(&progress);
                self.improvement = Improvement::UnderWay(Task::spawn("improve", ctx, improve));
            }
            Improvement::UnderWay(task) => match task.poll() {
                Ok(None) => {}
                Ok(Some(_)) => self.improvement = Improvement::Over,
                Err(broken) => {
                    self.improvement = Improvement::Over;
                    return Err(broken);
                }
            },
            Improvement::Over => {}
        }
        Ok(())
    }

    /// Cancels building the best tree; the scene keeps its current tree.
    pub fn stop_improving(&self) {
        self.progress.cancel();
    }

    /// Whether the scene's tree is final.
    pub fn has_last_tree(&self) -> bool {
        matches!(self.improvement, Improvement::Over)
    }

    /// The document's name for titles.
    pub fn name(&self) -> String {
        match self.path.as_deref().and_then(Path::file_name) {
            Some(name) => name.to_string_lossy().into_owned(),
            None if self.is_blank => "No file".to_owned(),
            None => "Built-in scene".to_owned(),
        }
    }

    /// Sets where smooth shading has creases.
    pub fn use_crease(&mut self, crease: Crease) {
        let scene = &mut self.loaded.scene;
        if scene.crease() != crease {
            *scene = Arc::new(scene.with_crease(crease));
        }
    }

    /// The intersector of the kernel that was packed last.
    pub fn intersector(&self) -> &Arc<dyn Intersector> {
        &self.intersector
    }

    /// Switches to a kernel as soon as the scene is packed for it.
    ///
    /// # Errors
    /// [`TaskPanicked`] if packing failed; the previous kernel stays.
    pub fn use_kernel(
        &mut self,
        kernel: KernelChoice,
        ctx: &egui::Context,
    ) -> Result<(), TaskPanicked> {
        if self.kernel == kernel {
            return Ok(());
        }
        let scene = &self.loaded.scene;
        if let Some(packed) = packed(&mut self.packing, scene, kernel, ctx)? {
            (self.intersector, self.kernel) = (packed, kernel);
        }
        Ok(())
    }

    /// The kernel that was chosen for the intersector.
    pub fn kernel(&self) -> KernelChoice {
        self.kernel
    }

    /// The intersector to compare with; the first one if there is no second.
    pub fn second(&self) -> &Arc<dyn Intersector> {
        let second = self.second.as_ref();
        second.map_or(&self.intersector, |(_, second)| second)
    }

    /// Packs the scene for a second kernel; `None` drops the second intersector.
    ///
    /// # Errors
    /// [`TaskPanicked`] if packing failed.
    pub fn use_second(
        &mut self,
        kernel: Option<KernelChoice>,
        ctx: &egui::Context,
    ) -> Result<(), TaskPanicked> {
        let Some(kernel) = kernel else {
            self.second = None;
            return Ok(());
        };
        if self.second.as_ref().map(|(packed, _)| *packed) == Some(kernel) {
            return Ok(());
        }
        let scene = &self.loaded.scene;
        if let Some(packed) = packed(&mut self.packing_second, scene, kernel, ctx)? {
            self.second = Some((kernel, packed));
        }
        Ok(())
    }

    /// The mesh's health and required tier. The first call starts the check; `None` until it is done.
    pub fn findings(&mut self, ctx: &egui::Context) -> Option<Arc<MeshReport>> {
        match &self.health {
            HealthState::Unasked => {
                let scene = Arc::clone(&self.loaded.scene);
                let check = move || {
                    let health = Arc::new(Health::of(scene.mesh()));
                    let requirement = required_tier(&scene, &health);
                    MeshReport {
                        health,
                        requirement,
                        bytes_as: bytes_as(scene.mesh()),
                    }
                };
                self.health = HealthState::Checking(Task::spawn("health", ctx, check));
            }
            HealthState::Checking(task) => match task.poll() {
                Ok(None) => {}
                Ok(Some(findings)) => self.health = HealthState::Known(Arc::new(findings)),
                Err(TaskPanicked) => self.health = HealthState::Failed,
            },
            HealthState::Known(_) | HealthState::Failed => {}
        }
        self.known_findings()
    }

    /// Whether checking the mesh failed.
    pub fn has_failed_check(&self) -> bool {
        matches!(self.health, HealthState::Failed)
    }

    /// Like [`findings`](Self::findings), without starting the check.
    pub fn known_findings(&self) -> Option<Arc<MeshReport>> {
        match &self.health {
            HealthState::Known(findings) => Some(Arc::clone(findings)),
            _ => None,
        }
    }
}

/// A task that packs the scene for a kernel, keyed by the kernel's name.
type PackingTask = KeyedTask<&'static str, Box<dyn Intersector>>;

/// The scene packed for a kernel, once ready. The first call for a kernel starts the packing.
fn packed(
    packing: &mut PackingTask,
    scene: &Arc<Scene>,
    kernel: KernelChoice,
    ctx: &egui::Context,
) -> Result<Option<Arc<dyn Intersector>>, TaskPanicked> {
    let scene = Arc::clone(scene);
    let pack = || Task::spawn("pack", ctx, move || scene.intersector(kernel));
    Ok(packing.get(kernel.info.name, pack)?.map(Arc::from))
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

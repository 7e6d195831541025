//! Loading of scenes from files: OBJ files, and scene files with the meshes that they name.
//!
//! | step | file |
//! |---|---|
//! | **a scene from the description of a scene file** | `assemble` |
//! | the shapes of the core that a transformed shape becomes | `placed` |
//! | its materials and textures | `materials`, `textures` |
//! | all meshes as one | `merge` |
//! | the memory that this takes | `memory` |
//! | errors with lines | `refusal` |
//! | the sensor as a view | `view` |
//! | emitters as lights, and materials that emit light | `lights` |
//! | what was loaded, as the text of a scene file | `saving` |
//!
//! Transforms are applied in f64 once; the results are rounded to f32 relative to one origin of the scene.

mod assemble;
mod lights;
mod materials;
mod memory;
mod merge;
mod placed;
mod refusal;
mod saving;
mod textures;
mod view;

pub use saving::scene_text;
pub use view::StartView;

use crate::integrator::{Integrator, Lighting, integrator};
use crate::light::Light;
use crate::mesh::SAFE_SIZE;
use crate::obj::{self, LoadError, LoadOptions, LoadReport, Loaded, Warning};
use crate::progress::{BackgroundError, Cancelled, Progress};
use crate::scene::{Scene, SceneOptions};
use crate::scene_file::{self, SceneFile};
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

/// A scene and facts about the file that it was loaded from.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The load report of the file.
    pub report: Arc<LoadReport>,
    /// The view that the file asks for, if it has one.
    pub view: Option<StartView>,
    /// The contents of the file if it is a scene file.
    pub description: Option<Arc<SceneFile>>,
    /// The lights of the file, in the scene's coordinates. Surfaces that emit light aren't among them: their materials
    /// say so.
    pub lights: Vec<Light>,
}

impl LoadedScene {
    /// Loads an OBJ file, or a scene file (`.xml`), and builds the trees.
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
            if is_scene_file(&file) {
                return assemble::load(&file, load_options, options, &shared);
            }
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

    /// The scene and its lights with an offset added to their coordinates; `None` if the scene can't be moved. See
    /// [`Scene::moved`].
    pub fn moved(&self, offset: DVec3) -> Option<Self> {
        let scene = Arc::new(self.scene.moved(offset)?);
        let lights = self.lights.iter().cloned();
        Some(Self {
            scene,
            lights: lights.map(|light| light.moved(offset)).collect(),
            ..self.clone()
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
        report.warnings.extend(size_warning(&scene));
        let scene = Arc::new(scene);
        Ok(Self {
            scene,
            report: Arc::new(report),
            view: None,
            description: None,
            lights: Vec::new(),
        })
    }

    /// The view that the file's integrator asks for, if it has one.
    pub fn integrator(&self) -> Option<&'static Integrator> {
        integrator(self.file_integrator()?.view?)
    }

    /// The settings of light transport, without lights: those of the file's integrator, or the defaults.
    pub fn lighting(&self) -> Lighting {
        let default = Lighting::default();
        match self.file_integrator() {
            Some(integrator) => Lighting {
                depth_limit: integrator.depth_limit,
                roulette_depth: integrator.roulette_depth,
                hides_emitters: integrator.hides_emitters,
                ..default
            },
            None => default,
        }
    }

    fn file_integrator(&self) -> Option<&scene_file::Integrator> {
        self.description.as_ref()?.integrator.as_ref()
    }
}

/// Whether a path names a scene file.
pub fn is_scene_file(path: &Path) -> bool {
    let extension = path.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
}

/// The warning about a scene that is empty, or whose size f32 kernels can't handle well. Infinite planes have no size.
fn size_warning(scene: &Scene) -> Option<Warning> {
    if scene.primitive_count() == 0 {
        return Some(Warning::of_file("the scene is empty".to_owned()));
    }
    let bounds = scene.bounds();
    let size = 2.0 * bounds.radius();
    if bounds.is_empty() || SAFE_SIZE.contains(&size) {
        return None;
    }
    let (least, most) = (SAFE_SIZE.start(), SAFE_SIZE.end());
    Some(Warning::of_file(format!(
        "the scene is {size:.1e} units large; outside {least:e} to {most:e}, the fast kernel may miss hits, and the watertight and exact kernels may be slow: scale the scene or use the precise kernel"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let loaded = loaded.expect("never cancelled");
            let warnings = &loaded.report.warnings;
            assert_eq!(
                warnings.len(),
                usize::from(is_warned),
                "{scale}: {warnings:?}"
            );
        }
    }
}

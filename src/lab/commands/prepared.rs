//! A loaded scene, ready for the pictures of its views by any camera.

use super::light::SceneLight;
use super::picture::{DARK_BACKGROUND, PictureArgs, Rendered, picture_bytes};
use super::{CameraArgs, CommandError};
use crate::progress::Meter;
use glam::Vec3;
use hitscope_core::integrator::{Context, Integrator, Lighting, ViewOptions};
use hitscope_core::loading::LoadedScene;
use hitscope_core::picture::{Alpha, Guides, TraceError, VisibleSurfaces, guides};
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, render_with_progress};
use hitscope_core::srgb::from_display;
use hitscope_core::{Camera, Intersector};
use std::cell::OnceCell;
use std::sync::Arc;

/// A loaded scene, packed for its kernel, with its views and its light.
pub struct PreparedScene<'a> {
    pub(super) args: &'a PictureArgs,
    pub(super) loaded: Arc<LoadedScene>,
    pub(super) intersector: Arc<dyn Intersector>,
    pub(super) views: Vec<&'static Integrator>,
    pub(super) has_guides: bool,
    /// Whether the background is transparent.
    pub(super) is_transparent: bool,
    /// `None` if no view needs light.
    pub(super) light: Option<SceneLight>,
}

impl PreparedScene<'_> {
    /// The views, at least one.
    pub fn views(&self) -> &[&'static Integrator] {
        &self.views
    }

    /// The scene.
    pub fn loaded(&self) -> &LoadedScene {
        &self.loaded
    }

    /// The camera that arguments describe.
    ///
    /// # Errors
    /// See [`CameraArgs::camera`].
    pub fn camera(&self, camera: &CameraArgs) -> Result<Camera, CommandError> {
        camera.camera(&self.loaded.scene, self.loaded.view.as_ref())
    }

    /// The scene as a camera sees it.
    pub fn seen_by(&self, camera: Camera) -> PreparedPicture<'_> {
        PreparedPicture {
            scene: self,
            camera,
            guides: OnceCell::new(),
        }
    }
}

/// A prepared scene as a camera sees it.
pub struct PreparedPicture<'a> {
    scene: &'a PreparedScene<'a>,
    camera: Camera,
    guides: OnceCell<Arc<Guides>>,
}

impl PreparedPicture<'_> {
    /// The scene.
    pub fn loaded(&self) -> &LoadedScene {
        self.scene.loaded()
    }

    /// Traces the picture of a view. `meter` shows how much of it is traced.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(
        &self,
        view: &'static Integrator,
        meter: &Meter,
    ) -> Result<Rendered, CommandError> {
        let (scene, args) = (self.scene, self.scene.args);
        let default = || args.scene.kernel.choice.default_second();
        let chosen = args.against.unwrap_or_else(default);
        let second = view.second(&scene.loaded.scene, &scene.intersector, chosen);
        self.require_memory(&second)?;
        let mut context = args.colours.apply(self.context(view, second), view)?;
        context.options.has_transparent_background = scene.is_transparent;
        let (shading, threads) = (context.shading, args.threads.count());
        // The colours were checked.
        let scale = view.scale(&context).ok().flatten();
        let job = Job {
            context,
            integrator: view,
            plan: Plan::new(self.camera.resolution(), 1, args.samples),
        };
        let guides = if scene.has_guides {
            Some(self.guides(&job)?)
        } else {
            None
        };
        let alpha = if scene.is_transparent {
            let (intersector, progress) = (&*job.context.intersector, Progress::default());
            let alpha = Alpha::trace(&self.camera, intersector, &job.plan, threads, &progress);
            Some(alpha.map_err(other)?)
        } else {
            None
        };
        let mut film = render_with_progress(job, threads, |part| meter.set(part))?;
        film.set_display(args.display.display(view));
        Ok(Rendered {
            view,
            film,
            scale,
            camera: self.camera,
            up_axis: args.camera.up_axis(scene.loaded.view.as_ref()),
            loaded: Arc::clone(&scene.loaded),
            shading,
            guides,
            alpha,
        })
    }

    /// Traces what the centres of the pixels show.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn surfaces(&self) -> Result<VisibleSurfaces, CommandError> {
        let scene = self.scene;
        let context = self.context(scene.views[0], Arc::clone(&scene.intersector));
        let threads = scene.args.threads.count();
        VisibleSurfaces::trace(&context, threads, &Progress::default()).map_err(other)
    }

    fn context(&self, view: &Integrator, second: Arc<dyn Intersector>) -> Context {
        let scene = self.scene;
        let light = scene.light.as_ref().filter(|_| view.needs.lights);
        Context {
            second,
            intersector: Arc::clone(&scene.intersector),
            scene: Arc::clone(&scene.loaded.scene),
            camera: self.camera,
            shading: scene.args.scene.shading.into(),
            // No light comes from a background.
            background: if scene.has_guides || scene.is_transparent {
                Vec3::ZERO
            } else {
                from_display(DARK_BACKGROUND)
            },
            lighting: light.map_or_else(Lighting::default, |light| light.seen_by(&self.camera)),
            options: ViewOptions::default(),
        }
    }

    fn guides(&self, job: &Job) -> Result<Arc<Guides>, CommandError> {
        if let Some(guides) = self.guides.get() {
            return Ok(Arc::clone(guides));
        }
        let threads = self.scene.args.threads.count();
        let guides = guides(&job.context, &job.plan, threads, &Progress::default());
        let guides = Arc::new(guides.map_err(other)?);
        Ok(Arc::clone(self.guides.get_or_init(|| guides)))
    }

    /// Refuses a picture that exceeds the memory limit together with the mesh.
    fn require_memory(&self, second: &Arc<dyn Intersector>) -> Result<(), CommandError> {
        let first = &self.scene.intersector;
        let mut packed_bytes = first.bytes();
        if !Arc::ptr_eq(first, second) {
            packed_bytes += second.bytes();
        }
        let size = self.camera.resolution();
        let what = format_args!("a picture of {}x{} pixels", size.x, size.y);
        let memory = self.scene.args.scene.mesh.memory;
        let scene = &self.loaded().scene;
        memory.require(picture_bytes(size), scene, packed_bytes, what)
    }
}

fn other(error: TraceError) -> CommandError {
    CommandError::Other(error.to_string())
}

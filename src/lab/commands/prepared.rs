//! A loaded scene, ready for the pictures of its views.

use super::CommandError;
use super::picture::{DARK_BACKGROUND, PictureArgs, Rendered, picture_bytes};
use glam::Vec3;
use hitscope_core::integrator::{Context, Integrator, Lighting, ViewOptions};
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::loading::LoadedScene;
use hitscope_core::picture::{Guides, TraceError, VisibleSurfaces, guides};
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, render};
use hitscope_core::srgb::from_display;
use hitscope_core::{Camera, Intersector};
use std::cell::OnceCell;
use std::sync::Arc;

/// A loaded scene, packed for its kernel, with its camera and views.
pub struct PreparedPicture<'a> {
    pub(super) args: &'a PictureArgs,
    pub(super) loaded: Arc<LoadedScene>,
    pub(super) camera: Camera,
    pub(super) intersector: Arc<dyn Intersector>,
    pub(super) views: Vec<&'static Integrator>,
    pub(super) has_guides: bool,
    /// The lights, for the views that need them.
    pub(super) lighting: OnceCell<Lighting>,
    pub(super) guides: OnceCell<Arc<Guides>>,
}

impl PreparedPicture<'_> {
    /// The views, at least one.
    pub fn views(&self) -> &[&'static Integrator] {
        &self.views
    }

    /// The scene.
    pub fn loaded(&self) -> &LoadedScene {
        &self.loaded
    }

    /// Traces the picture of a view.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self, view: &'static Integrator) -> Result<Rendered, CommandError> {
        let default = || exact_triangle_kernel().into();
        let chosen = self.args.against.unwrap_or_else(default);
        let second = view.second(&self.loaded.scene, &self.intersector, chosen);
        self.require_memory(&second)?;
        let context = self.args.colours.apply(self.context(view, second)?, view)?;
        let (shading, threads) = (context.shading, self.args.threads.count());
        // The colours were checked.
        let scale = view.scale(&context).ok().flatten();
        let job = Job {
            context,
            integrator: view,
            plan: Plan::new(self.camera.resolution(), 1, self.args.samples),
        };
        let guides = if self.has_guides {
            Some(self.guides(&job)?)
        } else {
            None
        };
        let mut film = render(job, threads)?;
        film.set_display(self.args.display.display());
        Ok(Rendered {
            view,
            film,
            scale,
            camera: self.camera,
            up_axis: self.args.camera.up_axis(self.loaded.view.as_ref()),
            loaded: Arc::clone(&self.loaded),
            shading,
            guides,
        })
    }

    /// Traces what the centres of the pixels show.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn surfaces(&self) -> Result<VisibleSurfaces, CommandError> {
        let context = self.context(self.views[0], Arc::clone(&self.intersector))?;
        let threads = self.args.threads.count();
        VisibleSurfaces::trace(&context, threads, &Progress::default()).map_err(other)
    }

    fn context(
        &self,
        view: &Integrator,
        second: Arc<dyn Intersector>,
    ) -> Result<Context, CommandError> {
        Ok(Context {
            second,
            intersector: Arc::clone(&self.intersector),
            scene: Arc::clone(&self.loaded.scene),
            camera: self.camera,
            shading: self.args.scene.shading.into(),
            // No light comes from a background.
            background: if self.has_guides {
                Vec3::ZERO
            } else {
                from_display(DARK_BACKGROUND)
            },
            lighting: self.lighting(view)?,
            options: ViewOptions::default(),
        })
    }

    /// The lights, if the view needs any.
    fn lighting(&self, view: &Integrator) -> Result<Lighting, CommandError> {
        if !view.needs.lights {
            return Ok(Lighting::default());
        }
        if let Some(lighting) = self.lighting.get() {
            return Ok(lighting.clone());
        }
        let max_memory = self.args.scene.mesh.memory.bytes();
        let lighting = self
            .args
            .light
            .lighting(&self.loaded, &self.camera, max_memory)?;
        Ok(self.lighting.get_or_init(|| lighting).clone())
    }

    fn guides(&self, job: &Job) -> Result<Arc<Guides>, CommandError> {
        if let Some(guides) = self.guides.get() {
            return Ok(Arc::clone(guides));
        }
        let threads = self.args.threads.count();
        let guides = guides(&job.context, &job.plan, threads, &Progress::default());
        let guides = Arc::new(guides.map_err(other)?);
        Ok(Arc::clone(self.guides.get_or_init(|| guides)))
    }

    /// Refuses a picture that exceeds the memory limit together with the mesh.
    fn require_memory(&self, second: &Arc<dyn Intersector>) -> Result<(), CommandError> {
        let mut packed_bytes = self.intersector.bytes();
        if !Arc::ptr_eq(&self.intersector, second) {
            packed_bytes += second.bytes();
        }
        let size = self.camera.resolution();
        let what = format_args!("a picture of {}x{} pixels", size.x, size.y);
        let (scene, memory) = (&self.loaded.scene, self.args.scene.mesh.memory);
        memory.require(picture_bytes(size), scene, packed_bytes, what)
    }
}

fn other(error: TraceError) -> CommandError {
    CommandError::Other(error.to_string())
}

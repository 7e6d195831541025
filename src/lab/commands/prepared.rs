//! A loaded scene, ready for the pictures of its views by any camera.

use super::legend::Legend;
use super::light::SceneLight;
use super::picture::{DARK_BACKGROUND, PictureArgs, Rendered, picture_bytes};
use super::{CameraArgs, CommandError};
use crate::progress::Meter;
use glam::{UVec2, Vec3};
use hitscope_core::colour::ColourScale;
use hitscope_core::integrator::{Context, Integrator, Lighting, ViewOptions};
use hitscope_core::loading::LoadedScene;
use hitscope_core::picture::{Guides, TraceError, VisibleSurfaces, guides};
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, Strip, Strips};
use hitscope_core::srgb::from_display;
use hitscope_core::{Camera, Intersector};
use std::cell::OnceCell;
use std::ops::Range;
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

    /// Prepares the picture of a view.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn view(&self, view: &'static Integrator) -> Result<PreparedView<'_>, CommandError> {
        let (scene, args) = (self.scene, self.scene.args);
        let default = || args.scene.kernel.choice.default_second();
        let chosen = args.against.unwrap_or_else(default);
        let second = view.second(&scene.loaded.scene, &scene.intersector, chosen);
        let mut context = args.colours.apply(self.context(view, second), view)?;
        context.options.has_transparent_background = scene.is_transparent;
        Ok(PreparedView {
            picture: self,
            // The colours were checked.
            scale: view.scale(&context).ok().flatten(),
            job: Job {
                context,
                integrator: view,
                plan: Plan::new(self.camera.resolution(), 1, args.samples),
            },
        })
    }

    /// Traces the whole picture of a view. `meter` shows how much of it is traced.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(
        &self,
        view: &'static Integrator,
        meter: &Meter,
    ) -> Result<Rendered, CommandError> {
        let view = self.view(view)?;
        view.require_whole()?;
        view.trace(0..view.size().y, meter)
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
}

/// A prepared picture of a view.
pub struct PreparedView<'a> {
    picture: &'a PreparedPicture<'a>,
    job: Job,
    /// The scale of its colours, if it shows numbers.
    scale: Option<ColourScale>,
}

impl PreparedView<'_> {
    /// The scale of its colours, if it shows numbers.
    pub fn scale(&self) -> Option<&ColourScale> {
        self.scale.as_ref()
    }

    /// The name of the view.
    pub fn name(&self) -> &'static str {
        self.job.integrator.name
    }

    /// The legend, if the view shows numbers.
    pub(super) fn legend(&self) -> Option<Legend<'_>> {
        Some(Legend::new(self.size(), self.scale()?))
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.job.plan.size()
    }

    /// The strips of the picture, with at most `bytes` of memory each, and less if the memory limit requires it.
    ///
    /// # Errors
    /// [`CommandError::Other`] if there isn't enough memory for any strip.
    pub fn strips(&self, bytes: u64) -> Result<Strips, CommandError> {
        let memory = self.picture.scene.args.scene.mesh.memory;
        let left = memory.left(&self.picture.loaded().scene, self.packed_bytes());
        let strips = Strips::new(self.size(), bytes.min(left));
        self.require_memory(strips.bytes())?;
        Ok(strips)
    }

    /// Traces rows of the picture. `meter` shows how much of the whole picture is traced.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self, rows: Range<u32>, meter: &Meter) -> Result<Rendered, CommandError> {
        let (picture, job) = (self.picture, &self.job);
        let (scene, args) = (picture.scene, picture.scene.args);
        let advanced = |part| {
            meter.set(part);
            true
        };
        let (threads, progress) = (args.threads.count(), Progress::default());
        let strip = Strip::render(job, rows, threads, &progress, advanced)?;
        let Strip {
            rows,
            mut film,
            alpha,
        } = strip;
        film.set_display(args.display.display(job.integrator));
        let guides = scene.has_guides.then(|| picture.guides(job));
        let guides = guides.transpose()?;
        Ok(Rendered {
            view: job.integrator,
            rows,
            film,
            scale: self.scale,
            camera: picture.camera,
            up_axis: args.camera.up_axis(scene.loaded.view.as_ref()),
            loaded: Arc::clone(&scene.loaded),
            shading: job.context.shading,
            guides,
            alpha,
        })
    }

    /// The memory of the scene's packed primitives.
    fn packed_bytes(&self) -> usize {
        let (first, second) = (&self.picture.scene.intersector, &self.job.context.second);
        let has_second = !Arc::ptr_eq(first, second);
        first.bytes() + if has_second { second.bytes() } else { 0 }
    }

    /// Refuses a whole picture that exceeds the memory limit together with the mesh.
    ///
    /// # Errors
    /// [`CommandError::Other`].
    pub(super) fn require_whole(&self) -> Result<(), CommandError> {
        self.require_memory(picture_bytes(self.size()))
    }

    /// Refuses work of this many bytes that exceeds the memory limit together with the mesh.
    fn require_memory(&self, bytes: u64) -> Result<(), CommandError> {
        let size = self.size();
        let what = format_args!("a picture of {}x{} pixels", size.x, size.y);
        let memory = self.picture.scene.args.scene.mesh.memory;
        let scene = &self.picture.loaded().scene;
        memory.require(bytes, scene, self.packed_bytes(), what)
    }
}

fn other(error: TraceError) -> CommandError {
    CommandError::Other(error.to_string())
}

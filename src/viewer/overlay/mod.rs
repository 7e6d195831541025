//! The overlay on the traced picture: wireframe, normals, flaws and the picked triangle.
//!
//! | module | contents |
//! |---|---|
//! | [`options`] | contents and styles of the overlay |
//! | [`wireframe`], [`normals`], [`marks`] | the lines of a mesh |
//! | [`shapes`] | the lines of other shapes |
//! | [`paths`] | the lines of a picked pixel's path |
//! | [`traced`] | the depth and the outlines of other shapes |
//! | `uploaded` | gathering and uploading lines in the background |
//! | `painter` | drawing in the background |

pub mod marks;
pub mod normals;
pub mod options;
mod painter;
pub mod paths;
pub mod shapes;
pub mod traced;
mod uploaded;
pub mod wireframe;

pub use options::Options;

use crate::gpu::GpuError;
use crate::gpu::depth::DepthMesh;
use crate::gpu::drawing::{Drawing, DrawnLines, Overlay};
use crate::gpu::lines::{Line, LineOcclusion, LineSet, StyleUniform};
use crate::gpu::traced::TracedLayer;
use crate::gpu::view::ViewUniform;
use crate::task::TaskPanicked;
use eframe::egui_wgpu::RenderState;
use hitscope_core::integrator::PathRecord;
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::scene::Shading;
use hitscope_core::{Camera, Scene};
use painter::Painter;
use paths::PathLines;
use std::sync::Arc;
use traced::Shapes;
use uploaded::{Readiness, Uploaded};
use wireframe::WireframeEdges;

/// Marks are drawn twice, so that they are faint where the mesh hides them and strong elsewhere.
const FAINT_AND_STRONG: [(LineOcclusion, f32); 2] =
    [(LineOcclusion::Through, 0.3), (LineOcclusion::Hidden, 1.0)];

/// An error that keeps the overlay from being drawn.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// A GPU error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A thread that gathers or draws lines panicked.
    #[error(transparent)]
    TaskPanicked(#[from] TaskPanicked),
}

/// The overlay of the window's picture.
pub struct OverlayLayer {
    overlay: Arc<Overlay>,
    /// Whether the adapter is software: drawing lines then takes longer than tracing.
    is_software: bool,
    scene: Option<Arc<Scene>>,
    mesh: Uploaded<(), DepthMesh>,
    /// Other shapes, and what each pixel of a view shows of them.
    shapes: Shapes,
    traced: Uploaded<ViewUniform, TracedLayer>,
    wireframe: Uploaded<WireframeEdges, LineSet>,
    shape_lines: Uploaded<(), LineSet>,
    normals: Uploaded<Shading, LineSet>,
    elements: Uploaded<(), LineSet>,
    flaws: Uploaded<Flaw, LineSet>,
    picked: Uploaded<u32, LineSet>,
    /// The path to draw, with a number that tells it from earlier ones.
    path: Option<(u64, Arc<PathRecord>)>,
    path_count: u64,
    path_lines: [Uploaded<u64, LineSet>; 3],
    painter: Painter,
    /// The options of the last call.
    options: Options,
    is_complete: bool,
}

/// Lines that are ready to be drawn.
#[derive(Default)]
struct Ready {
    sets: Vec<DrawnLines>,
    /// Whether more lines are being prepared.
    is_pending: bool,
}

impl Ready {
    fn add(&mut self, lines: Readiness<LineSet>, looks: &[(LineOcclusion, StyleUniform)]) {
        match lines {
            Readiness::Ready(lines) => {
                let drawn = looks.iter().map(|&(occlusion, style)| DrawnLines {
                    lines: Arc::clone(&lines),
                    style,
                    occlusion,
                });
                self.sets.extend(drawn);
            }
            Readiness::Pending => self.is_pending = true,
            Readiness::Failed => {}
        }
    }
}

impl OverlayLayer {
    /// Compiles the shaders.
    pub fn new(render_state: &RenderState) -> Self {
        let overlay = Arc::new(Overlay::new(&render_state.device, &render_state.queue));
        let is_software = render_state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        Self {
            painter: Painter::new(Arc::clone(&overlay), is_software),
            overlay,
            is_software,
            scene: None,
            mesh: Uploaded::default(),
            shapes: Shapes::default(),
            traced: Uploaded::default(),
            wireframe: Uploaded::default(),
            shape_lines: Uploaded::default(),
            normals: Uploaded::default(),
            elements: Uploaded::default(),
            flaws: Uploaded::default(),
            picked: Uploaded::default(),
            path: None,
            path_count: 0,
            path_lines: Default::default(),
            options: Options::NOTHING,
            is_complete: true,
        }
    }

    /// Sets the path that is drawn if the options say so.
    pub fn set_path(&mut self, path: Option<&Arc<PathRecord>>) {
        let is_same = match (&self.path, path) {
            (Some((_, old)), Some(new)) => Arc::ptr_eq(old, new),
            (None, None) => true,
            _ => false,
        };
        if !is_same {
            self.path_count += 1;
            self.path = path.map(|path| (self.path_count, Arc::clone(path)));
        }
    }

    /// The overlay for a camera, as a texture of the picture's size; `None` if nothing is drawn. Lines that aren't
    /// ready are omitted; a repaint is requested when they are.
    ///
    /// # Errors
    /// See [`OverlayError`].
    pub fn draw(
        &mut self,
        scene: &Arc<Scene>,
        health: Option<&Arc<Health>>,
        camera: &Camera,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<Option<wgpu::Texture>, OverlayError> {
        self.is_complete = true;
        if options.is_nothing() {
            self.options = *options;
            self.painter.cancel();
            return Ok(None);
        }
        self.use_scene(scene);
        self.retry_if_turned_on(options);
        let shared = Arc::clone(scene);
        let upload = move |device: &_, queue: &_| DepthMesh::new(device, queue, shared.mesh());
        let mesh = match self.mesh.get((), &self.overlay, ctx, upload)? {
            Readiness::Ready(mesh) => mesh,
            Readiness::Failed => return Ok(None),
            Readiness::Pending => {
                self.is_complete = false;
                return Ok(None);
            }
        };
        let view = ViewUniform::new(camera, &scene.bounds_with_elements());
        let traced = match self.trace(scene, camera, view, ctx)? {
            Some(Readiness::Ready(traced)) => Some(traced),
            Some(Readiness::Pending) => {
                self.is_complete = false;
                return Ok(None);
            }
            Some(Readiness::Failed) | None => None,
        };
        let mut ready = Ready::default();
        self.prepare_lines(&mut ready, scene, options, ctx)?;
        self.prepare_marks(&mut ready, scene, health, options, ctx)?;
        self.prepare_path(&mut ready, scene, options, ctx)?;
        let drawing = Drawing {
            view,
            mesh,
            traced,
            outline: options.wireframe.map(|_| options.wire_style()),
            sets: ready.sets,
        };
        let texture = self.painter.draw(&drawing, ctx)?.cloned();
        self.is_complete = !ready.is_pending && self.painter.is_shown(&drawing);
        Ok(texture)
    }

    /// What each pixel shows of shapes that aren't triangles; `None` if the scene has none.
    fn trace(
        &mut self,
        scene: &Arc<Scene>,
        camera: &Camera,
        view: ViewUniform,
        ctx: &egui::Context,
    ) -> Result<Option<Readiness<TracedLayer>>, OverlayError> {
        if !scene.has_other_shapes() {
            return Ok(None);
        }
        let (shapes, shared, camera) = (self.shapes.clone(), Arc::clone(scene), *camera);
        let trace = move |device: &wgpu::Device, queue: &wgpu::Queue| {
            let pixels = shapes.trace(&shared, &camera, &view);
            Ok(TracedLayer::new(device, queue, view.size(), &pixels))
        };
        self.traced.get(view, &self.overlay, ctx, trace).map(Some)
    }

    /// Whether the last texture shows everything that was requested.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Whether lines are omitted while the camera moves, so that the picture can keep up.
    pub fn omits_lines_while_moving(&self, scene: &Scene) -> bool {
        // Each view of shapes takes one traced ray per pixel.
        self.is_software || scene.has_other_shapes()
    }

    /// Whether lines are drawn by software, in the background.
    #[cfg(test)]
    pub(crate) fn is_software(&self) -> bool {
        self.is_software
    }

    /// Discards the old scene's lines if the scene is another.
    fn use_scene(&mut self, scene: &Arc<Scene>) {
        if self
            .scene
            .as_ref()
            .is_some_and(|old| Arc::ptr_eq(old, scene))
        {
            return;
        }
        let old = self.scene.replace(Arc::clone(scene));
        self.normals = Uploaded::default();
        // If the mesh is the same, only the creases of smooth shading have changed.
        if old.is_none_or(|old| !std::ptr::eq(old.mesh(), scene.mesh())) {
            self.mesh = Uploaded::default();
            self.shapes = Shapes::default();
            self.traced = Uploaded::default();
            self.wireframe = Uploaded::default();
            self.shape_lines = Uploaded::default();
            self.elements = Uploaded::default();
            self.flaws = Uploaded::default();
            self.picked = Uploaded::default();
        }
    }

    /// Allows a retry of failed uploads when the user turns lines on again.
    fn retry_if_turned_on(&mut self, options: &Options) {
        let before = std::mem::replace(&mut self.options, *options);
        let turns_on_wireframe = options.wireframe.is_some() && before.wireframe.is_none();
        let turns_on_normals = options.normals.is_some() && before.normals.is_none();
        if turns_on_wireframe || turns_on_normals {
            self.mesh.forget_failure();
            self.traced.forget_failure();
            self.shape_lines.forget_failure();
            self.wireframe.forget_failure();
            self.normals.forget_failure();
        }
    }

    /// Prepares the lines that the settings turn on.
    fn prepare_lines(
        &mut self,
        ready: &mut Ready,
        scene: &Arc<Scene>,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<(), OverlayError> {
        let hidden = |style| [(LineOcclusion::Hidden, style)];
        if let Some(edges) = options.wireframe {
            let shared = Arc::clone(scene);
            let gather = uploader(move || wireframe::lines(shared.mesh(), edges));
            let lines = self.wireframe.get(edges, &self.overlay, ctx, gather)?;
            ready.add(lines, &hidden(options.wire_style()));
            if scene.has_other_shapes() {
                let shared = Arc::clone(scene);
                let gather = uploader(move || shapes::lines(&shared));
                let lines = self.shape_lines.get((), &self.overlay, ctx, gather)?;
                ready.add(lines, &hidden(options.shape_style()));
            }
        }
        if let Some(shading) = options.normals {
            let shared = Arc::clone(scene);
            let gather = uploader(move || normals::lines(&shared, shading));
            let lines = self.normals.get(shading, &self.overlay, ctx, gather)?;
            ready.add(lines, &hidden(options.normal_style()));
        }
        if options.elements {
            let shared = Arc::clone(scene);
            let gather = uploader(move || marks::elements(&shared));
            let lines = self.elements.get((), &self.overlay, ctx, gather)?;
            ready.add(lines, &hidden(options.element_style()));
        }
        Ok(())
    }

    /// Prepares the marks of the selected flaws and the picked triangle.
    fn prepare_marks(
        &mut self,
        ready: &mut Ready,
        scene: &Arc<Scene>,
        health: Option<&Arc<Health>>,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<(), OverlayError> {
        if let (Some(flaw), Some(health)) = (options.flaw, health) {
            let (shared, health) = (Arc::clone(scene), Arc::clone(health));
            let gather = uploader(move || marks::flaws(&shared, &health, flaw));
            let lines = self.flaws.get(flaw, &self.overlay, ctx, gather)?;
            let style = |(occlusion, alpha)| (occlusion, options.flaw_style(alpha));
            ready.add(lines, &FAINT_AND_STRONG.map(style));
        }
        if let Some(primitive) = options.picked {
            let shared = Arc::clone(scene);
            let gather = uploader(move || wireframe::primitive_lines(&shared, primitive));
            let lines = self.picked.get(primitive, &self.overlay, ctx, gather)?;
            let style = |(occlusion, alpha)| (occlusion, options.picked_style(alpha));
            ready.add(lines, &FAINT_AND_STRONG.map(style));
        }
        Ok(())
    }

    /// Prepares the lines of the path.
    fn prepare_path(
        &mut self,
        ready: &mut Ready,
        scene: &Arc<Scene>,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<(), OverlayError> {
        let Some((number, path)) = self.path.clone().filter(|_| options.path) else {
            return Ok(());
        };
        for (kind, uploaded) in PathLines::ALL.into_iter().zip(&mut self.path_lines) {
            let (shared, path) = (Arc::clone(scene), Arc::clone(&path));
            let gather = uploader(move || paths::lines(&shared, &path, kind));
            let lines = uploaded.get(number, &self.overlay, ctx, gather)?;
            let style = |(occlusion, alpha)| (occlusion, options.path_style(kind, alpha));
            ready.add(lines, &FAINT_AND_STRONG.map(style));
        }
        Ok(())
    }
}

/// A closure that gathers lines and uploads them.
fn uploader(
    gather: impl FnOnce() -> Vec<Line> + Send + 'static,
) -> impl FnOnce(&wgpu::Device, &wgpu::Queue) -> Result<LineSet, GpuError> + Send + 'static {
    move |device, queue| LineSet::new(device, queue, &gather())
}

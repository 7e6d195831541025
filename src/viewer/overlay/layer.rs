//! The overlay of the window's picture. Lines are gathered, uploaded and, on a software GPU, drawn in the background.

use super::contents::{Contents, WantedLines};
use super::gather::Key;
use super::input::OverlayInput;
use super::painter::Painter;
use super::state::Overlays;
use super::traced::Shapes;
use super::uploaded::{Readiness, Uploaded};
use crate::gpu::GpuError;
use crate::gpu::depth::DepthMesh;
use crate::gpu::drawing::{Drawing, DrawnLines, Overlay};
use crate::gpu::lines::LineSet;
use crate::gpu::traced::TracedLayer;
use crate::gpu::view::ViewUniform;
use crate::task::TaskPanicked;
use eframe::egui_wgpu::RenderState;
use glam::UVec2;
use hitscope_core::plan::PixelRect;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::{Camera, Scene};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// An error that keeps the overlay from being drawn.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// A GPU error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A thread that gathers or draws lines panicked.
    #[error(transparent)]
    TaskPanicked(#[from] TaskPanicked),
    /// The overlay was dropped while it was gathered.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Whether the camera moves.
#[derive(Clone, Copy)]
enum Motion {
    Still,
    Moving,
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
    /// Lines by their slots.
    lines: BTreeMap<usize, Uploaded<Key, LineSet>>,
    painter: Painter,
    /// The camera of the last drawing while the camera was still.
    lines_camera: Option<Camera>,
    /// The slots of the last drawing's lines.
    wanted: BTreeSet<usize>,
    /// The picture size for which there wasn't enough memory.
    refused: Option<UVec2>,
    is_complete: bool,
}

impl OverlayLayer {
    /// Compiles the shaders. Draws as on an adapter of this type.
    pub fn new(render_state: &RenderState, adapter: wgpu::DeviceType) -> Self {
        let is_software = adapter == wgpu::DeviceType::Cpu;
        let overlay = Arc::new(Overlay::new(&render_state.device, &render_state.queue));
        Self {
            painter: Painter::new(Arc::clone(&overlay), is_software),
            overlay,
            is_software,
            lines_camera: None,
            scene: None,
            mesh: Uploaded::default(),
            shapes: Shapes::default(),
            traced: Uploaded::default(),
            lines: BTreeMap::new(),
            wanted: BTreeSet::new(),
            refused: None,
            is_complete: true,
        }
    }

    /// Draws nothing: cancels the drawing in progress.
    fn pause(&mut self) {
        self.is_complete = true;
        self.painter.cancel();
    }

    /// The overlays that are on, as a texture of the picture's size; `None` if nothing is drawn. While lines are
    /// gathered, the last ones of the same kind are drawn, if there are any; a repaint is requested when the new ones
    /// are ready.
    ///
    /// # Errors
    /// See [`OverlayError`].
    pub fn draw(
        &mut self,
        input: &OverlayInput,
        overlays: &Overlays,
        ctx: &egui::Context,
    ) -> Result<Option<wgpu::Texture>, OverlayError> {
        self.lines_camera = Some(input.camera);
        self.draw_in(Motion::Still, input, overlays, ctx)
    }

    /// Draws while the camera moves. Shapes other than meshes have no outlines and hide no lines then, because that
    /// takes one traced ray per pixel of each view. On a software GPU nothing is drawn, so that the picture can keep
    /// up.
    ///
    /// # Errors
    /// See [`OverlayError`].
    pub fn draw_moving(
        &mut self,
        input: &OverlayInput,
        overlays: &Overlays,
        ctx: &egui::Context,
    ) -> Result<Option<wgpu::Texture>, OverlayError> {
        if self.is_software {
            self.pause();
            return Ok(None);
        }
        // Lines for each view would be gathered too late, and take threads.
        let input = OverlayInput {
            lines_camera: *self.lines_camera.get_or_insert(input.camera),
            ..input.clone()
        };
        self.draw_in(Motion::Moving, &input, overlays, ctx)
    }

    fn draw_in(
        &mut self,
        motion: Motion,
        input: &OverlayInput,
        overlays: &Overlays,
        ctx: &egui::Context,
    ) -> Result<Option<wgpu::Texture>, OverlayError> {
        let contents = Contents::of(input, overlays);
        self.use_scene(&input.scene);
        self.retry_if_turned_on(&contents.lines);
        self.is_complete = true;
        if contents.lines.is_empty() || self.refused == Some(contents.view.size()) {
            self.pause();
            return Ok(None);
        }
        let shared = Arc::clone(&input.scene);
        let upload =
            move |device: &_, queue: &_, _: &_| Ok(DepthMesh::new(device, queue, &shared)?);
        let mesh = match self.mesh.get((), &self.overlay, ctx, upload)? {
            Readiness::Ready(mesh) => mesh,
            Readiness::Failed => return Ok(None),
            Readiness::Pending(_) => {
                self.is_complete = false;
                return Ok(None);
            }
        };
        let traced = match motion {
            Motion::Still => self.trace(&input.scene, &input.camera, contents.view, ctx)?,
            Motion::Moving => None,
        };
        let traced = match traced {
            Some(Readiness::Ready(traced)) => Some(traced),
            // That of another view would be wrong.
            Some(Readiness::Pending(_)) => {
                self.is_complete = false;
                if self.is_software {
                    return Ok(None);
                }
                // As while the camera moved.
                None
            }
            Some(Readiness::Failed) | None => None,
        };
        let mut sets = Vec::new();
        for lines in &contents.lines {
            sets.extend(self.upload(lines, &input.scene, ctx)?);
        }
        let drawing = Drawing {
            view: contents.view,
            mesh,
            outline: contents.outline.filter(|_| traced.is_some()),
            traced,
            sets,
        };
        self.paint(&drawing, ctx)
    }

    /// Draws, and remembers a size for which there isn't enough memory.
    fn paint(
        &mut self,
        drawing: &Drawing,
        ctx: &egui::Context,
    ) -> Result<Option<wgpu::Texture>, OverlayError> {
        let texture = match self.painter.draw(drawing, ctx) {
            Ok(texture) => texture.cloned(),
            Err(error) => {
                let lacks_memory = matches!(error, OverlayError::Gpu(_));
                self.refused = lacks_memory.then(|| drawing.view.size());
                return Err(error);
            }
        };
        self.is_complete &= self.painter.is_shown(drawing);
        Ok(texture)
    }

    /// Frees the memory of the lines. They are uploaded again when they are next drawn.
    pub fn release(&mut self) {
        self.painter = Painter::new(Arc::clone(&self.overlay), self.is_software);
        self.scene = None;
        self.discard();
    }

    /// The lines as far as they are ready, once for each of their styles.
    fn upload(
        &mut self,
        wanted: &WantedLines,
        scene: &Arc<Scene>,
        ctx: &egui::Context,
    ) -> Result<Vec<DrawnLines>, OverlayError> {
        let (gather, shared) = (wanted.gather.clone(), Arc::clone(scene));
        let upload = move |device: &wgpu::Device, queue: &wgpu::Queue, _: &Progress| {
            Ok(LineSet::new(device, queue, &gather.lines(&shared))?)
        };
        let uploaded = self.lines.entry(wanted.slot).or_default();
        let key = wanted.gather.key().clone();
        let lines = match uploaded.get(key, &self.overlay, ctx, upload)? {
            Readiness::Ready(lines) => Some(lines),
            Readiness::Pending(last) => {
                self.is_complete = false;
                last
            }
            Readiness::Failed => None,
        };
        let drawn = |lines: Arc<LineSet>| {
            let looks = wanted.looks.iter();
            let set = |&(kind, style): &_| DrawnLines {
                lines: Arc::clone(&lines),
                style,
                kind,
            };
            looks.map(set).collect()
        };
        Ok(lines.map(drawn).unwrap_or_default())
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
        let trace = move |device: &wgpu::Device, queue: &wgpu::Queue, progress: &Progress| {
            let whole = PixelRect::whole(camera.resolution());
            let pixels = shapes.trace(&shared, &camera, &view, whole, progress)?;
            Ok(TracedLayer::new(device, queue, view.size(), &pixels)?)
        };
        self.traced.get(view, &self.overlay, ctx, trace).map(Some)
    }

    /// Whether the last texture shows everything that was requested.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Whether lines are drawn by software, in the background.
    #[cfg(test)]
    pub(crate) fn is_software(&self) -> bool {
        self.is_software
    }

    /// Discards the old scene's lines if the scene has other shapes.
    fn use_scene(&mut self, scene: &Arc<Scene>) {
        let old = self.scene.replace(Arc::clone(scene));
        // If the shapes are the same, only the clip, the creases of smooth shading or the tree have changed.
        if old.is_none_or(|old| !old.has_shapes_of(scene)) {
            self.discard();
        }
    }

    fn discard(&mut self) {
        self.mesh = Uploaded::default();
        self.shapes = Shapes::default();
        self.traced = Uploaded::default();
        self.lines.clear();
    }

    /// Allows a retry of failed uploads when the user turns an overlay on.
    fn retry_if_turned_on(&mut self, lines: &[WantedLines]) {
        let slots = lines.iter().map(|lines| lines.slot).collect();
        let before = std::mem::replace(&mut self.wanted, slots);
        let is_new =
            |lines: &WantedLines| lines.overlay.is_switch() && !before.contains(&lines.slot);
        if lines.iter().any(is_new) {
            self.refused = None;
            self.mesh.forget_failure();
            self.traced.forget_failure();
            self.lines
                .values_mut()
                .for_each(|lines| lines.forget_failure());
        }
    }
}

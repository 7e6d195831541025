//! Wireframe, normals, flaws and the picked triangle, over the traced picture.
//!
//! Lines are gathered from the mesh in the background, when they are first asked for.

pub mod marks;
pub mod normals;
pub mod wireframe;

use crate::gpu::depth::DepthMesh;
use crate::gpu::lines::{Line, LineOcclusion, LineSet, StyleUniform};
use crate::gpu::view::ViewUniform;
use crate::gpu::{GpuError, Overlay};
use crate::task::{KeyedTask, Task, TaskPanicked};
use eframe::egui_wgpu::RenderState;
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::scene::Shading;
use hitscope_core::{Camera, Scene};
use std::sync::Arc;
use wireframe::WireframeEdges;

/// What is drawn over the picture. Lengths are in physical pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The mesh's edges.
    pub wireframe: Option<WireframeEdges>,
    /// sRGB of the edges.
    pub wire_colour: [u8; 3],
    /// Normals, of which kind.
    pub normals: Option<Shading>,
    /// Length of the normals, as a part of the mesh's radius.
    pub normal_length: f32,
    /// The file's own lines and points.
    pub elements: bool,
    /// Where flaws of this kind are.
    pub flaw: Option<Flaw>,
    /// The picked triangle.
    pub picked: Option<u32>,
    /// Width of the wireframe's lines in pixels.
    pub line_width_px: f32,
}

impl Options {
    /// No lines at all.
    pub const NOTHING: Self = Self {
        wireframe: None,
        wire_colour: [0; 3],
        normals: None,
        normal_length: 0.0,
        elements: false,
        flaw: None,
        picked: None,
        line_width_px: 1.0,
    };

    fn is_nothing(&self) -> bool {
        self.wireframe.is_none()
            && self.normals.is_none()
            && !self.elements
            && self.flaw.is_none()
            && self.picked.is_none()
    }

    pub(crate) fn wire_style(&self) -> StyleUniform {
        let [r, g, b] = self.wire_colour.map(|c| f32::from(c) / 255.0);
        style([r, g, b, 0.85], self.line_width_px, 1.0)
    }

    pub(crate) fn normal_style(&self) -> StyleUniform {
        StyleUniform {
            stretch: self.normal_length,
            ..style([0.16, 0.55, 0.95, 0.8], self.line_width_px, 1.0)
        }
    }

    pub(crate) fn element_style(&self) -> StyleUniform {
        style([0.10, 0.75, 0.62, 0.95], 1.6 * self.line_width_px, 0.0)
    }

    fn flaw_style(&self, alpha: f32) -> StyleUniform {
        style([0.95, 0.15, 0.20, alpha], 2.6 * self.line_width_px, 0.0)
    }

    fn picked_style(&self, alpha: f32) -> StyleUniform {
        style([1.0, 0.55, 0.0, alpha], 2.2 * self.line_width_px, 0.0)
    }
}

/// What marks something is drawn twice: faint where the mesh hides it, strong where it doesn't.
const FAINT_AND_STRONG: [f32; 2] = [0.3, 1.0];
const BOTH_OCCLUSIONS: [LineOcclusion; 2] =
    [LineOcclusion::ThroughMesh, LineOcclusion::HiddenByMesh];

/// Gives marks their looks, and says how each is drawn.
fn drawn_marks<'m>(
    marks: &'m Marks,
    queue: &wgpu::Queue,
    style: impl Fn(f32) -> StyleUniform,
) -> impl Iterator<Item = (&'m LineSet, LineOcclusion)> {
    for (set, alpha) in marks.iter().zip(FAINT_AND_STRONG) {
        set.set_style(queue, &style(alpha));
    }
    marks.iter().zip(BOTH_OCCLUSIONS)
}

fn style(colour: [f32; 4], width_px: f32, fade: f32) -> StyleUniform {
    StyleUniform {
        colour,
        half_width_px: 0.5 * width_px,
        stretch: 1.0,
        fade,
        padding: 0.0,
    }
}

/// Lines that mark something: once to be drawn faint where the mesh hides them, once strong where it doesn't.
type Marks = [LineSet; 2];

/// A set of lines of one kind: which it is, once it is on the GPU, and on the way there.
struct Lines<K, S = LineSet> {
    ready: Option<(K, S)>,
    gathering: KeyedTask<K, Vec<Line>>,
}

impl<K, S> Default for Lines<K, S> {
    fn default() -> Self {
        Self {
            ready: None,
            gathering: KeyedTask::default(),
        }
    }
}

impl<K: Copy + PartialEq + Send + 'static, S> Lines<K, S> {
    /// Sees to it that the lines of this kind get ready; whether they just did.
    fn prepare(
        &mut self,
        kind: K,
        ctx: &egui::Context,
        gather: impl FnOnce() -> Vec<Line> + Send + 'static,
        upload: impl FnOnce(&[Line]) -> Result<S, GpuError>,
    ) -> Result<bool, OverlayError> {
        if self.ready.as_ref().is_some_and(|(ready, _)| *ready == kind) {
            return Ok(false);
        }
        let start = || Task::spawn("lines", ctx, gather);
        let Some(lines) = self.gathering.get(kind, start)? else {
            return Ok(false);
        };
        self.ready = Some((kind, upload(&lines)?));
        Ok(true)
    }
}

/// Why the overlay can't be drawn.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// The GPU refuses.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Gathering lines failed.
    #[error(transparent)]
    TaskPanicked(#[from] TaskPanicked),
}

/// The overlay of the window's picture.
pub struct OverlayLayer {
    render_state: RenderState,
    /// Whether the adapter is software: drawing lines then takes longer than tracing.
    is_software: bool,
    overlay: Overlay,
    scene: Option<Arc<Scene>>,
    mesh: Option<DepthMesh>,
    wireframe: Lines<WireframeEdges>,
    normals: Lines<Shading>,
    elements: Lines<()>,
    flaws: Lines<Flaw, Marks>,
    picked: Option<(u32, Marks)>,
    texture: Option<wgpu::Texture>,
    /// What the texture shows.
    drawn: Option<(ViewUniform, Options)>,
}

impl OverlayLayer {
    /// Compiles the shaders.
    pub fn new(render_state: RenderState) -> Self {
        Self {
            overlay: Overlay::new(&render_state.device),
            is_software: render_state.adapter.get_info().device_type == wgpu::DeviceType::Cpu,
            render_state,
            scene: None,
            mesh: None,
            wireframe: Lines::default(),
            normals: Lines::default(),
            elements: Lines::default(),
            flaws: Lines::default(),
            picked: None,
            texture: None,
            drawn: None,
        }
    }

    /// The overlay for a camera, as a texture of the picture's size; `None` if nothing is to be
    /// drawn. What isn't ready yet is missing, and a repaint comes when it is.
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
    ) -> Result<Option<&wgpu::Texture>, OverlayError> {
        if options.is_nothing() {
            return Ok(None);
        }
        self.use_scene(scene)?;
        if self.mesh.is_none() {
            return Ok(None);
        }
        let mut is_new = self.prepare(scene, options, ctx)?;
        if let (Some(flaw), Some(health)) = (options.flaw, health) {
            is_new |= self.prepare_flaws(scene, health, flaw, options, ctx)?;
        }
        let view = ViewUniform::new(camera, &scene.bounds_with_elements());
        if is_new || self.drawn != Some((view, *options)) {
            self.redraw(&view, options);
            self.drawn = Some((view, *options));
        }
        Ok(self.texture.as_ref())
    }

    /// Whether lines are to be left out while the camera moves, for the picture to follow it.
    pub fn rests_while_moving(&self) -> bool {
        self.is_software
    }

    /// Starts anew for another scene.
    fn use_scene(&mut self, scene: &Arc<Scene>) -> Result<(), GpuError> {
        if self
            .scene
            .as_ref()
            .is_some_and(|old| Arc::ptr_eq(old, scene))
        {
            return Ok(());
        }
        // Should the mesh be refused, this isn't tried again.
        let old = self.scene.replace(Arc::clone(scene));
        if old.is_some_and(|old| std::ptr::eq(old.mesh(), scene.mesh())) {
            // Only the edges of smooth shading moved.
            self.normals = Lines::default();
            self.drawn = None;
            return Ok(());
        }
        self.mesh = None;
        self.texture = None;
        self.wireframe = Lines::default();
        self.normals = Lines::default();
        self.elements = Lines::default();
        self.flaws = Lines::default();
        self.picked = None;
        self.drawn = None;
        self.mesh = Some(DepthMesh::new(&self.render_state.device, scene.mesh())?);
        Ok(())
    }

    /// Whether something new is ready to be drawn.
    fn prepare(
        &mut self,
        scene: &Arc<Scene>,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<bool, OverlayError> {
        let RenderState { device, queue, .. } = &self.render_state;
        let pipelines = self.overlay.lines();
        let mut is_new = false;
        if let Some(edges) = options.wireframe {
            let shared = Arc::clone(scene);
            let gather = move || wireframe::lines(shared.mesh(), edges);
            let upload =
                |lines: &[Line]| pipelines.upload(device, queue, lines, &options.wire_style());
            is_new |= self.wireframe.prepare(edges, ctx, gather, upload)?;
        }
        if let Some(shading) = options.normals {
            let shared = Arc::clone(scene);
            let gather = move || normals::lines(&shared, shading);
            let upload =
                |lines: &[Line]| pipelines.upload(device, queue, lines, &options.normal_style());
            is_new |= self.normals.prepare(shading, ctx, gather, upload)?;
        }
        if options.elements {
            let shared = Arc::clone(scene);
            let gather = move || marks::elements(&shared);
            let upload =
                |lines: &[Line]| pipelines.upload(device, queue, lines, &options.element_style());
            is_new |= self.elements.prepare((), ctx, gather, upload)?;
        }
        if let Some(triangle) = options.picked
            && self
                .picked
                .as_ref()
                .is_none_or(|(picked, _)| *picked != triangle)
        {
            let lines = wireframe::triangle_lines(scene.mesh(), triangle);
            let upload =
                |alpha| pipelines.upload(device, queue, &lines, &options.picked_style(alpha));
            let [faint, strong] = FAINT_AND_STRONG;
            self.picked = Some((triangle, [upload(faint)?, upload(strong)?]));
            is_new = true;
        }
        Ok(is_new)
    }

    fn prepare_flaws(
        &mut self,
        scene: &Arc<Scene>,
        health: &Arc<Health>,
        flaw: Flaw,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<bool, OverlayError> {
        let RenderState { device, queue, .. } = &self.render_state;
        let pipelines = self.overlay.lines();
        let (scene, health) = (Arc::clone(scene), Arc::clone(health));
        let gather = move || marks::flaws(&scene, &health, flaw);
        let upload = |lines: &[Line]| {
            let set = |alpha| pipelines.upload(device, queue, lines, &options.flaw_style(alpha));
            let [faint, strong] = FAINT_AND_STRONG;
            Ok([set(faint)?, set(strong)?])
        };
        self.flaws.prepare(flaw, ctx, gather, upload)
    }

    fn redraw(&mut self, view: &ViewUniform, options: &Options) {
        let RenderState { device, queue, .. } = &self.render_state;
        let mut sets: Vec<(&LineSet, LineOcclusion)> = Vec::new();
        if let (Some(_), Some((_, set))) = (options.wireframe, &self.wireframe.ready) {
            set.set_style(queue, &options.wire_style());
            sets.push((set, LineOcclusion::HiddenByMesh));
        }
        if let (Some(_), Some((_, set))) = (options.normals, &self.normals.ready) {
            set.set_style(queue, &options.normal_style());
            sets.push((set, LineOcclusion::HiddenByMesh));
        }
        if let (true, Some((_, set))) = (options.elements, &self.elements.ready) {
            set.set_style(queue, &options.element_style());
            sets.push((set, LineOcclusion::HiddenByMesh));
        }
        if let Some((flaw, flaws)) = &self.flaws.ready
            && options.flaw == Some(*flaw)
        {
            sets.extend(drawn_marks(flaws, queue, |alpha| options.flaw_style(alpha)));
        }
        if let (Some(_), Some((_, picked))) = (options.picked, &self.picked) {
            sets.extend(drawn_marks(picked, queue, |alpha| {
                options.picked_style(alpha)
            }));
        }
        let Some(mesh) = &self.mesh else { return };
        let texture = self.overlay.draw(device, queue, view, mesh, &sets);
        self.texture = Some(texture.clone());
    }
}

//! Drawing of the overlay: lines, hidden where a surface is in front of them.
//!
//! The overlay has its own colour and depth textures, so that the result doesn't depend on the window's. The depth of
//! the mesh and of other shapes is drawn first, then the lines. Depth is reversed (1 near, 0 far), which keeps
//! precision at a distance.

use super::depth::{DepthMesh, DepthPipeline};
use super::lines::{LineKind, LinePipelines, LineSet, LineStyle, StyleUniform};
use super::slices::{Pace, Slices, submit_and_wait};
use super::traced::{TracedGroup, TracedLayer, TracedPipelines};
use super::upload::allocated;
use super::view::{ViewBinding, ViewUniform};
use super::{COLOUR_FORMAT, DEPTH_FORMAT, GpuError, texture};
use glam::UVec2;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lines with one style.
#[derive(Clone)]
pub struct DrawnLines {
    /// The lines.
    pub lines: Arc<LineSet>,
    /// Their style.
    pub style: StyleUniform,
    /// Their kind.
    pub kind: LineKind,
}

/// The contents of an overlay.
#[derive(Clone)]
pub struct Drawing {
    /// The camera and the size.
    pub view: ViewUniform,
    /// The mesh that hides lines.
    pub mesh: Arc<DepthMesh>,
    /// The other shapes that hide lines.
    pub traced: Option<Arc<TracedLayer>>,
    /// The style of their outlines, if these are drawn.
    pub outline: Option<StyleUniform>,
    /// The lines; later sets are drawn over earlier ones.
    pub sets: Vec<DrawnLines>,
}

impl PartialEq for Drawing {
    fn eq(&self, other: &Self) -> bool {
        let is_same = |(a, b): (&DrawnLines, &DrawnLines)| {
            Arc::ptr_eq(&a.lines, &b.lines) && (a.style, a.kind) == (b.style, b.kind)
        };
        self.has_depth_of(other)
            && self.outline == other.outline
            && self.sets.len() == other.sets.len()
            && self.sets.iter().zip(&other.sets).all(is_same)
    }
}

impl Drawing {
    /// Whether both have the same depth.
    pub fn has_depth_of(&self, other: &Self) -> bool {
        let traced = |drawing: &Self| drawing.traced.as_ref().map(Arc::as_ptr);
        self.view == other.view
            && Arc::ptr_eq(&self.mesh, &other.mesh)
            && traced(self) == traced(other)
    }

    /// Whether most of its lines aren't in `other`.
    pub fn is_mostly_new_to(&self, other: &Self) -> bool {
        let is_old = |set: &DrawnLines| {
            let lines = other.sets.iter().map(|set| &set.lines);
            lines.clone().any(|lines| Arc::ptr_eq(lines, &set.lines))
        };
        let count = |sets: &mut dyn Iterator<Item = &DrawnLines>| -> u64 {
            sets.flat_map(|set| set.lines.buffers())
                .map(|(_, count)| u64::from(*count))
                .sum()
        };
        count(&mut self.sets.iter().filter(|set| !is_old(set))) > count(&mut other.sets.iter())
    }
}

/// A buffer of lines, and how it is drawn.
struct LinePart<'a> {
    pipeline: &'a wgpu::RenderPipeline,
    style: &'a LineStyle,
    buffer: &'a wgpu::Buffer,
    /// The number of its lines.
    count: u32,
}

/// Textures of the picture's size.
pub struct Targets {
    size: UVec2,
    /// One texture is shown while the other is drawn.
    colours: [wgpu::Texture; 2],
    depth: wgpu::Texture,
}

impl Targets {
    /// Creates the textures.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn new(device: &wgpu::Device, size: UVec2) -> Result<Self, GpuError> {
        use wgpu::TextureUsages as Usage;
        allocated(device, || {
            let usage = Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_SRC;
            let colour = |label| texture(device, label, size, COLOUR_FORMAT, usage);
            let usage = Usage::RENDER_ATTACHMENT;
            Self {
                size,
                colours: [colour("overlay colour 0"), colour("overlay colour 1")],
                depth: texture(device, "overlay depth", size, DEPTH_FORMAT, usage),
            }
        })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The texture with this number, 0 or 1.
    pub fn colour(&self, number: usize) -> &wgpu::Texture {
        &self.colours[number]
    }
}

/// The slice sizes of a drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Paces {
    /// Of the mesh's triangles.
    pub triangles: Pace,
    /// Of lines.
    pub lines: Pace,
}

impl Paces {
    /// Everything in one slice, without waiting for it.
    pub const UNLIMITED: Self = Self {
        triangles: Pace::UNLIMITED,
        lines: Pace::UNLIMITED,
    };
}

/// The render targets of a drawing.
#[derive(Clone)]
pub struct Canvas {
    /// The textures.
    pub targets: Arc<Targets>,
    /// Index of the colour texture.
    pub colour: usize,
    /// Whether the depth texture already holds the mesh's depth.
    pub has_depth: bool,
}

/// State of a drawing in progress, shared with other threads.
#[derive(Default)]
pub struct DrawingState {
    /// Ends the drawing after the slice that is being drawn.
    pub is_cancelled: AtomicBool,
    /// Whether the colour texture has been cleared and has some lines.
    pub has_lines: AtomicBool,
}

/// The pipelines of the overlay, which live as long as the device.
pub struct Overlay {
    device: wgpu::Device,
    queue: wgpu::Queue,
    view: ViewBinding,
    depth: DepthPipeline,
    lines: LinePipelines,
    traced: TracedPipelines,
}

impl Overlay {
    /// Compiles the shaders.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let view = ViewBinding::new(device);
        let formats = [COLOUR_FORMAT, DEPTH_FORMAT];
        let lines = LinePipelines::new(device, &view, formats);
        Self {
            depth: DepthPipeline::new(device, &view, DEPTH_FORMAT),
            traced: TracedPipelines::new(device, &view, &lines, formats),
            lines,
            view,
            device: device.clone(),
            queue: queue.clone(),
        }
    }

    /// The device and its queue.
    pub fn gpu(&self) -> (&wgpu::Device, &wgpu::Queue) {
        (&self.device, &self.queue)
    }

    /// Draws on a transparent background. Returns false if it was cancelled.
    ///
    /// Only one drawing may run at a time, as drawings share the view's buffer.
    pub fn draw(
        &self,
        drawing: &Drawing,
        canvas: &Canvas,
        paces: &mut Paces,
        state: &DrawingState,
        progress: impl Fn(),
    ) -> bool {
        self.view.upload(&self.queue, &drawing.view);
        if !canvas.has_depth && !self.draw_depth(drawing, canvas, &mut paces.triangles, state) {
            return false;
        }
        self.draw_lines(drawing, canvas, &mut paces.lines, state, progress)
    }

    fn draw_depth(
        &self,
        drawing: &Drawing,
        canvas: &Canvas,
        pace: &mut Pace,
        state: &DrawingState,
    ) -> bool {
        let mut slices = Slices::new(drawing.mesh.triangle_counts());
        let traced = self.traced_group(drawing);
        let mut load = wgpu::LoadOp::Clear(0.0);
        let depth = view_of(&canvas.targets.depth);
        loop {
            let slice = slices.take(pace.primitives());
            if slice.is_empty() && load == wgpu::LoadOp::Load {
                return true;
            }
            let mut encoder = self.encoder();
            {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("overlay depth"),
                    depth_stencil_attachment: Some(depth_attachment(&depth, load)),
                    ..Default::default()
                });
                pass.set_bind_group(0, self.view.group(), &[]);
                if let Some(group) = traced.as_ref().filter(|_| is_first(load)) {
                    self.traced.draw_depth(&mut pass, group);
                }
                let is_clipped = drawing.view.is_clipped();
                self.depth
                    .draw(&mut pass, &drawing.mesh, &slice, is_clipped);
            }
            self.submit(encoder, pace);
            load = wgpu::LoadOp::Load;
            if state.is_cancelled.load(Ordering::Relaxed) {
                return false;
            }
        }
    }

    fn draw_lines(
        &self,
        drawing: &Drawing,
        canvas: &Canvas,
        pace: &mut Pace,
        state: &DrawingState,
        progress: impl Fn(),
    ) -> bool {
        let styles = drawing
            .sets
            .iter()
            .map(|set| self.lines.style(&self.device, &set.style));
        let styles: Vec<LineStyle> = styles.collect();
        let parts = self.line_parts(drawing, &styles);
        let mut slices = Slices::new(parts.iter().map(|part| part.count).collect());
        let outline_style = drawing.outline.map(|s| self.lines.style(&self.device, &s));
        let outline = self.traced_group(drawing).zip(outline_style);
        let mut load = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let colour = view_of(canvas.targets.colour(canvas.colour));
        let depth = view_of(&canvas.targets.depth);
        loop {
            let slice = slices.take(pace.primitives());
            if slice.is_empty() && load == wgpu::LoadOp::Load {
                return true;
            }
            let mut encoder = self.encoder();
            {
                let attachments = [Some(colour_attachment(&colour, load))];
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("overlay lines"),
                    color_attachments: &attachments,
                    depth_stencil_attachment: Some(depth_attachment(&depth, wgpu::LoadOp::Load)),
                    ..Default::default()
                });
                pass.set_bind_group(0, self.view.group(), &[]);
                if let Some((group, style)) = outline.as_ref().filter(|_| is_first(load)) {
                    self.traced.draw_outline(&mut pass, group, style);
                }
                for (part, range) in slice {
                    let part = &parts[part];
                    LinePipelines::draw(&mut pass, part.pipeline, part.style, part.buffer, range);
                }
            }
            self.submit(encoder, pace);
            load = wgpu::LoadOp::Load;
            state.has_lines.store(true, Ordering::Relaxed);
            progress();
            if state.is_cancelled.load(Ordering::Relaxed) {
                return false;
            }
        }
    }

    /// The buffers of all sets of lines, in the order in which they are drawn; `styles` are those of the sets.
    fn line_parts<'a>(
        &'a self,
        drawing: &'a Drawing,
        styles: &'a [LineStyle],
    ) -> Vec<LinePart<'a>> {
        let is_clipped = drawing.view.is_clipped();
        let of_set = |(set, style): (&'a DrawnLines, &'a LineStyle)| {
            let is_cut = set.kind.is_cut && is_clipped;
            let kind = LineKind { is_cut, ..set.kind };
            let pipeline = self.lines.pipeline(&self.device, kind);
            let buffers = set.lines.buffers().iter();
            buffers.map(move |(buffer, count)| LinePart {
                pipeline,
                style,
                buffer,
                count: *count,
            })
        };
        drawing.sets.iter().zip(styles).flat_map(of_set).collect()
    }

    /// The traced pixels, bound.
    fn traced_group(&self, drawing: &Drawing) -> Option<TracedGroup> {
        let traced = drawing.traced.as_deref()?;
        Some(self.traced.group(&self.device, traced))
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("overlay"),
            })
    }

    fn submit(&self, encoder: wgpu::CommandEncoder, pace: &mut Pace) {
        if *pace == Pace::UNLIMITED {
            self.queue.submit([encoder.finish()]);
        } else {
            let commands = Some(encoder.finish());
            pace.adapt(submit_and_wait(&self.device, &self.queue, commands));
        }
    }
}

/// Whether a pass is the first of several.
fn is_first<T>(load: wgpu::LoadOp<T>) -> bool {
    matches!(load, wgpu::LoadOp::Clear(_))
}

fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn colour_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    }
}

fn depth_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

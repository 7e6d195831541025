//! Anti-aliased lines of constant width.

use super::upload::buffers;
use super::view::ViewBinding;
use super::{GpuError, shader, uniform_group, uniform_layout};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::ops::Range;
use std::sync::OnceLock;

/// Appended to [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/lines.wgsl");

/// A line in the mesh's space. Twin of `Line` in shaders/lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Line {
    /// Start point.
    pub start: Vec3,
    /// End point.
    pub end: Vec3,
    /// Vector to the expected place of the next line. Lines fade where its projection is short.
    pub gap: Vec3,
}

impl Line {
    /// A line without a gap, which doesn't fade.
    pub fn between(start: Vec3, end: Vec3) -> Self {
        Self {
            start,
            end,
            gap: Vec3::ZERO,
        }
    }

    /// Whether all its coordinates are finite.
    pub fn is_finite(&self) -> bool {
        self.start.is_finite() && self.end.is_finite() && self.gap.is_finite()
    }
}

/// The style of a set of lines. Twin of `Style` in shaders/lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StyleUniform {
    /// sRGB and alpha, from 0 to 1, not premultiplied.
    pub colour: [f32; 4],
    /// Half the width in pixels.
    pub half_width_px: f32,
    /// Factor of the line's length; the start stays in place.
    pub stretch: f32,
    padding: [f32; 2],
}

impl StyleUniform {
    /// A style with this colour, width and stretch.
    pub const fn new(colour: [f32; 4], half_width_px: f32, stretch: f32) -> Self {
        Self {
            colour,
            half_width_px,
            stretch,
            padding: [0.0; 2],
        }
    }

    /// Offsets of the members, for the test that compares them with WGSL's.
    #[cfg(test)]
    pub(super) const OFFSETS: [usize; 3] = [
        std::mem::offset_of!(Self, colour),
        std::mem::offset_of!(Self, half_width_px),
        std::mem::offset_of!(Self, stretch),
    ];
}

/// Whether surfaces hide lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineOcclusion {
    /// Lines behind a surface are hidden.
    Hidden,
    /// Lines behind a surface are visible.
    Through,
}

/// When lines fade. The discriminant is the shader's `FADE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fade {
    /// Never.
    Never,
    /// Where they are short or dense in the picture.
    ShortOrDense,
    /// Where they are dense: for lines that consist of short pieces.
    Dense,
    /// Where they are dense in any direction: for lines at points that are spread over a surface.
    Spread,
}

/// The properties by which lines share a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineKind {
    /// Whether surfaces hide the lines.
    pub occlusion: LineOcclusion,
    /// When the lines fade.
    pub fade: Fade,
    /// Whether the clip cuts the lines.
    pub is_cut: bool,
}

impl LineKind {
    /// The number of kinds: 2 occlusions, 4 fades, cut or not.
    const COUNT: usize = 16;

    fn index(self) -> usize {
        8 * self.occlusion as usize + 2 * self.fade as usize + usize::from(self.is_cut)
    }
}

/// Lines on the GPU.
pub struct LineSet(Vec<(wgpu::Buffer, u32)>);

impl LineSet {
    /// Uploads lines. Blocks.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the device allows no buffer for even one line.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lines: &[Line],
    ) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::VERTEX;
        Ok(Self(buffers(device, queue, "lines", lines, usage)?))
    }

    /// The buffers, each with its number of lines.
    pub(super) fn buffers(&self) -> &[(wgpu::Buffer, u32)] {
        &self.0
    }
}

/// A style on the GPU.
pub(super) struct LineStyle(wgpu::BindGroup);

impl LineStyle {
    /// The bind group.
    pub(super) fn group(&self) -> &wgpu::BindGroup {
        &self.0
    }
}

/// The pipelines that draw sets of lines.
pub struct LinePipelines {
    style_layout: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    formats: [wgpu::TextureFormat; 2],
    /// By [`LineKind::index`]; each is compiled when it is first drawn.
    pipelines: [OnceLock<wgpu::RenderPipeline>; LineKind::COUNT],
}

impl LinePipelines {
    pub(super) fn new(
        device: &wgpu::Device,
        view: &ViewBinding,
        formats: [wgpu::TextureFormat; 2],
    ) -> Self {
        let style_layout = uniform_layout(device, "line style");
        let module = shader(device, "lines", SHADER);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lines"),
            bind_group_layouts: &[Some(view.layout()), Some(&style_layout)],
            immediate_size: 0,
        });
        Self {
            style_layout,
            layout,
            module,
            formats,
            pipelines: [const { OnceLock::new() }; LineKind::COUNT],
        }
    }

    /// The pipeline of a kind. Compiles it unless that has been done.
    pub(super) fn pipeline(&self, device: &wgpu::Device, kind: LineKind) -> &wgpu::RenderPipeline {
        self.pipelines[kind.index()].get_or_init(|| self.compiled(device, kind))
    }

    fn compiled(&self, device: &wgpu::Device, kind: LineKind) -> wgpu::RenderPipeline {
        let [colour_format, depth_format] = self.formats;
        let depth_compare = match kind.occlusion {
            LineOcclusion::Hidden => wgpu::CompareFunction::GreaterEqual,
            LineOcclusion::Through => wgpu::CompareFunction::Always,
        };
        let constants = [
            ("FADE", f64::from(kind.fade as u8)),
            ("IS_CUT", f64::from(u8::from(kind.is_cut))),
        ];
        let options = || wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..wgpu::PipelineCompilationOptions::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lines"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("vs_main"),
                compilation_options: options(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Line>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &wgpu::vertex_attr_array![
                        0 => Float32x3, 1 => Float32x3, 2 => Float32x3
                    ],
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: depth_format,
                depth_write_enabled: Some(false),
                depth_compare: Some(depth_compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some("fs_main"),
                compilation_options: options(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: colour_format,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The layout of a style's bind group.
    pub(super) fn style_layout(&self) -> &wgpu::BindGroupLayout {
        &self.style_layout
    }

    /// Uploads a style.
    pub(super) fn style(&self, device: &wgpu::Device, style: &StyleUniform) -> LineStyle {
        use wgpu::util::DeviceExt as _;
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("line style"),
            contents: bytemuck::bytes_of(style),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        LineStyle(uniform_group(
            device,
            "line style",
            &self.style_layout,
            &buffer,
        ))
    }

    /// Draws a range of a buffer's lines.
    pub(super) fn draw(
        pass: &mut wgpu::RenderPass<'_>,
        pipeline: &wgpu::RenderPipeline,
        style: &LineStyle,
        buffer: &wgpu::Buffer,
        lines: Range<u32>,
    ) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &style.0, &[]);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6, lines);
    }
}

//! Anti-aliased lines of constant width.

use super::upload::buffers;
use super::view::ViewBinding;
use super::{GpuError, shader, uniform_group, uniform_layout};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::ops::Range;

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
    /// 1 if lines fade where they are short or dense, 2 if only where they are dense, 3 if where they are dense in any
    /// direction, else 0.
    pub fade: f32,
    /// 1 if the clip cuts lines, else 0.
    pub is_cut: f32,
}

impl StyleUniform {
    /// Offsets of the members, for the test that compares them with WGSL's.
    #[cfg(test)]
    pub(super) const OFFSETS: [usize; 5] = [
        std::mem::offset_of!(Self, colour),
        std::mem::offset_of!(Self, half_width_px),
        std::mem::offset_of!(Self, stretch),
        std::mem::offset_of!(Self, fade),
        std::mem::offset_of!(Self, is_cut),
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
    hidden: wgpu::RenderPipeline,
    through: wgpu::RenderPipeline,
}

impl LinePipelines {
    pub(super) fn new(
        device: &wgpu::Device,
        view: &ViewBinding,
        colour_format: wgpu::TextureFormat,
        depth_format: wgpu::TextureFormat,
    ) -> Self {
        let style_layout = uniform_layout(device, "line style");
        let module = shader(device, "lines", SHADER);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lines"),
            bind_group_layouts: &[Some(view.layout()), Some(&style_layout)],
            immediate_size: 0,
        });
        let pipeline = |label, depth_compare| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs_main"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
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
                    module: &module,
                    entry_point: Some("fs_main"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: colour_format,
                        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self {
            hidden: pipeline("lines", wgpu::CompareFunction::GreaterEqual),
            through: pipeline("lines through", wgpu::CompareFunction::Always),
            style_layout,
        }
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
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        occlusion: LineOcclusion,
        style: &LineStyle,
        buffer: &wgpu::Buffer,
        lines: Range<u32>,
    ) {
        pass.set_pipeline(match occlusion {
            LineOcclusion::Hidden => &self.hidden,
            LineOcclusion::Through => &self.through,
        });
        pass.set_bind_group(1, &style.0, &[]);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6, lines);
    }
}

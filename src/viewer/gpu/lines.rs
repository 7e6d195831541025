//! Anti-aliased lines of constant width.

use super::upload::buffers;
use super::view::ViewBinding;
use super::{GpuError, shader, uniform_group, uniform_layout};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::ops::Range;

/// Comes behind [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/lines.wgsl");

/// A line of the mesh's space. Twin of `Line` in shaders/lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Line {
    /// Where it starts.
    pub start: Vec3,
    /// Where it ends.
    pub end: Vec3,
    /// From it to where the next one is to be expected; lines fade by how long that looks.
    pub gap: Vec3,
}

/// How a set of lines looks. Twin of `Style` in shaders/lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StyleUniform {
    /// sRGB and alpha, from 0 to 1, alpha not multiplied in.
    pub colour: [f32; 4],
    /// Half the width in pixels.
    pub half_width_px: f32,
    /// The end is moved to this many times its distance from the start.
    pub stretch: f32,
    /// 1: lines fade where they are dense; 0: they don't.
    pub fade: f32,
    /// Rounds the size up to what WGSL demands.
    pub padding: f32,
}

impl StyleUniform {
    /// Where its members lie, for the test that compares them with WGSL's.
    #[cfg(test)]
    pub(super) const OFFSETS: [usize; 4] = [
        std::mem::offset_of!(Self, colour),
        std::mem::offset_of!(Self, half_width_px),
        std::mem::offset_of!(Self, stretch),
        std::mem::offset_of!(Self, fade),
    ];
}

/// Whether the mesh hides lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineOcclusion {
    /// Lines behind the mesh don't show.
    HiddenByMesh,
    /// They do.
    ThroughMesh,
}

/// Lines on the GPU.
pub struct LineSet(Vec<(wgpu::Buffer, u32)>);

impl LineSet {
    /// Uploads lines. For a thread that may wait.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the device grants no buffer for even one line.
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

/// A look of lines on the GPU.
pub(super) struct LineStyle(wgpu::BindGroup);

/// Draws sets of lines.
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

    /// Uploads a look.
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
            LineOcclusion::HiddenByMesh => &self.hidden,
            LineOcclusion::ThroughMesh => &self.through,
        });
        pass.set_bind_group(1, &style.0, &[]);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6, lines);
    }
}

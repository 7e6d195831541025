//! Anti-aliased lines of constant width.

use super::view::ViewBinding;
use super::{GpuError, buffer, shader, uniform_group, uniform_layout};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

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

/// Lines of one look on the GPU.
pub struct LineSet {
    style: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Buffers no larger than the device grants, each with its number of lines.
    chunks: Vec<(wgpu::Buffer, u32)>,
}

impl LineSet {
    /// Changes the look for what is submitted next.
    pub fn set_style(&self, queue: &wgpu::Queue, style: &StyleUniform) {
        queue.write_buffer(&self.style, 0, bytemuck::bytes_of(style));
    }
}

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

    /// Uploads lines, in as many buffers as the device needs.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if it grants none for even one line.
    pub fn upload(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lines: &[Line],
        style: &StyleUniform,
    ) -> Result<LineSet, GpuError> {
        let per_buffer = device.limits().max_buffer_size as usize / size_of::<Line>();
        let upload = |chunk: &[Line]| {
            let contents = bytemuck::cast_slice(chunk);
            let buffer = buffer(device, "lines", contents, wgpu::BufferUsages::VERTEX)?;
            Ok((buffer, chunk.len() as u32))
        };
        let chunks = lines.chunks(per_buffer.max(1)).map(upload);
        let size = size_of::<StyleUniform>();
        let (style_buffer, group) = uniform_group(device, "line style", &self.style_layout, size);
        let set = LineSet {
            style: style_buffer,
            group,
            chunks: chunks.collect::<Result<_, GpuError>>()?,
        };
        set.set_style(queue, style);
        Ok(set)
    }

    pub(super) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        set: &LineSet,
        visibility: LineOcclusion,
    ) {
        pass.set_pipeline(match visibility {
            LineOcclusion::HiddenByMesh => &self.hidden,
            LineOcclusion::ThroughMesh => &self.through,
        });
        pass.set_bind_group(1, &set.group, &[]);
        for (buffer, count) in &set.chunks {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..6, 0..*count);
        }
    }
}

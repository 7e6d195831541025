//! The depth pass of the mesh, which hides the lines behind it.

use super::upload::{buffer, buffers};
use super::view::ViewBinding;
use super::{GpuError, shader};
use hitscope_core::TriangleMesh;
use std::ops::Range;

/// Appended to [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/depth.wgsl");

/// Triangles are pushed back by this many times their slope, in depth per pixel, so that a surface doesn't hide
/// the lines on it: half a line's width, half a pixel of soft edge, and a margin for the picked triangle's wider
/// outline.
const SLOPE_BIAS: f32 = -2.5;
/// Triangles are also pushed back by this many of the smallest steps of depth.
const CONSTANT_BIAS: i32 = -16;

/// The vertices and indices of a mesh on the GPU.
pub struct DepthMesh {
    positions: wgpu::Buffer,
    /// Buffers of three indices per triangle, each with its number of triangles.
    triangles: Vec<(wgpu::Buffer, u32)>,
}

impl DepthMesh {
    /// Uploads a mesh. Blocks.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mesh: &TriangleMesh,
    ) -> Result<Self, GpuError> {
        use wgpu::BufferUsages as Usage;
        let positions = bytemuck::cast_slice(mesh.positions());
        Ok(Self {
            positions: buffer(device, queue, "positions", positions, Usage::VERTEX)?,
            triangles: buffers(device, queue, "indices", mesh.triangles(), Usage::INDEX)?,
        })
    }

    /// The number of triangles in each buffer.
    pub(super) fn triangle_counts(&self) -> Vec<u32> {
        self.triangles.iter().map(|(_, count)| *count).collect()
    }
}

/// The pipeline that draws depth and no colour.
pub struct DepthPipeline(wgpu::RenderPipeline);

impl DepthPipeline {
    pub(super) fn new(
        device: &wgpu::Device,
        view: &ViewBinding,
        format: wgpu::TextureFormat,
    ) -> Self {
        let module = shader(device, "depth", SHADER);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("depth"),
            bind_group_layouts: &[Some(view.layout())],
            immediate_size: 0,
        });
        let descriptor = wgpu::RenderPipelineDescriptor {
            label: Some("depth"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<[f32; 3]>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState {
                    constant: CONSTANT_BIAS,
                    slope_scale: SLOPE_BIAS,
                    clamp: 0.0,
                },
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        };
        Self(device.create_render_pipeline(&descriptor))
    }

    /// Draws these ranges of the mesh's buffers.
    pub(super) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &DepthMesh,
        ranges: &[(usize, Range<u32>)],
    ) {
        pass.set_pipeline(&self.0);
        for (part, triangles) in ranges {
            let (indices, _) = &mesh.triangles[*part];
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(3 * triangles.start..3 * triangles.end, 0, 0..1);
        }
    }
}

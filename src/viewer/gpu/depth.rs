//! The mesh's depth, which hides lines behind it.

use super::view::ViewBinding;
use super::{GpuError, buffer, shader};
use hitscope_core::TriangleMesh;

/// Comes behind [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/depth.wgsl");

/// Triangles are pushed back by this many times their slope, in depth a pixel, so that a line on a
/// surface isn't hidden by it: half a line's width, and the half pixel of its soft edge, and some
/// for the picked triangle's wider outline.
const SLOPE_BIAS: f32 = -2.5;
/// And by this many of the smallest steps of depth.
const CONSTANT_BIAS: i32 = -16;

/// The vertices and indices of a mesh on the GPU.
pub struct DepthMesh {
    positions: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

impl DepthMesh {
    /// Uploads a mesh.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn new(device: &wgpu::Device, mesh: &TriangleMesh) -> Result<Self, GpuError> {
        let positions = bytemuck::cast_slice(&mesh.positions);
        let indices = bytemuck::cast_slice(&mesh.triangles);
        Ok(Self {
            positions: buffer(device, "positions", positions, wgpu::BufferUsages::VERTEX)?,
            indices: buffer(device, "indices", indices, wgpu::BufferUsages::INDEX)?,
            index_count: 3 * mesh.triangles.len() as u32,
        })
    }
}

/// Draws depth and no colour.
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

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, mesh: &DepthMesh) {
        pass.set_pipeline(&self.0);
        pass.set_vertex_buffer(0, mesh.positions.slice(..));
        pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..mesh.index_count, 0, 0..1);
    }
}

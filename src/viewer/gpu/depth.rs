//! The depth pass of the mesh, which hides the lines behind it.

use super::upload::{buffer, buffers};
use super::view::ViewBinding;
use super::{GpuError, shader};
use hitscope_core::Scene;
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
    /// Uploads the triangles of a scene that are shown. Blocks.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        use wgpu::BufferUsages as Usage;
        let mesh = scene.mesh();
        let shown = scene.shown().map(|shown| {
            let triangles = mesh.triangles().iter().zip(&**shown);
            let shown = triangles.filter(|(_, is_shown)| **is_shown);
            shown.map(|(corners, _)| *corners).collect::<Vec<_>>()
        });
        let triangles = shown.as_deref().unwrap_or(mesh.triangles());
        let positions = bytemuck::cast_slice(mesh.positions());
        Ok(Self {
            positions: buffer(device, queue, "positions", positions, Usage::VERTEX)?,
            triangles: buffers(device, queue, "indices", triangles, Usage::INDEX)?,
        })
    }

    /// The number of triangles in each buffer.
    pub(super) fn triangle_counts(&self) -> Vec<u32> {
        self.triangles.iter().map(|(_, count)| *count).collect()
    }
}

/// The pipelines that draw depth and no colour.
pub struct DepthPipeline {
    whole: wgpu::RenderPipeline,
    /// Discards what the clip removes. Slower, as each pixel runs a shader.
    clipped: wgpu::RenderPipeline,
}

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
        let pipeline = |label, vertex, fragment: Option<&str>| {
            let stages = [Some(vertex), fragment];
            depth_pipeline(device, label, (&module, &layout), stages, format)
        };
        Self {
            whole: pipeline("depth", "vs_main", None),
            clipped: pipeline("clipped depth", "vs_clipped", Some("fs_clipped")),
        }
    }

    /// Draws these ranges of the mesh's buffers.
    pub(super) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &DepthMesh,
        ranges: &[(usize, Range<u32>)],
        is_clipped: bool,
    ) {
        pass.set_pipeline(if is_clipped {
            &self.clipped
        } else {
            &self.whole
        });
        for (part, triangles) in ranges {
            let (indices, _) = &mesh.triangles[*part];
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(3 * triangles.start..3 * triangles.end, 0, 0..1);
        }
    }
}

/// A pipeline with the shader's entry points of these names.
fn depth_pipeline(
    device: &wgpu::Device,
    label: &str,
    (module, layout): (&wgpu::ShaderModule, &wgpu::PipelineLayout),
    [vertex, fragment]: [Option<&str>; 2],
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let options = wgpu::PipelineCompilationOptions::default;
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: vertex,
            compilation_options: options(),
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
        fragment: fragment.map(|fragment| wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: options(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

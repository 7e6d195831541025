//! The depth pass of the mesh, which hides the lines behind it.

use super::upload::{buffer, buffers, items_per_buffer};
use super::view::ViewBinding;
use super::{GpuError, shader};
use glam::Vec3;
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

/// The triangles of a mesh on the GPU, in parts within the device's limit on buffers.
pub struct DepthMesh(Vec<Part>);

/// A buffer of indices with the positions that it refers to. Parts may share the positions.
struct Part {
    positions: wgpu::Buffer,
    indices: wgpu::Buffer,
    triangle_count: u32,
}

impl DepthMesh {
    /// Uploads the triangles of a scene that are shown. Blocks.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the device's buffers can't hold even one triangle; [`GpuError::OutOfMemory`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        let mesh = scene.mesh();
        let shown = scene.shown().map(|shown| {
            let triangles = mesh.triangles().iter().zip(&**shown);
            let shown = triangles.filter(|(_, is_shown)| **is_shown);
            shown.map(|(corners, _)| *corners).collect::<Vec<_>>()
        });
        let triangles = shown.as_deref().unwrap_or(mesh.triangles());
        let most = items_per_buffer::<Vec3>(device);
        let mut parts = Vec::new();
        if mesh.positions().len() <= most {
            upload(device, queue, mesh.positions(), triangles, &mut parts)?;
        } else {
            let mut result = Ok(());
            split(mesh.positions(), triangles, most, |positions, triangles| {
                if result.is_ok() {
                    result = upload(device, queue, positions, triangles, &mut parts);
                }
            });
            result?;
        }
        Ok(Self(parts))
    }

    /// The number of triangles in each part.
    pub(super) fn triangle_counts(&self) -> Vec<u32> {
        self.0.iter().map(|part| part.triangle_count).collect()
    }
}

/// Uploads triangles and the positions that they refer to.
fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    parts: &mut Vec<Part>,
) -> Result<(), GpuError> {
    use wgpu::BufferUsages as Usage;
    let positions = bytemuck::cast_slice(positions);
    let positions = buffer(device, queue, "positions", positions, Usage::VERTEX)?;
    let indices = buffers(device, queue, "indices", triangles, Usage::INDEX)?;
    parts.extend(indices.into_iter().map(|(indices, triangle_count)| Part {
        positions: positions.clone(),
        indices,
        triangle_count,
    }));
    Ok(())
}

/// Splits triangles into parts of at most `most` positions each, but at least three. Passes each part on with its positions
/// and with indices into them.
fn split(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    most: usize,
    mut part: impl FnMut(&[Vec3], &[[u32; 3]]),
) {
    const NONE: u32 = u32::MAX;
    // The index in the part of each vertex.
    let mut places = vec![NONE; positions.len()];
    let (mut vertices, mut indices): (Vec<u32>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    let mut flush = |vertices: &mut Vec<u32>, indices: &mut Vec<[u32; 3]>, places: &mut [u32]| {
        let own = vertices.iter().map(|&vertex| positions[vertex as usize]);
        part(&own.collect::<Vec<_>>(), indices);
        vertices
            .iter()
            .for_each(|&vertex| places[vertex as usize] = NONE);
        vertices.clear();
        indices.clear();
    };
    for corners in triangles {
        let is_new = |corner: &&u32| places[**corner as usize] == NONE;
        if !indices.is_empty() && vertices.len() + corners.iter().filter(is_new).count() > most {
            flush(&mut vertices, &mut indices, &mut places);
        }
        indices.push(corners.map(|corner| {
            let place = &mut places[corner as usize];
            if *place == NONE {
                *place = vertices.len() as u32;
                vertices.push(corner);
            }
            *place
        }));
    }
    if !indices.is_empty() {
        flush(&mut vertices, &mut indices, &mut places);
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
            let part = &mesh.0[*part];
            pass.set_vertex_buffer(0, part.positions.slice(..));
            pass.set_index_buffer(part.indices.slice(..), wgpu::IndexFormat::Uint32);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_the_triangles_in_order_and_no_more_positions_than_allowed() {
        let positions: Vec<Vec3> = (0..9).map(|k| Vec3::splat(k as f32)).collect();
        let triangles = [[0, 1, 2], [2, 1, 3], [8, 7, 6], [0, 8, 2], [4, 5, 3]];
        for most in [1, 3, 4, 5, 9] {
            let (mut seen, mut parts) = (Vec::new(), 0);
            split(&positions, &triangles, most, |own, indices| {
                assert!(own.len() <= most.max(3), "{most}");
                let corners = indices
                    .iter()
                    .map(|corners| corners.map(|k| own[k as usize].x as u32));
                seen.extend(corners);
                parts += 1;
            });
            assert_eq!(seen, triangles, "{most}");
            assert_eq!(parts == 1, most == 9, "{most}");
        }
    }
}

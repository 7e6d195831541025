//! The rasterizer: finds the triangle visible at each pixel's centre by drawing all triangles with a depth buffer.
//!
//! A pixel holds the triangle and the barycentric coordinates that the GPU interpolates, so that the views' own code can
//! shade it.

use super::slices::{Pace, Slices, submit_and_wait};
use super::upload::buffers;
use super::view::{ViewBinding, ViewUniform};
use super::{DEPTH_FORMAT, GpuError, shader, texture};
use crate::offscreen::read_back_words;
use bytemuck::{Pod, Zeroable};
use hitscope_core::Scene;
use std::ops::Range;

/// Appended to [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/rasterized.wgsl");

/// The format of pixels: four 32-bit words.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
const WORDS: u32 = 4;

/// The triangle visible at a pixel's centre. Twin of the output of `fs_main` in shaders/rasterized.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RasterPixel {
    /// The triangle, counted from 1; 0 for none.
    pub triangle: u32,
    /// Barycentric coordinate of the triangle's second vertex.
    pub u: f32,
    /// Barycentric coordinate of the triangle's third vertex.
    pub v: f32,
    padding: u32,
}

/// Twin of the input of `vs_main` in shaders/rasterized.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    triangle: u32,
}

/// The triangles of a scene on the GPU.
pub struct RasterMesh {
    /// Buffers of three vertices per triangle, each with its number of triangles.
    triangles: Vec<(wgpu::Buffer, u32)>,
}

/// The pipeline.
pub struct Rasterizer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    view: ViewBinding,
    pipeline: wgpu::RenderPipeline,
}

impl Rasterizer {
    /// Compiles the shader.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let view = ViewBinding::new(device);
        Self {
            pipeline: pipeline(device, &view),
            view,
            device: device.clone(),
            queue: queue.clone(),
        }
    }

    /// Uploads the triangles of a scene that are shown. Blocks.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn upload(&self, scene: &Scene) -> Result<RasterMesh, GpuError> {
        let mesh = scene.mesh();
        let shown = (0..mesh.triangles().len() as u32).filter(|&k| scene.is_shown(k));
        let triangle = |k: u32| {
            mesh.corners(k).map(|position| Vertex {
                position: position.to_array(),
                triangle: k + 1,
            })
        };
        let triangles: Vec<[Vertex; 3]> = shown.map(triangle).collect();
        let (device, queue) = (&self.device, &self.queue);
        let usage = wgpu::BufferUsages::VERTEX;
        Ok(RasterMesh {
            triangles: buffers(device, queue, "rasterized triangles", &triangles, usage)?,
        })
    }

    /// Draws the triangles. Returns the pixels, row by row from the top. Blocks; only one drawing may run at a time.
    ///
    /// # Errors
    /// See [`GpuError`].
    pub fn draw(
        &self,
        mesh: &RasterMesh,
        view: &ViewUniform,
    ) -> Result<Vec<RasterPixel>, GpuError> {
        use wgpu::TextureUsages as Usage;
        let size = view.size();
        let needed = size_of::<RasterPixel>() as u64 * u64::from(size.x) * u64::from(size.y);
        let granted = self.device.limits().max_buffer_size;
        if needed > granted {
            return Err(GpuError::TooLarge { needed, granted });
        }
        self.view.upload(&self.queue, view);
        let target = |label, format, usage| {
            let usage = usage | Usage::RENDER_ATTACHMENT;
            let texture = texture(&self.device, label, size, format, usage);
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            (texture, view)
        };
        let (pixels, pixels_view) = target("rasterized", FORMAT, Usage::COPY_SRC);
        let (_, depth) = target("rasterized depth", DEPTH_FORMAT, Usage::empty());
        let counts = mesh.triangles.iter().map(|(_, count)| *count);
        let mut slices = Slices::new(counts.collect());
        let mut pace = Pace::default();
        let mut is_first = true;
        loop {
            let slice = slices.take(pace.primitives());
            if slice.is_empty() && !is_first {
                break;
            }
            let commands = self.commands(mesh, &slice, [&pixels_view, &depth], is_first);
            pace.adapt(submit_and_wait(&self.device, &self.queue, Some(commands)));
            is_first = false;
        }
        let words = read_back_words(&self.device, &self.queue, &pixels, WORDS)?;
        let words = words.as_flattened();
        let pixels = words.as_chunks::<{ size_of::<RasterPixel>() }>().0.iter();
        Ok(pixels
            .map(|pixel| bytemuck::pod_read_unaligned(pixel))
            .collect())
    }

    /// The commands that draw ranges of the mesh's buffers. Before the first ranges, they clear the targets.
    fn commands(
        &self,
        mesh: &RasterMesh,
        slice: &[(usize, Range<u32>)],
        [pixels, depth]: [&wgpu::TextureView; 2],
        is_first: bool,
    ) -> wgpu::CommandBuffer {
        let label = wgpu::CommandEncoderDescriptor {
            label: Some("rasterized"),
        };
        let mut encoder = self.device.create_command_encoder(&label);
        {
            let (colour_load, depth_load) = if is_first {
                let nothing = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
                (nothing, wgpu::LoadOp::Clear(0.0))
            } else {
                (wgpu::LoadOp::Load, wgpu::LoadOp::Load)
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("rasterized"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: pixels,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: colour_load,
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: depth,
                    depth_ops: Some(wgpu::Operations {
                        load: depth_load,
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, self.view.group(), &[]);
            for (part, triangles) in slice {
                pass.set_vertex_buffer(0, mesh.triangles[*part].0.slice(..));
                pass.draw(3 * triangles.start..3 * triangles.end, 0..1);
            }
        }
        encoder.finish()
    }
}

fn pipeline(device: &wgpu::Device, view: &ViewBinding) -> wgpu::RenderPipeline {
    let module = shader(device, "rasterized", SHADER);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("rasterized"),
        bind_group_layouts: &[Some(view.layout())],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("rasterized"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! Depth and outlines of shapes that aren't meshes, from one traced ray per pixel.

use super::lines::{LinePipelines, LineStyle};
use super::upload::allocated;
use super::view::ViewBinding;
use super::{GpuError, extent, shader, texture};
use glam::UVec2;

/// Appended to [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/traced.wgsl");

/// What one pixel's ray hits, as reversed depths.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TracedPixel {
    /// Lines behind this depth are hidden; 0 hides none.
    pub hides: f32,
    /// The depth of an outline, or −1.
    pub outline: f32,
}

/// The traced pixels on the GPU.
pub struct TracedLayer(wgpu::Texture);

impl TracedLayer {
    /// Uploads pixels, row by row from the top left; as many as the size says.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        size: UVec2,
        pixels: &[TracedPixel],
    ) -> Result<Self, GpuError> {
        use wgpu::TextureUsages as Usage;
        let usage = Usage::TEXTURE_BINDING | Usage::COPY_DST;
        let format = wgpu::TextureFormat::Rg32Float;
        let texture = allocated(device, || texture(device, "traced", size, format, usage))?;
        queue.write_texture(
            texture.as_image_copy(),
            bytemuck::cast_slice(pixels),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(size.x * size_of::<TracedPixel>() as u32),
                rows_per_image: None,
            },
            extent(size),
        );
        Ok(Self(texture))
    }
}

/// The pipelines that draw depth and outlines.
pub(super) struct TracedPipelines {
    layout: wgpu::BindGroupLayout,
    depth: wgpu::RenderPipeline,
    outline: wgpu::RenderPipeline,
}

/// The traced pixels, bound to the pipelines.
pub(super) struct TracedGroup(wgpu::BindGroup);

impl TracedPipelines {
    pub fn new(
        device: &wgpu::Device,
        view: &ViewBinding,
        lines: &LinePipelines,
        [colour_format, depth_format]: [wgpu::TextureFormat; 2],
    ) -> Self {
        let layout = pixels_layout(device);
        let (view, pixels) = (Some(view.layout()), Some(&layout));
        let colour = wgpu::ColorTargetState {
            format: colour_format,
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        };
        let module = shader(device, "traced", SHADER);
        let pipeline = |entry_point, groups: &[_], targets: &[_]| {
            pipeline(device, &module, entry_point, groups, targets, depth_format)
        };
        Self {
            depth: pipeline("fs_depth", &[view, pixels], &[]),
            outline: pipeline(
                "fs_outline",
                &[view, pixels, Some(lines.style_layout())],
                &[Some(colour)],
            ),
            layout,
        }
    }

    pub fn group(&self, device: &wgpu::Device, layer: &TracedLayer) -> TracedGroup {
        let view = layer.0.create_view(&wgpu::TextureViewDescriptor::default());
        TracedGroup(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("traced"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        }))
    }

    /// Draws the depth.
    pub fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>, group: &TracedGroup) {
        pass.set_pipeline(&self.depth);
        pass.set_bind_group(1, &group.0, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Draws the outlines.
    pub fn draw_outline(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        group: &TracedGroup,
        style: &LineStyle,
    ) {
        pass.set_pipeline(&self.outline);
        pass.set_bind_group(1, &group.0, &[]);
        pass.set_bind_group(2, style.group(), &[]);
        pass.draw(0..3, 0..1);
    }
}

/// The layout of the traced pixels' bind group.
fn pixels_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("traced"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        }],
    })
}

/// The pipeline of a fragment shader that sets the depth of each pixel. Depth is stored if there is no colour target.
fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    groups: &[Option<&wgpu::BindGroupLayout>],
    targets: &[Option<wgpu::ColorTargetState>],
    depth_format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry_point),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry_point),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth_format,
            depth_write_enabled: Some(targets.is_empty()),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

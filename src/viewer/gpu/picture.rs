//! Drawing of the traced picture and the overlay on the screen.
//!
//! Uses a separate pipeline instead of egui's, whose shader takes a software rasterizer more time than the rays
//! take: while the camera moved, a frame took 156 ms with egui's pipeline and 97 ms with this one (bunny,
//! 1280 × 800, 2 cores, lavapipe, 2026-11).

use super::upload::allocated;
use super::{GpuError, extent, texture};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState};
use egui::{PaintCallbackInfo, Rect, Shape};
use glam::UVec2;
use hitscope_core::plan::PixelRect;

/// A complete shader, without [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/picture.wgsl");

/// sRGB-encoded bytes without decoding, as in the film and in egui's target.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Written by the CPU, read by the shader.
const USAGE: wgpu::TextureUsages =
    wgpu::TextureUsages::TEXTURE_BINDING.union(wgpu::TextureUsages::COPY_DST);

/// A texture that holds the picture, and the pipeline that shows it.
pub struct Picture {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// The pipelines without and with an overlay.
    pipelines: [wgpu::RenderPipeline; 2],
    layout: wgpu::BindGroupLayout,
    /// A placeholder texture if there is no overlay.
    nothing: wgpu::Texture,
    /// The part that is drawn: `part` in picture.wgsl.
    part: wgpu::Buffer,
    picture: Option<wgpu::Texture>,
    /// The bind group of the picture and this overlay.
    bound: Option<(wgpu::Texture, wgpu::BindGroup)>,
}

impl Picture {
    /// Compiles the shader for the window's format.
    pub fn new(render_state: &RenderState) -> Self {
        let device = render_state.device.clone();
        let layout = layout(&device);
        Self {
            pipelines: [Layers::Picture, Layers::PictureAndOverlay]
                .map(|layers| pipeline(&device, &layout, render_state.target_format, layers)),
            // One transparent pixel: wgpu clears textures that are never written.
            nothing: texture(&device, "nothing", UVec2::ONE, FORMAT, USAGE),
            part: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("part of the picture"),
                size: size_of::<[f32; 4]>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            queue: render_state.queue.clone(),
            layout,
            picture: None,
            bound: None,
            device,
        }
    }

    /// Uploads the changed pixels, or all pixels if the size changed. Pixels are sRGB with alpha 255, row by row from the
    /// top; as many as the size says.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`]; there is no picture then.
    pub fn upload(
        &mut self,
        size: UVec2,
        pixels: &[[u8; 4]],
        changed: PixelRect,
    ) -> Result<(), GpuError> {
        let is_same_size =
            |texture: &wgpu::Texture| UVec2::new(texture.width(), texture.height()) == size;
        let mut rect = changed;
        let texture = match self.picture.take().filter(is_same_size) {
            Some(texture) => texture,
            None => {
                rect = PixelRect {
                    min: UVec2::ZERO,
                    max: size,
                };
                self.bound = None;
                let make = || texture(&self.device, "picture", size, FORMAT, USAGE);
                allocated(&self.device, make)?
            }
        };
        let first = (rect.min.y * size.x + rect.min.x) as usize;
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: 0,
                origin: wgpu::Origin3d {
                    x: rect.min.x,
                    y: rect.min.y,
                    z: 0,
                },
                aspect: wgpu::TextureAspect::All,
            },
            pixels[first..].as_flattened(),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * size.x),
                rows_per_image: None,
            },
            extent(rect.max - rect.min),
        );
        self.picture = Some(texture);
        Ok(())
    }

    /// A shape that draws a part of the picture and of an overlay of its size into `rect`; `None` before the first upload.
    /// The part is in the unit square, and the same for all shapes of a frame.
    pub fn shape(
        &mut self,
        rect: Rect,
        part: Rect,
        overlay: Option<&wgpu::Texture>,
    ) -> Option<Shape> {
        let picture = self.picture.as_ref()?;
        let values = [part.min.x, part.min.y, part.width(), part.height()];
        self.queue
            .write_buffer(&self.part, 0, bytemuck::bytes_of(&values));
        let pipeline = &self.pipelines[usize::from(overlay.is_some())];
        let overlay = overlay.unwrap_or(&self.nothing);
        if self
            .bound
            .as_ref()
            .is_none_or(|(bound, _)| bound != overlay)
        {
            let group = bind(&self.device, &self.layout, [picture, overlay], &self.part);
            self.bound = Some((overlay.clone(), group));
        }
        let (_, group) = self.bound.as_ref()?;
        let draw = Draw {
            pipeline: pipeline.clone(),
            group: group.clone(),
        };
        Some(Shape::Callback(Callback::new_paint_callback(rect, draw)))
    }
}

/// The layers that a pipeline draws. The discriminant is the shader's `HAS_OVERLAY`.
#[derive(Clone, Copy)]
enum Layers {
    Picture = 0,
    PictureAndOverlay = 1,
}

/// The GPU resources of a frame.
struct Draw {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl CallbackTrait for Draw {
    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    let part = wgpu::BindGroupLayoutEntry {
        binding: 2,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("picture"),
        entries: &[entry(0), entry(1), part],
    })
}

fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    textures: [&wgpu::Texture; 2],
    part: &wgpu::Buffer,
) -> wgpu::BindGroup {
    let views =
        textures.map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
    let entry = |binding: usize| wgpu::BindGroupEntry {
        binding: binding as u32,
        resource: wgpu::BindingResource::TextureView(&views[binding]),
    };
    let part = wgpu::BindGroupEntry {
        binding: 2,
        resource: part.as_entire_binding(),
    };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("picture"),
        layout,
        entries: &[entry(0), entry(1), part],
    })
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
    layers: Layers,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("picture"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("picture"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("picture"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("HAS_OVERLAY", f64::from(layers as u8))],
                ..wgpu::PipelineCompilationOptions::default()
            },
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! Drawing of the traced picture and the overlay on the screen.
//!
//! Uses a separate pipeline instead of egui's, whose shader takes a software rasterizer more time than the rays
//! take: while the camera moved, a frame took 156 ms with egui's pipeline and 97 ms with a first version of this one
//! (bunny, 1280 × 800, 2 cores, lavapipe, 2026-11). Coarse pictures, which replace each other while the camera moves, are
//! uploaded with one texel per block of pixels.

use super::upload::allocated;
use super::{GpuError, extent, texture};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState};
use egui::{PaintCallbackInfo, Rect, Shape};
use glam::UVec2;
use hitscope_core::plan::PixelRect;

/// A complete shader, without [`view::SHADER`](super::view::SHADER).
pub const SHADER: &str = include_str!("../../../shaders/picture.wgsl");

/// sRGB-encoded bytes without decoding, as in the film and in egui's target. In this order, Mesa's software rasterizer
/// copies them in half the time (1280 × 740, Mesa 22.3, AVX2, 2026-11).
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Bgra8Unorm;

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
    /// `nearest` in picture.wgsl.
    sampler: wgpu::Sampler,
    /// A placeholder texture if there is no overlay.
    nothing: wgpu::Texture,
    /// `drawn` in picture.wgsl.
    drawn: wgpu::Buffer,
    picture: Option<wgpu::Texture>,
    /// Size in pixels of the blocks that the texture holds, from its top left corner; 1 if it holds pixels.
    block_px: u32,
    /// The texels that are uploaded, row by row.
    texels: Vec<[u8; 4]>,
    /// The bind group of the picture and this overlay.
    bound: Option<(wgpu::Texture, wgpu::BindGroup)>,
}

impl Picture {
    /// Compiles the shader for the window's format.
    pub fn new(render_state: &RenderState) -> Self {
        let device = render_state.device.clone();
        let layout = layout(&device);
        Self {
            pipelines: ["fs_picture", "fs_with_overlay"]
                .map(|name| pipeline(&device, &layout, render_state.target_format, name)),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor::default()),
            // One transparent pixel: wgpu clears textures that are never written.
            nothing: texture(&device, "nothing", UVec2::ONE, FORMAT, USAGE),
            drawn: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("drawn part of the picture"),
                size: size_of::<DrawnPart>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            queue: render_state.queue.clone(),
            layout,
            picture: None,
            block_px: 1,
            texels: Vec::new(),
            bound: None,
            device,
        }
    }

    /// Uploads all pixels of a picture that doesn't consist of blocks; see [`upload`](Self::upload).
    ///
    /// # Errors
    /// Those of [`upload`](Self::upload).
    pub fn upload_whole(&mut self, size: UVec2, pixels: &[[u8; 4]]) -> Result<(), GpuError> {
        self.upload(size, pixels, PixelRect::whole(size), 1)
    }

    /// Uploads the changed pixels, or all pixels if the size of the picture or of its blocks changed. Pixels are sRGB with
    /// alpha 255, row by row from the top; as many as the size says. If the picture consists of blocks of `block_px` ×
    /// `block_px` equal pixels, from its top left corner, one pixel of each block is uploaded; otherwise `block_px` is 1.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`]; there is no picture then.
    pub fn upload(
        &mut self,
        size: UVec2,
        pixels: &[[u8; 4]],
        changed: PixelRect,
        block_px: u32,
    ) -> Result<(), GpuError> {
        let is_same_size =
            |texture: &wgpu::Texture| UVec2::new(texture.width(), texture.height()) == size;
        let known = self.picture.take().filter(is_same_size);
        let rect = if known.is_some() && block_px == 1 && self.block_px == 1 {
            changed
        } else {
            PixelRect::whole(size)
        };
        let texture = match known {
            Some(texture) => texture,
            None => {
                self.bound = None;
                let make = || texture(&self.device, "picture", size, FORMAT, USAGE);
                allocated(&self.device, make)?
            }
        };
        self.block_px = block_px;
        self.texels.clear();
        let texel = |&[r, g, b, a]: &[u8; 4]| [b, g, r, a];
        for y in (rect.min.y..rect.max.y).step_by(block_px as usize) {
            let row = (y * size.x) as usize;
            let row = &pixels[row + rect.min.x as usize..row + rect.max.x as usize];
            if block_px == 1 {
                self.texels.extend(row.iter().map(texel));
            } else {
                let sampled = row.iter().step_by(block_px as usize);
                self.texels.extend(sampled.map(texel));
            }
        }
        let count = rect.block_count(block_px);
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
            self.texels.as_flattened(),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * count.x),
                rows_per_image: None,
            },
            extent(count),
        );
        self.picture = Some(texture);
        Ok(())
    }

    /// The bind group of the picture and the overlay.
    fn bind(&self, textures: [&wgpu::Texture; 2]) -> wgpu::BindGroup {
        let views =
            textures.map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(&views[0])),
                entry(1, wgpu::BindingResource::TextureView(&views[1])),
                entry(2, wgpu::BindingResource::Sampler(&self.sampler)),
                entry(3, self.drawn.as_entire_binding()),
            ],
        })
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
        let drawn = DrawnPart {
            part: [part.min.x, part.min.y, part.width(), part.height()],
            texture_from_picture: [1.0 / self.block_px as f32; 2],
            padding: [0.0; 2],
        };
        self.queue
            .write_buffer(&self.drawn, 0, bytemuck::bytes_of(&drawn));
        let pipeline = &self.pipelines[usize::from(overlay.is_some())];
        let overlay = overlay.unwrap_or(&self.nothing);
        if self
            .bound
            .as_ref()
            .is_none_or(|(bound, _)| bound != overlay)
        {
            let group = self.bind([picture, overlay]);
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

/// `DrawnPart` in picture.wgsl.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct DrawnPart {
    /// The corner and the size of the part.
    part: [f32; 4],
    texture_from_picture: [f32; 2],
    padding: [f32; 2],
}

impl DrawnPart {
    /// Offsets of the members, for the test that compares them with WGSL's.
    #[cfg(test)]
    pub(super) const OFFSETS: [usize; 2] = [
        std::mem::offset_of!(Self, part),
        std::mem::offset_of!(Self, texture_from_picture),
    ];
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
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    };
    let layer = |binding| {
        let ty = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        entry(binding, wgpu::ShaderStages::FRAGMENT, ty)
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let drawn = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("picture"),
        entries: &[
            layer(0),
            layer(1),
            entry(2, wgpu::ShaderStages::FRAGMENT, sampler),
            entry(3, wgpu::ShaderStages::VERTEX, drawn),
        ],
    })
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
    entry_point: &str,
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
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

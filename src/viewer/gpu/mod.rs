//! What the GPU draws: the traced picture ([`picture`]), and over it lines, hidden where triangles lie
//! before them.
//!
//! [`Overlay`] owns a colour and a depth target of its own, so that the result doesn't depend on the
//! window's: depth first ([`depth`]), then lines ([`lines`]), both for the same [`view`]. Depth is
//! reversed (1 near, 0 far), which keeps its precision far away.

pub mod adapter;
pub mod depth;
pub mod lines;
pub mod picture;
pub mod view;

use depth::{DepthMesh, DepthPipeline};
use glam::UVec2;
use lines::{LineOcclusion, LinePipelines, LineSet};
use view::{ViewBinding, ViewUniform};

/// The colour target: sRGB-encoded, alpha multiplied in, as egui's textures are.
const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Reversed depth needs a float to be precise.
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Why something can't be drawn.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is no GPU, nor software that acts as one.
    #[error("no graphics adapter was found: {0}")]
    NoAdapter(String),
    /// The mesh needs a larger buffer than the GPU grants.
    #[error("the overlay needs a buffer of {needed} bytes; this GPU grants {granted}")]
    TooLarge {
        /// Bytes needed.
        needed: u64,
        /// Bytes granted.
        granted: u64,
    },
    /// The picture is larger than the GPU's textures or buffers.
    #[error(
        "a picture of {width}x{height} is too large to be drawn over: this GPU grants {side} pixels a side and {bytes} bytes"
    )]
    PictureTooLarge {
        /// Of the picture.
        width: u32,
        /// Of the picture.
        height: u32,
        /// Pixels granted.
        side: u32,
        /// Bytes granted.
        bytes: u64,
    },
    /// The picture couldn't be read back.
    #[error("the overlay couldn't be read back: {0}")]
    ReadBack(String),
}

/// Draws lines over a mesh, hidden where the mesh is before them. Lives as long as the device.
pub struct Overlay {
    view: ViewBinding,
    depth: DepthPipeline,
    lines: LinePipelines,
    targets: Option<Targets>,
}

/// Textures of the picture's size.
struct Targets {
    size: UVec2,
    colour: wgpu::Texture,
    colour_view: wgpu::TextureView,
    depth_view: wgpu::TextureView,
}

impl Overlay {
    /// Compiles the shaders.
    pub fn new(device: &wgpu::Device) -> Self {
        let view = ViewBinding::new(device);
        Self {
            depth: DepthPipeline::new(device, &view, DEPTH_FORMAT),
            lines: LinePipelines::new(device, &view, COLOUR_FORMAT, DEPTH_FORMAT),
            view,
            targets: None,
        }
    }

    /// The pipelines for lines, which make [`LineSet`]s.
    pub fn lines(&self) -> &LinePipelines {
        &self.lines
    }

    /// Draws the lines of each set over a transparent ground, and returns the texture. It is the
    /// same one until the size changes.
    pub fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        view: &ViewUniform,
        mesh: &DepthMesh,
        sets: &[(&LineSet, LineOcclusion)],
    ) -> &wgpu::Texture {
        let size = view.size();
        if self
            .targets
            .as_ref()
            .is_none_or(|targets| targets.size != size)
        {
            self.targets = Some(Targets::new(device, size));
        }
        let targets = self.targets.as_ref().expect("made above");
        self.view.upload(queue, view);

        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("overlay"),
        });
        {
            let mut pass = targets.begin_depth(&mut encoder);
            pass.set_bind_group(0, self.view.group(), &[]);
            self.depth.draw(&mut pass, mesh);
        }
        {
            let mut pass = targets.begin_lines(&mut encoder);
            pass.set_bind_group(0, self.view.group(), &[]);
            for (set, visibility) in sets {
                self.lines.draw(&mut pass, set, *visibility);
            }
        }
        queue.submit([encoder.finish()]);
        &targets.colour
    }
}

impl Targets {
    fn new(device: &wgpu::Device, size: UVec2) -> Self {
        use wgpu::TextureUsages as Usage;
        let colour_usage = Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_SRC;
        let colour = texture(device, "overlay colour", size, COLOUR_FORMAT, colour_usage);
        let depth_usage = Usage::RENDER_ATTACHMENT;
        let depth = texture(device, "overlay depth", size, DEPTH_FORMAT, depth_usage);
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self {
            size,
            colour_view: view(&colour),
            depth_view: view(&depth),
            colour,
        }
    }

    fn begin_depth<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay depth"),
            depth_stencil_attachment: Some(self.depth(wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        })
    }

    fn begin_lines<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay lines"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.colour_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(self.depth(wgpu::LoadOp::Load)),
            ..Default::default()
        })
    }

    fn depth(&self, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: Some(wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }
    }
}

/// A plain texture: one level, one sample.
pub fn texture(
    device: &wgpu::Device,
    label: &str,
    size: UVec2,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(size),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn extent(size: UVec2) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: size.x,
        height: size.y,
        depth_or_array_layers: 1,
    }
}

/// A buffer with these contents; an error where the device grants none that large.
fn buffer(
    device: &wgpu::Device,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    use wgpu::util::DeviceExt as _;
    let (needed, granted) = (contents.len() as u64, device.limits().max_buffer_size);
    if needed > granted {
        return Err(GpuError::TooLarge { needed, granted });
    }
    Ok(
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents,
            usage,
        }),
    )
}

/// A bind group layout of one uniform for vertex and fragment shaders.
fn uniform_layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

/// A uniform buffer of a size, and the group that binds it.
fn uniform_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    size: usize,
) -> (wgpu::Buffer, wgpu::BindGroup) {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    });
    (buffer, group)
}

/// A shader behind the part that all share.
fn shader(device: &wgpu::Device, label: &str, source: &str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(format!("{}\n{source}", view::SHADER).into()),
    })
}

#[cfg(test)]
mod tests {
    use super::lines::{self, StyleUniform};
    use super::view::{self, ViewUniform};

    /// Size of a structure in WGSL, and the offsets of its members.
    fn layout(source: &str, name: &str) -> (usize, Vec<usize>) {
        let module = naga::front::wgsl::parse_str(source).expect("a test validates the shaders");
        let mut types = module.types.iter();
        let (_, found) = types
            .find(|(_, ty)| ty.name.as_deref() == Some(name))
            .expect(name);
        let naga::TypeInner::Struct { members, span } = &found.inner else {
            panic!("{name} is no structure");
        };
        let offsets = members.iter().map(|member| member.offset as usize);
        (*span as usize, offsets.collect())
    }

    #[test]
    fn uniforms_are_laid_out_as_their_twins_in_wgsl() {
        let (size, offsets) = layout(view::SHADER, "View");
        assert_eq!(size, size_of::<ViewUniform>());
        assert_eq!(offsets, ViewUniform::OFFSETS);
        let lines = format!("{}\n{}", view::SHADER, lines::SHADER);
        let (size, offsets) = layout(&lines, "Style");
        assert_eq!(size, size_of::<StyleUniform>());
        assert_eq!(offsets, StyleUniform::OFFSETS);
    }
}

//! GPU drawing: the traced picture ([`picture`]) and the overlay ([`drawing`]), which consists of the mesh's
//! depth ([`depth`]), that of other shapes ([`traced`]) and [`lines`], all for the same [`view`]. The [`rasterizer`]
//! finds the visible triangles for a comparison with the traced picture. [`adapter`]
//! opens devices, and [`faults`] collects their errors.

pub mod adapter;
pub mod depth;
pub mod drawing;
pub mod faults;
pub mod lines;
pub mod picture;
pub mod rasterizer;
pub mod slices;
pub mod traced;
pub(crate) mod upload;
pub mod view;

use glam::UVec2;

/// The colour target: sRGB-encoded with premultiplied alpha, as egui's textures.
const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Reversed depth needs a float format to be precise.
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A drawing error.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is no GPU and no software renderer.
    #[error("no graphics adapter was found: {0}")]
    NoAdapter(String),
    /// A single line or triangle needs a larger buffer than the GPU allows.
    #[error("the overlay needs a buffer of {needed} bytes; this GPU allows {granted}")]
    TooLarge {
        /// Bytes needed.
        needed: u64,
        /// Bytes granted.
        granted: u64,
    },
    /// The GPU has no memory left.
    #[error("the graphics adapter has no memory left for the picture or its overlay")]
    OutOfMemory,
    /// The picture couldn't be read back.
    #[error("the overlay couldn't be read back: {0}")]
    ReadBack(String),
}

/// Creates a texture with one mip level and one sample per pixel.
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

/// The layout of a bind group with one uniform for vertex and fragment shaders.
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

/// A bind group of one uniform buffer.
fn uniform_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    buffer: &wgpu::Buffer,
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    })
}

/// Compiles a shader, appended to the part that all shaders share.
fn shader(device: &wgpu::Device, label: &str, source: &str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(format!("{}\n{source}", view::SHADER).into()),
    })
}

#[cfg(test)]
mod tests {
    use super::lines::{self, StyleUniform};
    use super::picture::{self, DrawnPart};
    use super::traced;
    use super::view::{self, ViewUniform};

    /// Size of a structure in WGSL, and the offsets of its members.
    fn layout(source: &str, name: &str) -> (usize, Vec<usize>) {
        let module = naga::front::wgsl::parse_str(source).expect("a test validates the shaders");
        let mut types = module.types.iter();
        let (_, found) = types
            .find(|(_, ty)| ty.name.as_deref() == Some(name))
            .expect(name);
        let naga::TypeInner::Struct { members, span } = &found.inner else {
            panic!("{name} isn't a structure");
        };
        let offsets = members.iter().map(|member| member.offset as usize);
        (*span as usize, offsets.collect())
    }

    #[test]
    fn uniforms_have_the_layout_of_their_twins_in_wgsl() {
        let (size, offsets) = layout(view::SHADER, "View");
        assert_eq!(size, size_of::<ViewUniform>());
        assert_eq!(offsets, ViewUniform::OFFSETS);
        let lines = format!("{}\n{}", view::SHADER, lines::SHADER);
        let (size, offsets) = layout(&lines, "Style");
        assert_eq!(size, size_of::<StyleUniform>());
        assert_eq!(offsets, StyleUniform::OFFSETS);
        let (size, offsets) = layout(picture::SHADER, "DrawnPart");
        assert_eq!(size, size_of::<DrawnPart>());
        assert_eq!(offsets, DrawnPart::OFFSETS);
        // Outlines use the colour alone; the other members are one there.
        let traced = format!("{}\n{}", view::SHADER, traced::SHADER);
        let (size, offsets) = layout(&traced, "Outline");
        assert_eq!(size, size_of::<StyleUniform>());
        assert_eq!(offsets, StyleUniform::OFFSETS[..2]);
    }
}

//! The traced picture on the GPU.

use eframe::egui_wgpu::RenderState;
use glam::UVec2;
use hitscope_core::Film;
use hitscope_core::film::PixelRect;

/// A texture that holds the picture, for egui to show. sRGB-encoded bytes in a format that isn't
/// decoded, as egui wants it.
pub struct Picture {
    render_state: RenderState,
    shown: Option<Shown>,
}

struct Shown {
    texture: wgpu::Texture,
    id: egui::TextureId,
    size: UVec2,
}

impl Picture {
    /// No picture yet.
    pub fn new(render_state: RenderState) -> Self {
        Self {
            render_state,
            shown: None,
        }
    }

    /// For egui to show; `None` before the first upload.
    pub fn id(&self) -> Option<egui::TextureId> {
        self.shown.as_ref().map(|shown| shown.id)
    }

    /// Uploads the pixels that changed; all of them if the size did.
    pub fn upload(&mut self, film: &Film, changed: PixelRect) {
        let size = film.size();
        let rect = match &self.shown {
            Some(shown) if shown.size == size => changed,
            _ => {
                self.resize(size);
                PixelRect {
                    min: UVec2::ZERO,
                    max: size,
                }
            }
        };
        let Some(shown) = &self.shown else { return };
        let first = (rect.min.y * size.x + rect.min.x) as usize;
        let extent = rect.max - rect.min;
        self.render_state.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &shown.texture,
                mip_level: 0,
                origin: wgpu::Origin3d {
                    x: rect.min.x,
                    y: rect.min.y,
                    z: 0,
                },
                aspect: wgpu::TextureAspect::All,
            },
            film.pixels()[first..].as_flattened(),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * size.x),
                rows_per_image: None,
            },
            wgpu::Extent3d {
                width: extent.x,
                height: extent.y,
                depth_or_array_layers: 1,
            },
        );
    }

    fn resize(&mut self, size: UVec2) {
        let device = &self.render_state.device;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d {
                width: size.x,
                height: size.y,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let old = self.shown.as_ref().map(|shown| shown.id);
        let id = register(&self.render_state, &texture, old);
        self.shown = Some(Shown { texture, id, size });
    }
}

/// Makes a texture known to egui, under the id that an older one had.
pub fn register(
    render_state: &RenderState,
    texture: &wgpu::Texture,
    old: Option<egui::TextureId>,
) -> egui::TextureId {
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let (device, filter) = (&render_state.device, wgpu::FilterMode::Nearest);
    let mut renderer = render_state.renderer.write();
    match old {
        Some(id) => {
            renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
            id
        }
        None => renderer.register_native_texture(device, &view, filter),
    }
}

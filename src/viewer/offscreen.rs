//! Drawing of overlays without a window, for `render --overlay` and for saved pictures.

mod tiles;

pub use tiles::OverlayTiles;

use crate::gpu::GpuError;
use crate::gpu::adapter::Gpu;
use crate::overlay::face_normals::FACE_NORMALS;
use crate::overlay::vertex_normals::VERTEX_NORMALS;
use crate::overlay::wireframe::WIREFRAME;
use crate::overlay::{Marks, OverlayInput, OverlaySpec, Overlays, overlay, switches};
use clap::builder::{PossibleValue, PossibleValuesParser};
use glam::DVec3;
use hitscope_core::scene::Shading;
use hitscope_lab::commands::{RenderArgs, Rendered};
use std::sync::Arc;

/// The command line with the overlays' names as the values of `render --overlay`.
pub fn with_overlays(command: clap::Command) -> clap::Command {
    let name = |overlay: &'static OverlaySpec| PossibleValue::new(overlay.name).help(overlay.about);
    let names = PossibleValuesParser::new(switches().map(name));
    command.mut_subcommand("render", |render| {
        render.mut_arg("overlay", |arg| arg.value_parser(names))
    })
}

/// Prepares the overlays that the arguments ask for, to be drawn over a rendered picture or its strips.
///
/// # Errors
/// See [`GpuError`].
pub fn overlays_of(
    gpu: &Gpu,
    args: &RenderArgs,
    rendered: &Rendered,
) -> Result<OverlayTiles, GpuError> {
    let overlays = chosen(args, rendered.shading);
    OverlayTiles::new((&gpu.device, &gpu.queue), &input(rendered), &overlays)
}

/// Draws the overlays that are on over a picture.
///
/// # Errors
/// See [`GpuError`].
pub fn draw_onto(
    pixels: &mut [[u8; 4]],
    gpu: (&wgpu::Device, &wgpu::Queue),
    input: &OverlayInput,
    overlays: &Overlays,
) -> Result<(), GpuError> {
    OverlayTiles::new(gpu, input, overlays)?.draw_onto(pixels, 0, || true)
}

/// The overlays that the arguments name, and those that are on at first.
fn chosen(args: &RenderArgs, shading: Shading) -> Overlays {
    let mut overlays = Overlays::default();
    // The command line refuses other names.
    let named = args.overlay.iter().filter_map(|name| overlay(name));
    let wireframe = args.wireframe.then_some(&WIREFRAME);
    let normals = args.normals.then_some(match shading {
        Shading::Flat => &FACE_NORMALS,
        Shading::Smooth | Shading::Spherical => &VERTEX_NORMALS,
    });
    for overlay in named.chain(wireframe).chain(normals) {
        overlays.set_on(overlay, true);
    }
    overlays
}

/// The view of a rendered picture.
fn input(rendered: &Rendered) -> OverlayInput {
    let scene = &rendered.loaded.scene;
    let bounds = scene.bounds_with_elements();
    OverlayInput {
        scene: Arc::clone(scene),
        camera: rendered.camera,
        lines_camera: rendered.camera,
        up_axis: rendered.up_axis,
        pivot: if bounds.is_empty() {
            DVec3::ZERO
        } else {
            bounds.centre().as_dvec3()
        },
        marks: Marks::default(),
        scale: 1.0,
    }
}

/// The overlays that are on, as pixels with premultiplied alpha.
///
/// # Errors
/// See [`GpuError`].
pub fn drawn(
    gpu: &Gpu,
    input: &OverlayInput,
    overlays: &Overlays,
) -> Result<Vec<[u8; 4]>, GpuError> {
    let size = input.camera.resolution();
    let mut pixels = vec![[0; 4]; (size.x * size.y) as usize];
    let mut tiles = OverlayTiles::new((&gpu.device, &gpu.queue), input, overlays)?;
    tiles.for_each_run(
        0..size.y,
        || true,
        |start, run| {
            pixels[start..start + run.len()].copy_from_slice(run);
        },
    )?;
    Ok(pixels)
}

/// Bytes per row of a buffer that a texture is copied to, with four bytes per pixel.
fn row_bytes(width: u32) -> u64 {
    (4 * u64::from(width)).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT.into())
}

/// Reads back the pixels of a texture with four bytes per pixel.
///
/// # Errors
/// [`GpuError::ReadBack`].
pub fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[u8; 4]>, GpuError> {
    read_back_words(device, queue, texture, 1)
}

/// Reads back a texture of this many four-byte words per pixel.
///
/// # Errors
/// [`GpuError::ReadBack`].
pub(crate) fn read_back_words(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    words_per_pixel: u32,
) -> Result<Vec<[u8; 4]>, GpuError> {
    let (width, height) = (words_per_pixel * texture.width(), texture.height());
    let row = row_bytes(width);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: row * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row as u32),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);

    let failed = |error: &dyn std::fmt::Display| GpuError::ReadBack(error.to_string());
    let (sender, receiver) = std::sync::mpsc::sync_channel(1);
    buffer
        .slice(..)
        .map_async(wgpu::MapMode::Read, move |result| _ = sender.send(result));
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|e| failed(&e))?;
    receiver
        .recv()
        .map_err(|e| failed(&e))?
        .map_err(|e| failed(&e))?;
    let bytes = buffer
        .slice(..)
        .get_mapped_range()
        .map_err(|e| failed(&e))?;
    let rows = bytes.chunks_exact(row as usize);
    let pixels = rows.flat_map(|row| row[..4 * width as usize].as_chunks().0.to_vec());
    Ok(pixels.collect())
}

/// Blends a pixel with premultiplied alpha over one with straight alpha. The result has straight alpha; all are
/// sRGB-encoded.
fn blend(under: [u8; 4], over: [u8; 4]) -> [u8; 4] {
    const ONE: u32 = 255;
    let rest = ONE - u32::from(over[3]);
    // In units of 1/255².
    let left = rest * u32::from(under[3]);
    let alpha = u32::from(over[3]) * ONE + left;
    if alpha == 0 {
        return [0; 4];
    }
    let channel = |k: usize| {
        let sum = u32::from(over[k]) * ONE * ONE + u32::from(under[k]) * left;
        ((sum + alpha / 2) / alpha).min(ONE) as u8
    };
    let alpha = (alpha + ONE / 2) / ONE;
    [channel(0), channel(1), channel(2), alpha as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transparent_pixel_leaves_the_one_below_and_an_opaque_one_replaces_it() {
        let under = [10, 100, 255, 255];
        assert_eq!(blend(under, [0; 4]), under);
        assert_eq!(blend(under, [1, 2, 3, 255]), [1, 2, 3, 255]);
        assert_eq!(blend([0, 0, 200, 255], [0, 64, 0, 128])[2], 100);
        assert_eq!(blend([0; 4], [0; 4]), [0; 4]);
        // A white line of half coverage over nothing is white with half alpha.
        assert_eq!(blend([0; 4], [128, 128, 128, 128]), [255, 255, 255, 128]);
        assert_eq!(blend([50, 60, 70, 128], [0; 4]), [50, 60, 70, 128]);
    }
}

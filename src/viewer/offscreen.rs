//! Drawing of overlays without a window, for `render --overlay`.

use crate::gpu::GpuError;
use crate::gpu::adapter::Gpu;
use crate::gpu::depth::DepthMesh;
use crate::gpu::drawing::{Canvas, Drawing, DrawingState, DrawnLines, Overlay, Paces, Targets};
use crate::gpu::lines::LineSet;
use crate::gpu::traced::TracedLayer;
use crate::overlay::contents::WantedLines;
use crate::overlay::face_normals::FACE_NORMALS;
use crate::overlay::traced::Shapes;
use crate::overlay::vertex_normals::VERTEX_NORMALS;
use crate::overlay::wireframe::WIREFRAME;
use crate::overlay::{Contents, Marks, OverlayInput, OverlaySpec, Overlays, overlay, switches};
use clap::builder::{PossibleValue, PossibleValuesParser};
use glam::{DVec3, UVec2};
use hitscope_core::plan::PixelRect;
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

/// Draws the overlays that the arguments ask for over a rendered picture.
///
/// # Errors
/// See [`GpuError`].
pub fn draw_over(
    gpu: &Gpu,
    pixels: &mut [[u8; 4]],
    args: &RenderArgs,
    rendered: &Rendered,
) -> Result<(), GpuError> {
    let overlays = chosen(args, rendered.shading);
    draw_onto(
        pixels,
        (&gpu.device, &gpu.queue),
        &input(rendered),
        &overlays,
    )
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
    let width = input.camera.resolution().x as usize;
    draw_tiles(gpu, input, overlays, |tile, drawn| {
        for_each_row(tile, drawn, width, |start, row| {
            for (under, over) in pixels[start..].iter_mut().zip(row) {
                *under = blend(*under, *over);
            }
        });
    })
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
    draw_tiles((&gpu.device, &gpu.queue), input, overlays, |tile, drawn| {
        for_each_row(tile, drawn, size.x as usize, |start, row| {
            pixels[start..start + row.len()].copy_from_slice(row);
        });
    })?;
    Ok(pixels)
}

/// Draws the overlays that are on in tiles that the device can hold. Passes the pixels of each tile to `done`.
fn draw_tiles(
    gpu: (&wgpu::Device, &wgpu::Queue),
    input: &OverlayInput,
    overlays: &Overlays,
    mut done: impl FnMut(PixelRect, &[[u8; 4]]),
) -> Result<(), GpuError> {
    let (device, queue) = gpu;
    let (scene, camera) = (&input.scene, &input.camera);
    let Contents {
        lines,
        outline,
        view,
    } = Contents::of(input, overlays);
    let traced = scene
        .has_other_shapes()
        .then(|| Shapes::default().trace(scene, camera, &view));
    let mut sets = Vec::new();
    for WantedLines { gather, looks, .. } in lines {
        let lines = Arc::new(LineSet::new(device, queue, &gather.lines(scene))?);
        sets.extend(looks.into_iter().map(|(kind, style)| DrawnLines {
            lines: Arc::clone(&lines),
            style,
            kind,
        }));
    }
    let mesh = Arc::new(DepthMesh::new(device, queue, scene)?);
    let overlay = Overlay::new(device, queue);
    for tile in tiles(view.size(), largest_tile(&device.limits())) {
        let view = if tile.min == UVec2::ZERO && tile.max == view.size() {
            view
        } else {
            view.of_part(tile)
        };
        let width = camera.resolution().x as usize;
        let traced = traced.as_ref().map(|pixels| {
            let pixels = cut(pixels, width, tile);
            TracedLayer::new(device, queue, view.size(), &pixels)
        });
        let drawing = Drawing {
            view,
            traced: traced.transpose()?.map(Arc::new),
            outline,
            mesh: Arc::clone(&mesh),
            sets: sets.clone(),
        };
        done(tile, &draw_tile(gpu, &overlay, &drawing)?);
    }
    Ok(())
}

fn draw_tile(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    overlay: &Overlay,
    drawing: &Drawing,
) -> Result<Vec<[u8; 4]>, GpuError> {
    let canvas = Canvas {
        targets: Arc::new(Targets::new(device, drawing.view.size())?),
        colour: 0,
        has_depth: false,
    };
    let (mut paces, state) = (Paces::UNLIMITED, DrawingState::default());
    overlay.draw(drawing, &canvas, &mut paces, &state, || ());
    read_back(device, queue, canvas.targets.colour(canvas.colour))
}

/// The longest side of a tile that fits into a texture and into the buffer that reads it back.
fn largest_tile(limits: &wgpu::Limits) -> u32 {
    /// A tile of this size takes 200 MB on the GPU.
    const MOST: u32 = 4096;
    let mut side = limits.max_texture_dimension_2d.min(MOST);
    while side > 1 && row_bytes(side) * u64::from(side) > limits.max_buffer_size {
        side /= 2;
    }
    side
}

/// The tiles of a picture, each with sides of at most `side`.
fn tiles(size: UVec2, side: u32) -> impl Iterator<Item = PixelRect> {
    let counts = UVec2::new(size.x.div_ceil(side), size.y.div_ceil(side));
    let corners =
        (0..counts.y).flat_map(move |y| (0..counts.x).map(move |x| side * UVec2::new(x, y)));
    corners.map(move |min| PixelRect {
        min,
        max: (min + side).min(size),
    })
}

/// The part of a picture of this width inside a tile.
fn cut<T: Copy>(pixels: &[T], width: usize, tile: PixelRect) -> Vec<T> {
    let rows = tile.min.y as usize..tile.max.y as usize;
    let columns = tile.min.x as usize..tile.max.x as usize;
    rows.flat_map(|y| pixels[y * width..][columns.clone()].to_vec())
        .collect()
}

/// Passes each row of a tile to `row`, with the index of its first pixel in a picture of this width.
fn for_each_row(
    tile: PixelRect,
    pixels: &[[u8; 4]],
    width: usize,
    mut row: impl FnMut(usize, &[[u8; 4]]),
) {
    let rows = pixels.chunks_exact((tile.max.x - tile.min.x) as usize);
    for (y, pixels) in (tile.min.y as usize..).zip(rows) {
        row(y * width + tile.min.x as usize, pixels);
    }
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

    #[test]
    fn tiles_cover_each_pixel_once() {
        for (size, side) in [((10, 7), 4), ((4, 4), 4), ((5, 1), 1), ((3, 9), 16)] {
            let size = UVec2::from(size);
            let numbers: Vec<u32> = (0..size.element_product()).collect();
            let mut seen = vec![0; numbers.len()];
            for tile in tiles(size, side) {
                assert!((tile.max - tile.min).max_element() <= side);
                for number in cut(&numbers, size.x as usize, tile) {
                    seen[number as usize] += 1;
                }
            }
            assert!(seen.iter().all(|&count| count == 1), "{size} {side}");
        }
    }

    #[test]
    fn a_tile_fits_textures_and_buffers() {
        let limits = |side, bytes| wgpu::Limits {
            max_texture_dimension_2d: side,
            max_buffer_size: bytes,
            ..wgpu::Limits::default()
        };
        assert_eq!(largest_tile(&limits(16384, 1 << 31)), 4096);
        assert_eq!(largest_tile(&limits(2048, 1 << 31)), 2048);
        assert_eq!(largest_tile(&limits(8192, 1 << 20)), 512);
    }
}
